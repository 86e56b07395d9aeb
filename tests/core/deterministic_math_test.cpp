#include "core/deterministic_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tumble::deterministic_math_test {
namespace {

// The accuracy stated in the header.
constexpr double allowed = 1e-15, allowed_of_sine = 2e-16;

/// libm in long double is accurate far below the rounding of a double, and so are the differences computed here.
void expect_sincos(double x) {
    const SinCos at = sincos(x);
    EXPECT_LE(std::fabs(at.sin - std::sin(static_cast<long double>(x))), allowed_of_sine) << x;
    EXPECT_LE(std::fabs(at.cos - std::cos(static_cast<long double>(x))), allowed_of_sine) << x;
}

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

TEST(DeterministicMath, SineAndCosineOverTheFirstTurns) {
    for (int i = -4000; i <= 4000; ++i) expect_sincos(i * 0.003);
}

TEST(DeterministicMath, SineAndCosineNearMultiplesOfAQuarterTurn) {
    for (const int k : {1, 2, 3, 4, 5, 22, 355, 1000, 103993, 636619}) {
        for (const double offset : {0.0, 1e-16, 1e-12, 1e-8, -1e-8, 1e-3, pi / 4}) {
            expect_sincos(k * (pi / 2) + offset);
            expect_sincos(-k * (pi / 2) - offset);
        }
    }
}

TEST(DeterministicMath, SineAndCosineUpToAMillion) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 20000; ++i) {
        const double u = unit(random);
        expect_sincos((2.0 * u - 1.0) * 1e6);
        expect_sincos((2.0 * u - 1.0) * 100.0);
    }
}

// Phases of hours of fast spin.
TEST(DeterministicMath, SineAndCosineUpToBillions) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 20000; ++i) {
        expect_sincos((2.0 * unit(random) - 1.0) * 1.6e9);
        expect_sincos((2.0 * unit(random) - 1.0) * 3e7);
        // Next to multiples of a quarter turn, where the reduction cancels most.
        const double k = std::floor(1e9 * unit(random));
        expect_sincos(static_cast<double>(k * (static_cast<long double>(pi) / 2)));
    }
}

TEST(DeterministicMath, LostPhasesAreStillOnTheCircle) {
    for (const double x : {1e12, 1e15, 1e16, 1e22, -1e100, 1e300}) {
        const SinCos at = sincos(x);
        EXPECT_NEAR(at.sin * at.sin + at.cos * at.cos, 1.0, 4e-16) << x;
    }
    EXPECT_TRUE(std::isnan(sincos(HUGE_VAL).sin));
    EXPECT_TRUE(std::isnan(sincos(NAN).cos));
}

