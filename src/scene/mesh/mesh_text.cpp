#include "scene/mesh/mesh_text.h"

#include "scene/mesh/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>

namespace tumble {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_line_end(char c) { return c == '\n' || c == '\r' || c == '\f' || c == '\0'; }
bool is_blank(char c) { return c == ' ' || c == '\t'; }

constexpr double tenths[] = {1.0,  1e-1, 1e-2,  1e-3,  1e-4,  1e-5,  1e-6,  1e-7,
                             1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15};  // 10 to the power of -i

/// 10 to the power of an integer, rounded once.
float power_of_ten(int exponent) {
    if (exponent > std::numeric_limits<float>::max_exponent10) return std::numeric_limits<float>::infinity();
    char text[16] = "1e";
    const auto written = std::to_chars(text + 2, text + sizeof text, exponent);
    double value = 0.0;
    std::from_chars(text, written.ptr, value);
    return static_cast<float>(value);
}

struct Cursor {
    std::string_view rest;
    char peek(std::size_t ahead = 0) const { return ahead < rest.size() ? rest[ahead] : '\0'; }
    void skip(std::size_t count) { rest.remove_prefix(std::min(count, rest.size())); }
    bool take(char c) {
        if (peek() != c) return false;
        skip(1);
        return true;
    }
    /// The digits up to `most`, as a number; the others are skipped. `used`: number of used digits.
    double digits(int most, int& used) {
        double value = 0.0;  // exact up to 15 digits, more than a float can represent
        for (used = 0; is_digit(peek()); skip(1)) {
            if (used == most) continue;
            value = value * 10.0 + (peek() - '0');
            ++used;
        }
        return value;
    }
};

bool starts_with_token(std::string_view text, std::string_view lower) {
    if (text.size() < lower.size()) return false;
    for (std::size_t i = 0; i < lower.size(); ++i)
        if ((text[i] | 0x20) != lower[i]) return false;
    return true;
}

}  // namespace

bool TextTokens::at_line_end() const { return at_ == text_.size() || is_line_end(text_[at_]) || text_[at_] == '#'; }

bool TextTokens::skip_continuation() {
    if (at_ + 1 >= text_.size() || text_[at_] != '\\') return false;
    const std::size_t end = text_[at_ + 1] == '\r' ? at_ + 2 : at_ + 1;
    if (end >= text_.size() || text_[end] != '\n') return false;
    at_ = end + 1;
    ++line_;
    return true;
}

std::string_view TextTokens::token() {
    while (at_ < text_.size() && (is_blank(text_[at_]) ? (++at_, true) : skip_continuation())) {
    }
    if (at_line_end()) return {};
    const std::size_t first = at_;
    while (at_ < text_.size() && !is_blank(text_[at_]) && !is_line_end(text_[at_])) {
        if (text_[at_] == '\\' && at_ > first) {
            const std::size_t end = at_;
            if (skip_continuation()) return text_.substr(first, end - first);
        }
        ++at_;
    }
    return text_.substr(first, at_ - first);
}

bool TextTokens::next_line() {
    while (at_ < text_.size() && text_[at_] != '\n') {
        if (text_[at_] == '\r' || text_[at_] == '\f' || text_[at_] == '\0') break;
        if (!skip_continuation()) ++at_;
    }
    if (at_ == text_.size()) return false;
    if (text_[at_] == '\n') ++line_;
    ++at_;
    return true;
}

std::string rest_of_line(TextTokens& tokens) {
    std::string text;
    for (std::string_view token = tokens.token(); !token.empty(); token = tokens.token()) {
        if (!text.empty()) text += ' ';
        text += token;
    }
    return text;
}

float mesh_number(std::string_view token, std::size_t line) {
    Cursor c{token};
    const bool negative = c.peek() == '-';
    if (negative || c.peek() == '+') c.skip(1);
    float value = 0.0f;
    if (starts_with_token(c.rest, "nan")) return std::numeric_limits<float>::quiet_NaN();
    if (starts_with_token(c.rest, "inf")) {
        value = std::numeric_limits<float>::infinity();
    } else {
        const auto is_point = [](char p) { return p == '.' || p == ','; };
        if (!is_digit(c.peek()) && !(is_point(c.peek()) && is_digit(c.peek(1))))
            throw MeshError(fmt::format("holds something that is not a number, in line {}", line));
        constexpr int all = std::numeric_limits<int>::max(), decimals = std::size(tenths) - 1;
        int used = 0;
        value = static_cast<float>(c.digits(all, used));
        if (is_point(c.peek()) && is_digit(c.peek(1))) {
            c.skip(1);
            const double fraction = c.digits(decimals, used);
            value += static_cast<float>(fraction * tenths[used]);
        } else {
            c.take('.');
        }
        if ((c.peek() | 0x20) == 'e') {
            c.skip(1);
            const bool small = c.take('-');
            if (!small) c.take('+');
            constexpr int largest = 100;  // with a larger one any float is 0 or infinite
            const int exponent = static_cast<int>(std::min<double>(c.digits(all, used), largest));
            if (value != 0.0f) value *= power_of_ten(small ? -exponent : exponent);
        }
    }
    return negative ? -value : value;
}

}  // namespace tumble
