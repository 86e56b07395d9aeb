// Restitution and friction of two bodies that touch, from the values of both.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tumble {

enum class PairRule : std::uint8_t { average, minimum, multiply, maximum, geometric };

/// The rules of a scene.
struct PairRules {
    PairRule restitution = PairRule::maximum, friction = PairRule::geometric;
    bool operator==(const PairRules&) const = default;
};

/// In place of a value: the body takes the value of the other one.
inline constexpr double value_of_other = -1.0;

inline double pair_value(PairRule rule, double a, double b) {
    if (a < 0.0 || b < 0.0) return std::max({a, b, 0.0});
    switch (rule) {
        case PairRule::average:
            return 0.5 * (a + b);
        case PairRule::minimum:
            return std::min(a, b);
        case PairRule::multiply:
            return a * b;
        case PairRule::maximum:
            return std::max(a, b);
        case PairRule::geometric:
            break;
    }
    return a == b ? a : std::sqrt(a * b);
}

}  // namespace tumble
