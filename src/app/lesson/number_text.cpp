#include "app/lesson/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tumble {
namespace {

std::string with_minus(std::string text) {
    for (std::size_t at; (at = text.find('-')) != std::string::npos;) text.replace(at, 1, "\u2212");
    return text;
}

}  // namespace

std::string measured_html(double value, double tolerance) {
    const double size = std::max(std::abs(value), 1e-300);
    const double digits = tolerance > 0.0 ? std::ceil(std::log10(size / tolerance)) + 2.0 : 15.0;
    const std::string text = fmt::format("{:.{}g}", value, int(std::clamp(digits, 4.0, 15.0)));
    const std::size_t exponent = text.find('e');
    if (exponent == std::string::npos) return with_minus(text);
    return with_minus(fmt::format("{} × 10<sup>{}</sup>", text.substr(0, exponent), std::atoi(text.c_str() + exponent + 1)));
}

std::string power_html(double value) {
    if (value == 0.0) return "0";
    const std::string text = fmt::format("{:.1e}", value);
    const std::size_t exponent = text.find('e');
    return with_minus(fmt::format("{} × 10<sup>{}</sup>", text.substr(0, exponent), std::atoi(text.c_str() + exponent + 1)));
}

}  // namespace tumble
