#include "app/sweep/draw_stream.h"

#include "core/deterministic_math.h"
#include "core/fnv_hash.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The mixing of SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators").
std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

constexpr std::uint64_t golden_step = 0x9e3779b97f4a7c15u;

}  // namespace

DrawStream::DrawStream(std::uint64_t seed, std::string_view axis, std::uint64_t draw)
    : state_(mixed(mixed(mixed(seed + golden_step) ^ fnv_hash(std::as_bytes(std::span(axis)))) +
                   golden_step * (draw + 1))) {}

std::uint64_t DrawStream::next() { return mixed(state_ += golden_step); }

double DrawStream::unit() { return double(next() >> 11) * 0x1p-53; }

double DrawStream::between(double low, double high) {
    return std::clamp(low + (high - low) * unit(), low, high);  // rounding may pass a bound
}

/// Marsaglia and Bray 1964, "A convenient method for generating normal variables".
double DrawStream::normal() {
    for (;;) {
        const double x = 2.0 * unit() - 1.0, y = 2.0 * unit() - 1.0, square = x * x + y * y;
        if (square < 1.0 && square > 0.0) return x * std::sqrt(-2.0 * logarithm(square) / square);
    }
}

std::int64_t DrawStream::index(std::int64_t count) {
    return std::min(count - 1, static_cast<std::int64_t>(unit() * double(count)));
}

}  // namespace tumble
