#include "core/elementary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tumble {
namespace {

constexpr double allowed = 1e-15;   // what the header promises

/// libm in long double is right to far below a double's rounding.
void expect_sincos(double x) {
    const SinCos at = sincos(x);
    EXPECT_NEAR(at.sin, static_cast<double>(std::sin(static_cast<long double>(x))), allowed) << x;
    EXPECT_NEAR(at.cos, static_cast<double>(std::cos(static_cast<long double>(x))), allowed) << x;
}

TEST(Elementary, SineAndCosineOverTheFirstTurns) {
    for (int i = -4000; i <= 4000; ++i) expect_sincos(i * 0.003);
}

TEST(Elementary, SineAndCosineNearMultiplesOfAQuarterTurn) {
    for (const int k : {1, 2, 3, 4, 5, 22, 355, 1000, 103993, 636619}) {
        for (const double offset : {0.0, 1e-16, 1e-12, 1e-8, -1e-8, 1e-3, pi / 4}) {
            expect_sincos(k * (pi / 2) + offset);
            expect_sincos(-k * (pi / 2) - offset);
        }
    }
}

TEST(Elementary, SineAndCosineUpToAMillion) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 20000; ++i) {
        const double unit = static_cast<double>(random() >> 11) * 0x1p-53;
        expect_sincos((2.0 * unit - 1.0) * 1e6);
        expect_sincos((2.0 * unit - 1.0) * 100.0);
    }
}

TEST(Elementary, SineAndCosineLieOnTheCircle) {
    for (int i = 0; i < 1000; ++i) {
        const SinCos at = sincos(i * 0.7);
        EXPECT_NEAR(at.sin * at.sin + at.cos * at.cos, 1.0, 4e-16);
    }
    EXPECT_EQ(sincos(0.0).sin, 0.0);
    EXPECT_EQ(sincos(0.0).cos, 1.0);
}

void expect_angle(double y, double x) {
    const double truth = static_cast<double>(std::atan2(static_cast<long double>(y), static_cast<long double>(x)));
    EXPECT_NEAR(atan2_stable(y, x), truth, allowed) << y << ", " << x;
}

TEST(Elementary, AngleOfAPoint) {
    for (int i = -1799; i <= 1800; ++i) {
        const double angle = i * pi / 1800.0;
        for (const double radius : {1e-3, 1.0, 7.5e4}) expect_angle(radius * std::sin(angle), radius * std::cos(angle));
    }
    EXPECT_EQ(atan2_stable(0.0, 0.0), 0.0);
    EXPECT_NEAR(atan2_stable(0.0, -1.0), pi, allowed);
    EXPECT_EQ(atan2_stable(0.0, 1.0), 0.0);
}

TEST(Elementary, AngleOfVeryNearAndVeryFarPoints) {
    for (const double radius : {1e-300, 1e-200, 1e-160, 1e160, 1e300}) {
        expect_angle(radius, radius);
        expect_angle(-0.3 * radius, -radius);
        expect_angle(radius, 1e-9 * radius);
    }
}

TEST(Elementary, SmallAnglesKeepTheirDigits) {
    for (const double angle : {1e-3, 1e-8, 1e-12}) {
        EXPECT_NEAR(sincos(angle).sin, std::sin(angle), 2e-16 * angle);
        EXPECT_NEAR(atan2_stable(angle, 1.0), std::atan2(angle, 1.0), 4e-16 * angle);
    }
}

}  // namespace
}  // namespace tumble
