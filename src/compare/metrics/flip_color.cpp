#include "compare/metrics/flip_color.h"

#include "compare/metrics/background.h"
#include "core/cpu_dispatch.h"
#include "core/float_math.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Linear RGB to X/Xn, Y/Yn, Z/Zn: the primaries of IEC 61966-2-1 with the white D65, x 0.31271 and y 0.32902. Each row
// sums to 1, since white has X = Xn.
constexpr double to_x[] = {10135552.0 / 23359437.0, 8788810.0 / 23359437.0, 4435075.0 / 23359437.0};
constexpr double to_y[] = {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0};
constexpr double to_z[] = {1425312.0 / 80288307.0, 8788810.0 / 80288307.0, 70074185.0 / 80288307.0};

struct Matrix {
    float m[3][3];
};

constexpr Matrix forward{{{float(to_x[0]), float(to_x[1]), float(to_x[2])},
                          {float(to_y[0]), float(to_y[1]), float(to_y[2])},
                          {float(to_z[0]), float(to_z[1]), float(to_z[2])}}};

constexpr double minor(const double* a, const double* b, int i, int j) { return a[i] * b[j] - a[j] * b[i]; }

/// The inverse by cofactors.
constexpr Matrix inverse() {
    const double determinant =
        to_x[0] * minor(to_y, to_z, 1, 2) - to_x[1] * minor(to_y, to_z, 0, 2) + to_x[2] * minor(to_y, to_z, 0, 1);
    Matrix result{};
    const double* rows[] = {to_x, to_y, to_z};
    for (int c = 0; c < 3; ++c) {
        const double *a = rows[(c + 1) % 3], *b = rows[(c + 2) % 3];
        for (int r = 0; r < 3; ++r) result.m[r][c] = float(minor(a, b, (r + 1) % 3, (r + 2) % 3) / determinant);
    }
    return result;
}
constexpr Matrix backward = inverse();

struct Triple {
    float a, b, c;
};

inline Triple multiplied(const Matrix& t, float a, float b, float c) {
    return {t.m[0][0] * a + t.m[0][1] * b + t.m[0][2] * c, t.m[1][0] * a + t.m[1][1] * b + t.m[1][2] * c,
            t.m[2][0] * a + t.m[2][1] * b + t.m[2][2] * c};
}

inline float clamped(float v) { return std::min(std::max(v, 0.0f), 1.0f); }

/// The function f of CIE L*a*b* (ISO/CIE 11664-4).
inline float lightness_root(float t) {
    constexpr float delta = 6.0f / 29.0f;
    const float root = cube_root(t), line = t * (1.0f / (3.0f * delta * delta)) + 4.0f / 29.0f;
    return t > delta * delta * delta ? root : line;
}

/// L* and, with the adjustment of Hunt (sec. 4.1.2), a* and b*: colors differ less where it is dark.
inline Triple hunt_lab(float x, float y, float z) {
    const float fx = lightness_root(x), fy = lightness_root(y), fz = lightness_root(z);
    const float l = 116.0f * fy - 16.0f;
    return {l, 0.01f * l * (500.0f * (fx - fy)), 0.01f * l * (200.0f * (fy - fz))};
}

/// The filters may leave the gamut: colors are clamped in linear RGB.
inline Triple filtered_lab(float y, float x_y, float y_z) {
    const Triple rgb = multiplied(backward, y + x_y, y, y - y_z);
    const Triple xyz = multiplied(forward, clamped(rgb.a), clamped(rgb.b), clamped(rgb.c));
    return hunt_lab(xyz.a, xyz.b, xyz.c);
}

/// HyAB (sec. 4.1.3): city blocks between lightness and color, Euclidean within color.
inline float hyab(const Triple& p, const Triple& q) {
    const float db = p.b - q.b, dc = p.c - q.c;
    return std::fabs(p.a - q.a) + std::sqrt(db * db + dc * dc);
}

// Sec. 4.1.4 and 4.3: exponents of differences of colors and of features; differences up to the fraction p_c of the
// largest are mapped to [0, p_t], since few pixels have larger ones.
constexpr float q_c = 0.7f, p_c = 0.4f, p_t = 0.95f;

struct ColorRange {
    float largest, knee;  // largest difference to the power q_c, which green and blue have; p_c of it
};

ColorRange color_range() {
    const Triple green = hunt_lab(forward.m[0][1], forward.m[1][1], forward.m[2][1]);
    const Triple blue = hunt_lab(forward.m[0][2], forward.m[1][2], forward.m[2][2]);
    const float largest = power(hyab(green, blue), q_c);
    return {largest, p_c * largest};
}

inline float color_difference(const Triple& p, const Triple& q, const ColorRange& range) {
    const float d = power(hyab(p, q), q_c);
    const float below = d * (p_t / range.knee);
    const float above = p_t + (d - range.knee) / (range.largest - range.knee) * (1.0f - p_t);
    return d < range.knee ? below : std::min(above, 1.0f);
}

inline float length(float a, float b) { return std::sqrt(a * a + b * b); }

/// Linear light of an sRGB level (IEC 61966-2-1), without libm: the power 2.4 is a square times the square of a fifth
/// root, by Newton's iteration from above.
double linear_light(int level) {
    const double value = level / 255.0;
    if (value <= 0.04045) return value / 12.92;
    const double t = (value + 0.055) / 1.055;
    double root = 1.0;
    for (int i = 0; i < 30; ++i) root -= (root - t / (root * root * root * root)) / 5.0;
    return t * t * root * root;
}

}  // namespace

OpponentColors::OpponentColors() {
    for (int i = 0; i < 256; ++i) linear_[i] = static_cast<float>(linear_light(i));
}

void OpponentColors::convert(const PixelRow& from, const OpponentRow& to) const {
    for (std::size_t i = 0; i < from.count; ++i) {
        const int x = std::clamp(from.first + static_cast<int>(i), 0, from.width - 1);
        const std::uint8_t* const pixel = from.pixels + 4 * std::size_t(x);
        const Triple n = multiplied(forward, linear_[seen_on_background(pixel, 0, from.background)],
                                    linear_[seen_on_background(pixel, 1, from.background)],
                                    linear_[seen_on_background(pixel, 2, from.background)]);
        to.y[i] = n.b;
        to.x_y[i] = n.a - n.b;
        to.y_z[i] = n.b - n.c;
    }
}

TUMBLE_WIDE void flip_row(const FilteredRow& a, const FilteredRow& b, std::size_t count, float* __restrict to) {
    const FilteredRow p = a, q = b;
    const ColorRange range = color_range();
    constexpr float half_root = 0.707106781f;  // 1/sqrt(2): a gradient of two channels of [-1, 1] has at most sqrt(2)
    for (std::size_t i = 0; i < count; ++i) {
        const Triple lab_p = filtered_lab(p.y[i], p.x_y[i], p.y_z[0][i] + p.y_z[1][i]);
        const Triple lab_q = filtered_lab(q.y[i], q.x_y[i], q.y_z[0][i] + q.y_z[1][i]);
        const float color = color_difference(lab_p, lab_q, range);
        const float edges = std::fabs(length(p.dx[i], p.dy[i]) - length(q.dx[i], q.dy[i]));
        const float points = std::fabs(length(p.dxx[i], p.dyy[i]) - length(q.dxx[i], q.dyy[i]));
        const float feature = std::sqrt(half_root * std::max(edges, points));  // the exponent q_f is 1/2
        to[i] = power(color, 1.0f - std::min(feature, 1.0f));
    }
}

}  // namespace tumble
