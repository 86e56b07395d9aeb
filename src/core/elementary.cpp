#include "core/elementary.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// pi/2 in three parts of at most 33 bits each, so that k * part is exact for |k| < 2^20
// (Cody and Waite 1980, "Software Manual for the Elementary Functions", ch. 8).
constexpr double half_pi_1 = 1.57079632673412561417e+00;
constexpr double half_pi_2 = 6.07710050630396597660e-11;
constexpr double half_pi_3 = 2.02226624879595063154e-21;

// Taylor series to x^17 and x^18: the remainder is below 1e-17 on |x| <= pi/4.
double sin_series(double x) {
    const double z = x * x;
    double p = 1.0 / 355687428096000.0;
    p = p * z - 1.0 / 1307674368000.0;
    p = p * z + 1.0 / 6227020800.0;
    p = p * z - 1.0 / 39916800.0;
    p = p * z + 1.0 / 362880.0;
    p = p * z - 1.0 / 5040.0;
    p = p * z + 1.0 / 120.0;
    p = p * z - 1.0 / 6.0;
    return x + x * z * p;
}

double cos_series(double x) {
    const double z = x * x;
    double p = -1.0 / 6402373705728000.0;
    p = p * z + 1.0 / 20922789888000.0;
    p = p * z - 1.0 / 87178291200.0;
    p = p * z + 1.0 / 479001600.0;
    p = p * z - 1.0 / 3628800.0;
    p = p * z + 1.0 / 40320.0;
    p = p * z - 1.0 / 720.0;
    p = p * z + 1.0 / 24.0;
    return 1.0 - 0.5 * z + z * z * p;
}

}  // namespace

SinCos sincos(double x) {
    const double k = std::nearbyint(x * (2.0 / pi));
    const double r = ((x - k * half_pi_1) - k * half_pi_2) - k * half_pi_3;
    const double s = sin_series(r), c = cos_series(r);
    switch (static_cast<long long>(k) & 3) {
        case 0: return {s, c};
        case 1: return {c, -s};
        case 2: return {-s, -c};
        default: return {-c, s};
    }
}

double atan2_stable(double y, double x) {
    if (x == 0.0 && y == 0.0) return 0.0;
    // Scale onto the unit circle, then one half-angle step and Newton steps on sin(a - angle) = 0:
    // each step cubes the error, so a rough start of 1e-2 ends at rounding after two.
    // The larger coordinate goes first: squares of tiny and huge ones are no numbers any more.
    const double largest = std::max(std::fabs(x), std::fabs(y));
    const double u = x / largest, v = y / largest;
    const double r = std::sqrt(u * u + v * v);
    const double s = v / r, c = u / r;
    const double ax = std::fabs(c), ay = std::fabs(s);
    const double t = ax > ay ? ay / ax : ax / ay;
    double a = t * (0.9724 - 0.1919 * t * t);
    if (ay >= ax) a = 0.5 * pi - a;
    if (c < 0.0) a = pi - a;
    if (s < 0.0) a = -a;
    for (int i = 0; i < 3; ++i) {
        const SinCos at = sincos(a);
        const double e = s * at.cos - c * at.sin;   // sin(true - a)
        a += e + e * e * e / 6.0;
    }
    return a;
}

}  // namespace tumble
