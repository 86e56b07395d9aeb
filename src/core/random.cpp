#include "core/random.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Maps neighboring seeds to unrelated ones (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number
/// generators").
std::uint64_t mixed(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

// Points this near the center of the ball are redrawn, because division by their length would lose digits.
constexpr double least_square = 1e-6;

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t body, Purpose purpose)
    : engine_(mixed(mixed(mixed(seed) ^ body) ^ static_cast<std::uint64_t>(purpose))) {}

double Random::unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

double Random::between(double low, double high) { return low + (high - low) * unit(); }

std::size_t Random::index(std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(unit() * static_cast<double>(count)));
}

// Separate statements, because the order of evaluation of a function's arguments is unspecified.
Vec3 Random::in_box(const Vec3& half) {
    Vec3 p;
    for (int i = 0; i < 3; ++i) p[i] = between(-half[i], half[i]);
    return p;
}

Vec3 Random::direction() {
    for (;;) {
        const Vec3 p = in_box(Vec3::Ones());
        const double square = p.squaredNorm();
        if (square > least_square && square <= 1.0) return p / std::sqrt(square);
    }
}

Quat Random::rotation() {
    for (;;) {
        const double w = between(-1.0, 1.0);
        const Vec3 v = in_box(Vec3::Ones());
        const double square = w * w + v.squaredNorm();
        if (square <= least_square || square > 1.0) continue;
        const double length = std::sqrt(square);
        return Quat(w / length, v.x() / length, v.y() / length, v.z() / length);
    }
}

}  // namespace tumble
