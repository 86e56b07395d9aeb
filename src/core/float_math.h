// Roots and powers of floats for loops over pixels: inline and without branches, so that compilers make vector
// instructions of them, and with the same bits on every x86-64 (see core/deterministic_math.h). They use only
// + - * / and bits of floats.
#pragma once

#include <bit>
#include <cstdint>

namespace tumble {

/// Cube root of x in [1e-30, 1e30]; relative error below 4e-7. Below 1e-30 the result is below 2e-10.
inline float cube_root(float x) {
    // A third of the exponent: within 6 %. Each step of Halley's iteration cubes the error.
    constexpr float offset = 709921077.0f;  // 2/3 of the bits of 1.0f, less the mean error of the linear mantissa
    const auto bits = std::bit_cast<std::int32_t>(x);
    float t = std::bit_cast<float>(static_cast<std::int32_t>(static_cast<float>(bits) * (1.0f / 3.0f) + offset));
    for (int i = 0; i < 2; ++i) {
        const float cube = t * t * t;
        t = t * ((cube + x + x) / (cube + cube + x));
    }
    return t;
}

/// Logarithm of x to the base 2, x a normal positive float; absolute error below 2e-7 + 1e-7 |log2 x|.
inline float logarithm_2(float x) {
    constexpr std::int32_t root_half = 0x3f3504f3;  // bits of sqrt(1/2)
    const auto bits = std::bit_cast<std::int32_t>(x);
    const std::int32_t exponent = (bits - root_half) >> 23;
    const float m = std::bit_cast<float>(bits - exponent * (1 << 23));  // in [sqrt(1/2), sqrt(2))
    // log2(m) = 2/ln(2) artanh(s); the series to s^9 leaves 3e-10.
    const float s = (m - 1.0f) / (m + 1.0f), z = s * s;
    const float series = 1.0f + z * (1.0f / 3.0f + z * (1.0f / 5.0f + z * (1.0f / 7.0f + z * (1.0f / 9.0f))));
    return static_cast<float>(exponent) + 2.88539008f * s * series;
}

/// 2^x, |x| < 126; relative error below 2e-7.
inline float exponential_2(float x) {
    const auto whole = static_cast<std::int32_t>(x + 127.5f) - 127;  // the nearest; of two, the upper
    const float r = (x - static_cast<float>(whole)) * 0.693147181f;  // |r| <= ln(2)/2: the series to r^7 leaves 6e-9
    const float series =
        1.0f +
        r * (1.0f + r * (1.0f / 2.0f +
                         r * (1.0f / 6.0f +
                              r * (1.0f / 24.0f + r * (1.0f / 120.0f + r * (1.0f / 720.0f + r * (1.0f / 5040.0f)))))));
    return series * std::bit_cast<float>((whole + 127) * (1 << 23));
}

/// x^y for 0 <= x <= 1e6 and 0 <= y <= 1; relative error below 3e-6. Below 1e-12, x counts as 0, and the result is 0.
inline float power(float x, float y) {
    constexpr float least = 1e-12f;
    const float value = exponential_2(y * logarithm_2(x < least ? least : x));
    return x < least ? 0.0f : value;
}

}  // namespace tumble