TEST(DeterministicMath, SineAndCosineLieOnTheCircle) {
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

TEST(DeterministicMath, AngleOfAPoint) {
    for (int i = -1799; i <= 1800; ++i) {
        const double angle = i * pi / 1800.0;
        for (const double radius : {1e-3, 1.0, 7.5e4}) expect_angle(radius * std::sin(angle), radius * std::cos(angle));
    }
    EXPECT_EQ(atan2_stable(0.0, 0.0), 0.0);
    EXPECT_NEAR(atan2_stable(0.0, -1.0), pi, allowed);
    EXPECT_EQ(atan2_stable(0.0, 1.0), 0.0);
}

TEST(DeterministicMath, AngleOfVeryNearAndVeryFarPoints) {
    for (const double radius : {1e-300, 1e-200, 1e-160, 1e160, 1e300}) {
        expect_angle(radius, radius);
        expect_angle(-0.3 * radius, -radius);
        expect_angle(radius, 1e-9 * radius);
    }
}

TEST(DeterministicMath, SmallAnglesKeepTheirDigits) {
    for (const double angle : {1e-3, 1e-8, 1e-12}) {
        EXPECT_NEAR(sincos(angle).sin, std::sin(angle), 2e-16 * angle);
        EXPECT_NEAR(atan2_stable(angle, 1.0), std::atan2(angle, 1.0), 4e-16 * angle);
    }
}

TEST(DeterministicMath, ArcTangent) {
    std::mt19937_64 random(3);
    const auto expect = [](double x) {
        const long double truth = std::atan(static_cast<long double>(x));
        EXPECT_LE(std::fabs(arc_tangent(x) - truth), 4e-16L * std::fabs(truth)) << x;
    };
    for (int i = 0; i < 20000; ++i) {
        expect(2.0 * unit(random) - 1.0);
        expect(1.0 / (2.0 * unit(random) - 1.0));
        expect(std::ldexp(1.0 + unit(random), static_cast<int>(random() % 400) - 200));
    }
    for (int i = -64; i <= 64; ++i) expect(i / 8.0);  // where the pieces meet
    EXPECT_EQ(arc_tangent(HUGE_VAL), 0.5 * pi);
    EXPECT_EQ(arc_tangent(0.0), 0.0);
    EXPECT_TRUE(std::isnan(arc_tangent(NAN)));
}

TEST(DeterministicMath, Exponential) {
    std::mt19937_64 random(4);
    for (int i = 0; i < 20000; ++i) {
        for (const double x : {1400.0 * (unit(random) - 0.5), 2.0 * unit(random) - 1.0}) {
            const long double truth = std::exp(static_cast<long double>(x));
            EXPECT_LE(std::fabs(exponential(x) - truth), 4e-16L * truth) << x;
        }
    }
    EXPECT_EQ(exponential(0.0), 1.0);
    EXPECT_EQ(exponential(-1e4), 0.0);
    EXPECT_EQ(exponential(-HUGE_VAL), 0.0);
    EXPECT_EQ(exponential(1e4), HUGE_VAL);
    EXPECT_TRUE(std::isnan(exponential(NAN)));
    EXPECT_NEAR(exponential(-745.0) / 5e-324, 1.0, 0.5);  // near the smallest number
}

TEST(DeterministicMath, Logarithm) {
    std::mt19937_64 random(6);
    for (int i = 0; i < 20000; ++i) {
        for (const double x : {std::exp(1400.0 * (unit(random) - 0.5)), 0.5 + unit(random)}) {
            const long double truth = std::log(static_cast<long double>(x));
            EXPECT_LE(std::fabs(logarithm(x) - truth), 4e-16L * std::max(std::fabs(truth), 1e-3L)) << x;
        }
    }
    EXPECT_EQ(logarithm(1.0), 0.0);
    EXPECT_EQ(logarithm(0.0), -HUGE_VAL);
    EXPECT_EQ(logarithm(HUGE_VAL), HUGE_VAL);
    EXPECT_TRUE(std::isnan(logarithm(-1.0)));
    EXPECT_NEAR(logarithm(5e-324), -744.4400719213812, 1e-12);  // the smallest number
}

TEST(DeterministicMath, Hypotenuse) {
    std::mt19937_64 random(7);
    const auto expect = [](double x, double y) {
        const long double truth = std::hypot(static_cast<long double>(x), static_cast<long double>(y));
        const double at = hypotenuse(x, y);
        // Numbers below 2^-1022 lie 2^-1074 apart.
        EXPECT_LE(std::fabs(at - truth), std::max(2.3e-16L * truth, 0x1p-1074L)) << x << ", " << y;
        EXPECT_EQ(at, hypotenuse(y, x));
        EXPECT_EQ(at, hypotenuse(-x, y));
    };
    for (int i = 0; i < 20000; ++i) {
        const double x = 1.0 + unit(random), y = 2.0 * unit(random);
        expect(x, y);
        // Near the largest and the smallest numbers, and near the bounds of scaling.
        for (const int e : {-1070, -1030, -700, -501, -500, 499, 500, 501, 1022}) {
            expect(std::ldexp(0.7 * x, e), std::ldexp(0.7 * y, e));
            expect(std::ldexp(0.7 * x, e), std::ldexp(y, e - int(random() % 60)));
        }
    }
    EXPECT_EQ(hypotenuse(3.0, -4.0), 5.0);
    EXPECT_EQ(hypotenuse(0.0, -0.0), 0.0);
    EXPECT_EQ(hypotenuse(5e-324, 0.0), 5e-324);
    EXPECT_EQ(hypotenuse(0.0, -1.7e308), 1.7e308);
    EXPECT_EQ(hypotenuse(1.7e308, 1.7e308), HUGE_VAL);
    EXPECT_EQ(hypotenuse(NAN, -HUGE_VAL), HUGE_VAL);
    EXPECT_TRUE(std::isnan(hypotenuse(NAN, 1.0)));
    EXPECT_TRUE(std::isnan(hypotenuse(1e300, NAN)));
}

TEST(DeterministicMath, HyperbolicTangentAndSecant) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 20000; ++i) {
        const double x = (i % 2 ? 2.0 : 60.0) * (unit(random) - 0.5);
        const TanhSech at = tanh_sech(x);
        const long double sech = 1.0L / std::cosh(static_cast<long double>(x));
        EXPECT_LE(std::fabs(at.tanh - std::tanh(static_cast<long double>(x))), 4e-16L) << x;
        EXPECT_LE(std::fabs(at.sech - sech), 1e-15L * sech) << x;
    }
    EXPECT_EQ(tanh_sech(0.0).tanh, 0.0);
    EXPECT_EQ(tanh_sech(-1000.0).tanh, -1.0);
}

}  // namespace
}  // namespace tumble::deterministic_math_test
