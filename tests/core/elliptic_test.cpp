// Carlson's integrals compared with published values, with 128-bit numerical integration, and with identities.
#include "core/elliptic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace tumble::elliptic_test {
namespace {

__extension__ using Wide = __float128;

Wide root(Wide x) {
    if (x == 0) return 0;
    Wide r = std::sqrt(static_cast<double>(x));
    for (int i = 0; i < 3; ++i) r = (r + x / r) / 2;
    return r;
}

// The defining integrals by the double-exponential rule (Takahasi and Mori 1974): with
// t = exp(pi/2 sinh v) the integrand decays doubly exponentially at both ends, and the trapezoidal rule is exact.
struct Node {
    Wide t, weight;
};

const Wide half_pi = static_cast<Wide>(1.5707963267948966) + static_cast<Wide>(6.123233995736766e-17);

const std::vector<Node>& nodes() {
    static const std::vector<Node> made = [] {
        std::vector<Node> list;
        const long double h = 1.0L / 64;
        for (int i = -330; i <= 330; ++i) {
            const long double v = h * i;
            const long double t = std::exp(1.57079632679489661923L * std::sinh(v));
            list.push_back({t, h * 1.57079632679489661923L * std::cosh(v) * t});
        }
        return list;
    }();
    return made;
}

Wide reference_rf(double x, double y, double z) {
    Wide sum = 0;
    for (const Node& n : nodes()) sum += n.weight / root((n.t + x) * (n.t + y) * (n.t + z));
    return sum / 2;
}

Wide reference_rj(double x, double y, double z, double p) {
    Wide sum = 0;
    for (const Node& n : nodes()) sum += n.weight / (root((n.t + x) * (n.t + y) * (n.t + z)) * (n.t + p));
    return 3 * sum / 2;
}

void expect_relative(double value, Wide truth, double allowed) {
    EXPECT_LE(std::fabs(static_cast<double>((value - truth) / truth)), allowed) << value;
}

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

}  // namespace

// Carlson 1995, section 3: numerical checks.
TEST(Elliptic, PublishedValues) {
    EXPECT_NEAR(carlson_rf(1.0, 2.0, 0.0), 1.3110287771461, 1e-13);
    EXPECT_NEAR(carlson_rf(0.5, 1.0, 0.0), 1.8540746773014, 1e-13);
    EXPECT_NEAR(carlson_rf(2.0, 3.0, 4.0), 0.58408284167715, 1e-14);
    EXPECT_NEAR(carlson_rj(0.0, 1.0, 2.0, 3.0), 0.77688623778582, 1e-14);
    EXPECT_NEAR(carlson_rj(2.0, 3.0, 4.0, 5.0), 0.14297579667157, 1e-14);
    EXPECT_NEAR(carlson_rc1(0.25), std::atan(0.5) / 0.5, 1e-15);
}

TEST(Elliptic, AgainstTheDefiningIntegrals) {
    std::mt19937_64 random(11);
    for (int i = 0; i < 60; ++i) {
        // The arguments of Jacobi's functions: x = cn^2, y = dn^2, z = 1, p = 1 + nu sn^2, also near 0 and far from 1.
        const double cn2 = i % 3 == 0 ? std::ldexp(unit(random), -static_cast<int>(random() % 60)) : unit(random);
        const double k2 = i % 5 == 0 ? 1.0 - std::ldexp(1.0, -static_cast<int>(random() % 40) - 1) : unit(random);
        const double dn2 = (1.0 - k2) + k2 * cn2;
        const double p = 1.0 + std::ldexp(unit(random), static_cast<int>(random() % 60) - 30);
        // And so close to each other that the series is used at once.
        const double x = 1.0 + 0.015 * unit(random), y = 1.0 + 0.015 * unit(random);
        expect_relative(carlson_rf(x, y, 1.0), reference_rf(x, y, 1.0), 1e-15);
        expect_relative(carlson_rj(x, y, 1.0, 1.017), reference_rj(x, y, 1.0, 1.017), 1e-15);
        expect_relative(carlson_rf(cn2, dn2, 1.0), reference_rf(cn2, dn2, 1.0), 1e-15);
        expect_relative(carlson_rj(cn2, dn2, 1.0, p), reference_rj(cn2, dn2, 1.0, p), 2e-15);
    }
}

// R_F(x, x, x) = x^-1/2, R_J(x, x, x, x) = x^-3/2, R_F(0, y, y) = pi/2 / sqrt(y), and homogeneity.
TEST(Elliptic, ClosedFormsAndHomogeneity) {
    std::mt19937_64 random(12);
    for (int i = 0; i < 2000; ++i) {
        const double x = std::ldexp(0.5 + unit(random), static_cast<int>(random() % 200) - 100);
        expect_relative(carlson_rf(x, x, x), 1 / root(x), 1e-15);
        expect_relative(carlson_rj(x, x, x, x), 1 / (root(x) * x), 2e-15);
        expect_relative(carlson_rf(0.0, x, x), half_pi / root(x), 1e-15);
        // R_C(x, y) = R_F(x, y, y).
        const double e = std::ldexp(unit(random), static_cast<int>(random() % 80) - 40);
        expect_relative(carlson_rc1(e), carlson_rf(1.0, 1.0 + e, 1.0 + e), 2e-15);
        const double a = unit(random), b = unit(random), p = 1.0 + unit(random);
        EXPECT_EQ(carlson_rf(16.0 * a, 16.0 * b, 16.0), 0.25 * carlson_rf(a, b, 1.0));
        EXPECT_EQ(carlson_rj(16.0 * a, 16.0 * b, 16.0, 16.0 * p), carlson_rj(a, b, 1.0, p) / 64.0);
    }
}

// Invalid arguments do not loop, and give an invalid number.
TEST(Elliptic, EndsOnBadArguments) {
    EXPECT_TRUE(std::isnan(carlson_rf(NAN, 1.0, 1.0)));
    EXPECT_TRUE(std::isnan(carlson_rj(0.5, NAN, 1.0, 1.0)));
    EXPECT_TRUE(std::isfinite(carlson_rf(1e-300, 1e-300, 1.0)));
    EXPECT_TRUE(std::isfinite(carlson_rj(1e-300, 1e-200, 1.0, 1e100)));
}

}  // namespace tumble::elliptic_test
