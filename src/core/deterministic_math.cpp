#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// pi/2 in four parts, the first three of 23 bits each, so that k * part is exact for |k| < 2^30
// (Cody and Waite 1980, "Software Manual for the Elementary Functions", ch. 8).
constexpr double half_pi_1 = 0x1.921fb4p+0;
constexpr double half_pi_2 = 0x1.4442dp-24;
constexpr double half_pi_3 = 0x1.846988p-48;
constexpr double half_pi_4 = 0x1.8cc51701b839ap-72;

// The integer nearest to x, |x| < 2^51, without a call: adding 3/2 * 2^52 leaves no bits for a fraction.
double nearest_whole(double x) {
    constexpr double no_fraction = 0x1.8p+52;
    return (x + no_fraction) - no_fraction;
}

// The series below are summed as two polynomials in z^2, even and odd, which a processor evaluates in parallel.

// Taylor series to x^17 and x^18: the remainder is below 1e-17 on |x| <= pi/4. `low` is the rest of the argument beyond
// x; its square is negligible.
double sin_series(double x, double low) {
    const double z = x * x, w = z * z;
    const double even = -1.0 / 6.0 + w * (-1.0 / 5040.0 + w * (-1.0 / 39916800.0 + w * (-1.0 / 1307674368000.0)));
    const double odd = 1.0 / 120.0 + w * (1.0 / 362880.0 + w * (1.0 / 6227020800.0 + w * (1.0 / 355687428096000.0)));
    return x + (x * z * (even + z * odd) + low * (1.0 - 0.5 * z));
}

double cos_series(double x, double low) {
    const double z = x * x, w = z * z;
    const double even = 1.0 / 24.0 + w * (1.0 / 40320.0 + w * (1.0 / 479001600.0 + w * (1.0 / 20922789888000.0)));
    const double odd =
        -1.0 / 720.0 + w * (-1.0 / 3628800.0 + w * (-1.0 / 87178291200.0 + w * (-1.0 / 6402373705728000.0)));
    const double half = 0.5 * z, head = 1.0 - half;
    return head + (((1.0 - head) - half) + (w * (even + z * odd) - x * low));  // adds the rounding error of head
}

// Taylor series to x^17 on |x| <= 1/8: the remainder is below 1e-17 of x.
double atan_series(double x) {
    const double z = x * x, w = z * z;
    const double even = -1.0 / 3.0 + w * (-1.0 / 7.0 + w * (-1.0 / 11.0 + w * (-1.0 / 15.0)));
    const double odd = 1.0 / 5.0 + w * (1.0 / 9.0 + w * (1.0 / 13.0 + w * (1.0 / 17.0)));
    return x + x * z * (even + z * odd);
}

