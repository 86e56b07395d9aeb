// Reads the fields of a table (scene/fields) with all checks that concern one field alone.
#pragma once

#include "scene/fields/choices.h"
#include "scene/fields/field.h"
#include "scene/keys/body_values.h"
#include "scene/toml/toml_reader.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

inline void read_value(const TomlValue& given, bool& target, ByType) { target = given.boolean(); }
inline void read_value(const TomlValue& given, std::string& target, ByType) { target = given.text(); }
inline void read_value(const TomlValue& given, std::string& target, NotEmpty) {
    target = given.text();
    if (target.empty()) given.fail("must not be empty");
}
inline void read_value(const TomlValue& given, std::vector<Color>& target, ByType) {
    for (const TomlValue& color : given.items()) target.push_back(color.color());
    if (target.empty()) given.fail("must name at least one color");
}
inline void read_value(const TomlValue& given, Color& target, ByType) { target = given.color(); }
inline void read_value(const TomlValue& given, Quat& target, ByType) { target = read_rotation(given); }
template <Named Enum>
void read_value(const TomlValue& given, Enum& target, ByType) {
    target = given.choice<Enum>(choices<Enum>);
}
inline void read_value(const TomlValue& given, double& target, const Range& range) { target = given.number(range); }
inline void read_value(const TomlValue& given, Vec3& target, const Range& range) { target = given.vector(range); }
inline void read_value(const TomlValue& given, Vec3& target, Direction) { target = given.direction(); }
inline void read_value(const TomlValue& given, Vec3& target, const NumberOrVector& rule) {
    target = given.is_number() ? Vec3(Vec3::Constant(given.number(rule.range))) : given.vector(rule.range);
}
inline void read_value(const TomlValue& given, bool& target, const Words& words) {
    const Choice<bool> both[] = {{words.first, words.first_means}, {words.second, !words.first_means}};
    target = given.choice<bool>(both);
}
template <std::integral Number>
void read_value(const TomlValue& given, Number& target, const Whole& range) {
    target = Number(given.integer(range.min, range.max));
}
template <class T>
void read_value(const TomlValue& given, std::optional<T>& target, const auto& rule) {
    read_value(given, target.emplace(), rule);
}

/// Reads each field that the table has; the others keep their values.
struct FieldReader : FieldVisitor {
    explicit FieldReader(const TomlTable& from) : table(from) {}

    template <class T, class Rule>
    void operator()(T& target, std::string_view key, const Rule& rule, const About& = {}) const {
        if (const auto given = table.find(key)) read_value(*given, target, rule);
    }
    template <class T, class Rule>
    void operator()(T& target, std::string_view key, const Required<Rule>& required, const About& = {}) const {
        read_value(table.require(key), target, required.rule);
    }
    void operator()(auto&, std::string_view, ByCode, const About& = {}) const {}
    void operator()(auto&, std::string_view, Required<ByCode>, const About& = {}) const {}
    void alias(auto& target, std::string_view key, const auto& rule, const About& about = {}) const {
        (*this)(target, key, rule, about);
    }

    const TomlTable& table;
};

template <HasFields Struct>
void read_fields(const TomlTable& table, Struct& target) {
    FieldReader reader(table);
    visit_fields(Of<Struct>(), reader, target);
}

/// The same, after a check for unknown keys. The keys of `Others` are known too, and read elsewhere.
template <HasFields Struct, HasFields... Others>
Struct read_all_fields(const TomlTable& table, Struct target = {}) {
    table.expect_keys(list_keys<Struct, Others...>().keys);
    read_fields(table, target);
    return target;
}

}  // namespace tumble
