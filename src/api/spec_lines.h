// The lines of a SceneSpec's text, and the element that one of them describes.
#pragma once

#include "api/enum_names.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace tumble::v0 {

/// Values in the spelling of TOML.
std::string text_of(const std::string& text);
std::string text_of(double value);
std::string text_of(bool value);
std::string text_of(const Vec3& v);
std::string text_of(Color color);
std::string text_of(const Rotation& rotation);
/// [a, b]
template <class T>
std::string text_of(const std::array<T, 2>& pair) {
    return fmt::format("[{}, {}]", text_of(pair[0]), text_of(pair[1]));
}

class SpecLines {
public:
    /// Remembers the element of that line; 0: of none.
    explicit SpecLines(int wanted_line) : wanted_(wanted_line) {}

    void line(std::string_view content, std::string_view prefix, std::string_view field);
    /// The header of a table; the prefix names its elements from here on.
    void header(const std::string& content, std::string prefix);
    void value(std::string_view key, std::string_view field, const std::string& content);
    void name(std::string_view key, const std::string& content) { value(key, key, text_of(content)); }
    template <class T>
    void set(std::string_view key, const T& content) {
        value(key, key, text_of(content));
    }
    template <class T>
    void set(std::string_view key, const std::optional<T>& content) {
        if (content) set(key, *content);
    }
    const std::string& prefix() const { return prefix_; }

    std::string text, element;

private:
    int wanted_, lines_ = 0;
    std::string prefix_;
};

}  // namespace tumble::v0
