// The lines of a SceneSpec's text, and the element that one of them describes.
#pragma once

#include "api/enum_names.h"
#include "scene/fields/field.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble::v0 {

/// Values in the spelling of TOML.
std::string text_of(const std::string& text);
std::string text_of(double value);
std::string text_of(bool value);
std::string text_of(const Vec3& v);
std::string text_of(Color color);
std::string text_of(const Rotation& rotation);
std::string text_of(std::integral auto value) { return std::to_string(value); }
template <class Enum>
requires requires { Described<Enum>::name; }
std::string text_of(Enum value) { return text_of(name_of(value)); }
/// [a, b]
template <class T, std::size_t n>
std::string text_of(const std::array<T, n>& all) {
    std::string text;
    for (const T& one : all) text += (text.empty() ? "[" : ", ") + text_of(one);
    return text + "]";
}

std::string text_of(const std::vector<std::string>& all);

class SpecLines {
public:
    /// Remembers the element of that line; 0: of none.
    explicit SpecLines(int wanted_line) : wanted_(wanted_line) {}

    void line(std::string_view content, std::string_view prefix, std::string_view field);
    /// The header of a table; the prefix names its elements from here on.
    void header(const std::string& content, std::string prefix);
    void value(std::string_view key, std::string_view field, const std::string& content);
    template <class T>
    requires requires(const T& one) { text_of(one); }
    void set(std::string_view key, const T& content) { value(key, key, text_of(content)); }
    template <class T>
    requires requires(const T& one) { text_of(one); }
    void set(std::string_view key, const std::optional<T>& content) {
        if (content) set(key, *content);
    }
    const std::string& prefix() const { return prefix_; }

    std::string text, element;

private:
    int wanted_, lines_ = 0;
    std::string prefix_;
};

/// Writes the fields of a struct of the interface, as scene/fields declares them for the description. Sparse: without
/// defaults.
template <class Public>
struct FieldWriter : FieldVisitor {
    template <class T, class Rule>
    void operator()(const T& value, std::string_view key, const Rule& rule, const About& = {}) {
        if constexpr (std::same_as<Rule, Words>)
            lines.set(key, std::string(value == rule.first_means ? rule.first : rule.second));
        else if constexpr (requires { lines.set(key, value); })
            if (requires { rule.rule; } || is_written(key, value)) lines.set(key, value);
    }
    void alias(const auto& value, std::string_view key, const auto& rule, const About& = {}) {
        (*this)(value, key, rule);
    }

    template <class T>
    bool is_written(std::string_view key, const T& value) const {
        if (std::find(skipped.begin(), skipped.end(), key) != skipped.end()) return false;
        const auto offset = reinterpret_cast<const char*>(&value) - reinterpret_cast<const char*>(&from);
        if (value != *reinterpret_cast<const T*>(reinterpret_cast<const char*>(&standard) + offset)) return true;
        if constexpr (std::same_as<T, double>) return !sparse && std::isfinite(value);
        if constexpr (std::same_as<T, std::string>) return !sparse && !value.empty();
        return !sparse;
    }

    SpecLines& lines;
    const Public& from;
    bool sparse;
    std::initializer_list<std::string_view> skipped;
    Public standard = {};
};

template <class Description, class Public>
void write_fields(SpecLines& lines, const Public& from, bool sparse = false,
                  std::initializer_list<std::string_view> skipped = {}) {
    FieldWriter<Public> writer{{}, lines, from, sparse, skipped};
    visit_fields(Of<Description>(), writer, from);
}

}  // namespace tumble::v0
