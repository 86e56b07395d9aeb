#include "core/elliptic.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// The series left out by carlson_rf and carlson_rj begin with terms of eighth degree in the arguments' relative
// distance from their mean, with coefficients below 0.1: at this distance they are below 1e-17 of the sum.
constexpr double near = 0.01;

// Arguments with any exponents of doubles are close to each other after this many duplications; NaN ends the loop as
// well.
constexpr int most_rounds = 600;

}  // namespace

double carlson_rc1(double e) {
    // The alternating series' next term is e^9/19 < 6e-17.
    if (e < 0.02) {
        const double w = e * e;
        const double even = -1.0 / 3.0 + w * (-1.0 / 7.0 + w * (-1.0 / 11.0 + w * (-1.0 / 15.0)));
        const double odd = 1.0 / 5.0 + w * (1.0 / 9.0 + w * (1.0 / 13.0 + w * (1.0 / 17.0)));
        return 1.0 + e * (even + e * odd);
    }
    const double root = std::sqrt(e);
    return arc_tangent(root) / root;
}

double carlson_rf(double x, double y, double z) {
    double mean = (x + y + z) / 3.0;
    // X = (mean_0 - x_0) / (4^n mean_n): the distances shrink exactly fourfold.
    double dx = mean - x, dy = mean - y;
    double distance = std::max({std::fabs(dx), std::fabs(dy), std::fabs(mean - z)});
    for (int round = 0; distance > near * mean && round < most_rounds; ++round) {
        const double sx = std::sqrt(x), sy = std::sqrt(y), sz = std::sqrt(z);
        const double shift = sx * sy + (sx + sy) * sz;
        x = 0.25 * (x + shift);
        y = 0.25 * (y + shift);
        z = 0.25 * (z + shift);
        mean = 0.25 * (mean + shift);
        dx *= 0.25;
        dy *= 0.25;
        distance *= 0.25;
    }
    const double scale = 1.0 / mean;
    const double a = dx * scale, b = dy * scale, c = -(a + b);
    const double e2 = a * b - c * c, e3 = a * b * c;
    // DLMF 19.36.1.
    const double series = 1.0 + e2 * (-1.0 / 10 + e2 * (1.0 / 24 - 5.0 / 208 * e2) - 3.0 / 44 * e3) +
                          e3 * (1.0 / 14 + 3.0 / 104 * e3 + e2 * e2 / 16);
    return series / std::sqrt(mean);
}

double carlson_rj(double x, double y, double z, double p) {
    double mean = (x + y + z + 2.0 * p) / 5.0;
    double dx = mean - x, dy = mean - y, dz = mean - z;
    double distance = std::max({std::fabs(dx), std::fabs(dy), std::fabs(dz), std::fabs(mean - p)});
    double difference = (p - x) * (p - y) * (p - z);
    double sum = 0.0, quarters = 1.0;
    for (int round = 0; distance > near * mean && round < most_rounds; ++round) {
        const double sx = std::sqrt(x), sy = std::sqrt(y), sz = std::sqrt(z), sp = std::sqrt(p);
        const double shift = sx * sy + (sx + sy) * sz;
        const double d = (sp + sx) * (sp + sy) * (sp + sz);
        sum += quarters / d * carlson_rc1(std::max(0.0, difference / (d * d)));
        quarters *= 0.25;
        difference *= 1.0 / 64.0;
        x = 0.25 * (x + shift);
        y = 0.25 * (y + shift);
        z = 0.25 * (z + shift);
        p = 0.25 * (p + shift);
        mean = 0.25 * (mean + shift);
        dx *= 0.25;
        dy *= 0.25;
        dz *= 0.25;
        distance *= 0.25;
    }
    const double scale = 1.0 / mean;
    const double a = dx * scale, b = dy * scale, c = dz * scale, q = -0.5 * (a + b + c), q2 = q * q;
    const double e2 = a * b + (a + b) * c - 3.0 * q2;
    const double abc = a * b * c;
    const double e3 = abc + 2.0 * e2 * q + 4.0 * q2 * q;
    const double e4 = (2.0 * abc + e2 * q + 3.0 * q2 * q) * q;
    const double e5 = abc * q2;
    // DLMF 19.36.2.
    const double series = 1.0 - 3.0 / 14 * e2 + e3 / 6 + 9.0 / 88 * e2 * e2 - 3.0 / 22 * e4 - 9.0 / 52 * e2 * e3 +
                          3.0 / 26 * e5 - e2 * e2 * e2 / 16 + 3.0 / 40 * e3 * e3 + 3.0 / 20 * e2 * e4 +
                          45.0 / 272 * e2 * e2 * e3 - 9.0 / 68 * (e3 * e4 + e2 * e5);
    return quarters * series * scale / std::sqrt(mean) + 6.0 * sum;
}

}  // namespace tumble
