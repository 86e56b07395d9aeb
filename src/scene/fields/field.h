// Fields of the scene's description, each declared once, in the order of its scene hash:
//
//   template <class Visitor, class Self>
//   void visit_fields(Of<WindDescription>, Visitor& field, Self& self) {
//       field(self.velocity, "velocity", limits::velocity);
//       field(self.density, "density", limits::air_density);
//       field(self.drag, "drag", limits::drag, {"drag coefficient"});
//   }
//
// `self` is a description, or the struct of the C++ interface with the same members. Visitors:
//
// | known keys of a table, with their checks | keys/read_fields.h |
// | scene hash | hash/scene_hash.cpp |
// | text of a SceneSpec | api/spec_lines.h |
// | values of motion records; pages | app/causes/described_values.cpp; page/scene_data.cpp |
// | tables of docs/reference; members without a field | tests/scene/scene_fields_test.cpp |
//
// Checks across fields stand in the readers (keys).
#pragma once

#include "scene/toml/range.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace tumble {

/// The table of a struct.
template <class Struct>
struct Of {};

// -- Rules: Range for numbers and vectors (toml/range.h), and these.

struct ByType {};     // flags, texts, colors, rotations, names of enumerators
struct ByCode {};     // read by code beside
struct Direction {};  // a unit vector along the given one
struct NotEmpty {};   // a text
struct Whole {
    std::int64_t min, max;
};
struct NumberOrVector {  // a number for all three axes
    Range range;
};
/// A flag that is given by one of two words; the word of the default comes first.
struct Words {
    std::string_view first, second;
    bool first_means = false;
};
template <class Rule>
struct Required {
    explicit constexpr Required(const Rule& given) : rule(given) {}  // clang 14 has no aggregates by parentheses
    Rule rule;
};

/// Texts of the reference. Without a default, a range or a type they follow from the member and its rule.
struct About {
    std::string_view text = {}, standard = {}, range = {}, type = {};
    std::uint32_t joints = ~0u;  // bits of the types of joint that have it
    bool picture = false;        // the motion does not depend on it
    // Newer than hashes that are in use: hashed, with its key, where it is given. Scenes without it keep their hash.
    bool later = false;
};

/// Base of visitors. Derived ones have `operator()(member, key, rule, about)`.
struct FieldVisitor {
    void section(std::string_view) {}                 // a table of its own in the reference, from here on
    void key(std::string_view, const About& = {}) {}  // read by code into members that follow
    // A part of a member that is hashed as a whole.
    void alias(const auto&, std::string_view, const auto&, const About& = {}) {}
    void inner(const auto&...) {}              // follow from several keys
    void shown(const auto&...) {}              // the same; the motion does not depend on them
    void instead(const auto&, const auto&) {}  // hashed as this value
    void since(bool, const auto&...) {}        // hashed where the condition holds: other scenes keep their hash
};

template <class Struct>
concept HasFields = requires(FieldVisitor& visitor, const Struct& self) {
    visit_fields(Of<Struct>(), visitor, self);
};

/// Names of all fields of structs, and the types of joint that have each.
struct KeyList : FieldVisitor {
    void operator()(const auto&, std::string_view name, const auto&, const About& about = {}) { key(name, about); }
    void alias(const auto&, std::string_view name, const auto&, const About& about = {}) { key(name, about); }
    void key(std::string_view name, const About& about = {}) {
        keys.push_back(name);
        joints.push_back(about.joints);
    }

    std::vector<std::string_view> keys;
    std::vector<std::uint32_t> joints;
};

template <class... Structs>
KeyList list_keys() {
    KeyList list;
    const auto add = [&]<class Struct>(const Struct& one) { visit_fields(Of<Struct>(), list, one); };
    (add(Structs{}), ...);
    return list;
}

}  // namespace tumble
