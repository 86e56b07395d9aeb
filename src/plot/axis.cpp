#include "plot/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

std::string superscript(int exponent) {
    static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text;
    for (const char c : std::to_string(exponent)) text += c == '-' ? "⁻" : digits[c - '0'];
    return text;
}

/// With a minus sign instead of a hyphen, and a thin space between groups of three digits from 10 000 on.
std::string typeset(std::string text) {
    const std::size_t first = text.find_first_of("0123456789"), digits = std::min(text.find('.'), text.size()) - first;
    if (digits > 4)
        for (std::size_t k = digits - 3; k > 0; k = k > 3 ? k - 3 : 0) text.insert(first + k, "\u2009");
    if (!text.empty() && text[0] == '-') text.replace(0, 1, "−");
    return text;
}

/// The multiple of 1, 2 or 5 times a power of ten next above.
double nice_step(double step) {
    const double power = std::pow(10.0, std::floor(std::log10(step)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (step <= factor * power * (1.0 + 1e-9)) return factor * power;
    return 10.0 * power;
}

/// With the decimals that a step needs; as a power of ten where that is shorter to read.
std::string tick_label(double value, double step, double largest) {
    if (value == 0.0) return "0";
    const int exponent = int(std::floor(std::log10(largest) + 1e-9));
    if (exponent >= 5 || exponent <= -4) {
        const double unit = std::pow(10.0, exponent);
        const int decimals = std::max(0, int(std::ceil(-std::log10(step / unit) - 1e-9)));
        return typeset(fmt::format("{:.{}f}", value / unit, decimals)) + "·10" + superscript(exponent);
    }
    return typeset(fmt::format("{:.{}f}", value, std::max(0, int(std::ceil(-std::log10(step) - 1e-9)))));
}

}  // namespace

Axis Axis::linear(double least, double most, int about) {
    Axis axis;
    if (!(most > least)) {  // one value: a range around it
        const double half = least != 0.0 ? 0.5 * std::fabs(least) : 1.0;
        least -= half;
        most += half;
    }
    const double step = nice_step((most - least) / std::max(1, about));
    // The range ends at ticks, unless the values end shortly behind one.
    const double slack = 0.02;
    const auto first = std::int64_t(std::floor(least / step + slack)),
               last = std::int64_t(std::ceil(most / step - slack));
    axis.least_ = std::min(least, double(first) * step);
    axis.most_ = std::max(most, double(last) * step);
    const double largest = std::max(std::fabs(axis.least_), std::fabs(axis.most_));
    for (std::int64_t k = first; k <= last; ++k)
        axis.ticks_.push_back({double(k) * step, tick_label(double(k) * step, step, largest)});
    return axis;
}

Axis Axis::exact(double least, double most, int about) {
    Axis axis = linear(least, most, about);
    if (!(most > least)) return axis;
    axis.least_ = least;
    axis.most_ = most;
    const double slack = 1e-9 * (most - least);
    std::erase_if(axis.ticks_,
                  [&](const Tick& tick) { return tick.value < least - slack || tick.value > most + slack; });
    return axis;
}

Axis Axis::logarithmic(double least, double most, int about) {
    Axis axis;
    axis.log_ = true;
    const int first = int(std::floor(std::log10(least) + 1e-9));
    const int last = std::max(first + 1, int(std::ceil(std::log10(most) - 1e-9)));
    axis.least_ = std::pow(10.0, first);
    axis.most_ = std::pow(10.0, last);
    const int every = std::max(1, (last - first + about - 1) / std::max(1, about));
    for (int k = first; k <= last; k += every) axis.ticks_.push_back({std::pow(10.0, k), "10" + superscript(k)});
    return axis;
}

double Axis::place(double value) const {
    if (!log_) return (value - least_) / (most_ - least_);
    return std::log10(value / least_) / std::log10(most_ / least_);
}

}  // namespace tumble
