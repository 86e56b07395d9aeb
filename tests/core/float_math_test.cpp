#include "core/float_math.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::float_math_test {
namespace {

// The errors stated in the header, against libm in double.
TEST(FloatMath, CubeRoot) {
    for (double exponent = -40.0; exponent < 40.0; exponent += 0.001) {
        const float x = static_cast<float>(std::exp2(exponent));
        const double exact = std::cbrt(double(x));
        EXPECT_LE(std::fabs(double(cube_root(x)) - exact), 4e-7 * exact) << x;
    }
    EXPECT_LT(cube_root(0.0f), 1e-12f);
}

TEST(FloatMath, LogarithmAndExponential) {
    for (double exponent = -120.0; exponent < 120.0; exponent += 0.003) {
        const float x = static_cast<float>(std::exp2(exponent));
        const double exact = std::log2(double(x));
        EXPECT_LE(std::fabs(double(logarithm_2(x)) - exact), 2e-7 + 1e-7 * std::fabs(exact)) << x;
        const float e = static_cast<float>(exponent);
        const double power_of_2 = std::exp2(double(e));
        EXPECT_LE(std::fabs(double(exponential_2(e)) - power_of_2), 2e-7 * power_of_2) << e;
    }
    EXPECT_EQ(exponential_2(0.0f), 1.0f);
    EXPECT_EQ(logarithm_2(8.0f), 3.0f);
}

TEST(FloatMath, Power) {
    for (double exponent = -39.8; exponent < 19.9; exponent += 0.003)
        for (const float y : {0.0f, 0.01f, 0.3f, 0.7f, 0.99f, 1.0f}) {
            const float x = static_cast<float>(std::exp2(exponent));
            const double exact = std::pow(double(x), double(y));
            EXPECT_LE(std::fabs(double(power(x, y)) - exact), 3e-6 * exact) << x << " to the power " << y;
        }
    EXPECT_EQ(power(0.0f, 0.5f), 0.0f);
    EXPECT_EQ(power(1.0f, 0.7f), 1.0f);
}

}  // namespace
}  // namespace tumble::float_math_test