// atan(k/4), and its rounding error.
struct SplitDouble {
    double high, low;
};
constexpr SplitDouble quarters_angle[] = {{0.0, 0.0},
                                          {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                          {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                          {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                          {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
constexpr SplitDouble right_angle{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

}  // namespace

SinCos sincos(double x) {
    if (std::fabs(x) <= 0.25 * pi) return {sin_series(x, 0.0), cos_series(x, 0.0)};
    if (!(std::fabs(x) <= 1.6e9)) {
        x = std::remainder(x, 2.0 * pi);  // 2 pi has a relative error of 4e-17, less than the rounding of x
        if (!std::isfinite(x)) return {x, x};
    }
    const double k = nearest_whole(x * (2.0 / pi));
    const double rest = (x - k * half_pi_1) - k * half_pi_2;  // exact
    const double third = k * half_pi_3, head = rest - third;
    const double tail = ((rest - head) - third) - k * half_pi_4;
    const double r = head + tail, low = (head - r) + tail;
    const double s = sin_series(r, low), c = cos_series(r, low);
    const auto quarter = static_cast<long long>(k);
    const double a = quarter & 1 ? c : s, b = quarter & 1 ? s : c;
    return {quarter & 2 ? -a : a, (quarter + 1) & 2 ? -b : b};
}

double arc_tangent(double x) {
    const double t = std::fabs(x);
    double angle;
    if (t <= 1.0) {
        // atan(t) = atan(c) + atan((t - c)/(1 + c t)) with c the nearest quarter.
        const int k = static_cast<int>(4.0 * t + 0.5);
        const double c = 0.25 * k;
        const SplitDouble& at = quarters_angle[k];
        angle = at.high + (at.low + atan_series((t - c) / (1.0 + c * t)));
    } else if (t <= 0x1p+60) {
        // The same for 1/t: the angle is the complement.
        const int k = static_cast<int>(4.0 / t + 0.5);
        const double c = 0.25 * k;
        const SplitDouble& at = quarters_angle[k];
        angle = (right_angle.high - at.high) + ((right_angle.low - at.low) - atan_series((1.0 - c * t) / (t + c)));
    } else {
        angle = t > 0.0 ? right_angle.high : t;  // or NaN
    }
    return x < 0.0 ? -angle : angle;
}

double atan2_stable(double y, double x) {
    if (x == 0.0 && y == 0.0) return 0.0;
    const double ax = std::fabs(x), ay = std::fabs(y);
    double a = ay <= ax ? arc_tangent(ay / ax) : 0.5 * pi - arc_tangent(ax / ay);
    if (x < 0.0) a = pi - a;
    return y < 0.0 ? -a : a;
}

double exponential(double x) {
    constexpr double ln2_1 = 0x1.62e42feep-1, ln2_2 = 0x1.a39ef35793c76p-33;  // k * ln2_1 is exact for |k| < 2^21
    if (!(std::fabs(x) < 800.0)) return x < 0.0 ? 0.0 : x > 0.0 ? HUGE_VAL : x;
    const double k = nearest_whole(x * (1.0 / (ln2_1 + ln2_2)));
    const double high = x - k * ln2_1, low = k * ln2_2, r = high - low;
    // Taylor series to r^14 on |r| <= ln(2)/2; the remainder is below 2e-19.
    double p = 1.0;
    for (int n = 14; n >= 2; --n) p = 1.0 + r * p / n;
    const double tail = (high - r) - low;
    return std::ldexp(1.0 + (r * p + tail), static_cast<int>(k));
}

double logarithm(double x) {
    constexpr double ln2_1 = 0x1.62e42feep-1, ln2_2 = 0x1.a39ef35793c76p-33;  // k * ln2_1 is exact for |k| < 2^21
    if (!(x > 0.0)) return x == 0.0 ? -HUGE_VAL : std::nan("");
    if (x == HUGE_VAL) return x;
    int k = 0;
    double m = std::frexp(x, &k);                 // exact
    if (m < 0x1.6a09e667f3bcdp-1) m *= 2.0, --k;  // sqrt(1/2) <= m < sqrt(2)
    // ln m = 2 atanh s, s = (m - 1) / (m + 1), as a series to s^23; the remainder is below 1e-19.
    const double f = m - 1.0, s = f / (2.0 + f), square = s * s;
    double series = 0.0;
    for (int n = 23; n >= 3; n -= 2) series = (series + 1.0 / n) * square;
    // 2 s = f - s f, so that f, which is exact, carries the digits.
    return k * ln2_1 + (f - (s * (f - 2.0 * series) - k * ln2_2));
}

double hypotenuse(double x, double y) {
    x = std::fabs(x), y = std::fabs(y);
    if (x == HUGE_VAL || y == HUGE_VAL) return HUGE_VAL;
    // A scale by a power of two rounds nothing that counts: beside a number in these bounds, one whose square
    // underflows adds less than a rounding.
    constexpr double least = 0x1p-500, most = 0x1p+500, shift = 0x1p+600;
    const double larger = x < y ? y : x;
    if (larger > most) {
        x *= 1.0 / shift, y *= 1.0 / shift;
        return std::sqrt(x * x + y * y) * shift;
    }
    if (larger < least) {
        x *= shift, y *= shift;
        return std::sqrt(x * x + y * y) * (1.0 / shift);
    }
    return std::sqrt(x * x + y * y);
}

TanhSech tanh_sech(double x) {
    const double e = exponential(-std::fabs(x)), square = e * e;
    const double t = (1.0 - square) / (1.0 + square);
    return {x < 0.0 ? -t : t, 2.0 * e / (1.0 + square)};
}

}  // namespace tumble
