#include "scene/keys/chain_curve.h"

#include "core/deterministic_math.h"
#include "scene/keys/joint_places.h"

#include <array>
#include <cmath>

namespace tumble {
namespace {

/// Horizontal unit normal of the vertical plane through the direction.
Vec3 normal_of_vertical_plane(const Vec3& direction) {
    const Vec3 across_plane = direction.cross(Vec3::UnitY());
    const double size = across_plane.norm();
    return size > 1e-9 * direction.norm() ? Vec3(across_plane / size) : Vec3(Vec3::UnitZ());
}

// The tangent of the slope of link i is curve (i - middle) + tilt.
struct Slopes {
    std::size_t links;
    double curve = 0.0, tilt = 0.0;

    /// Horizontal and vertical length of the first links, for links of unit length.
    std::array<double, 2> reach(std::size_t first) const {
        std::array<double, 2> sum{};
        for (std::size_t i = 0; i < first; ++i) {
            const auto [x, y] = link(i);
            sum[0] += x;
            sum[1] += y;
        }
        return sum;
    }
    std::array<double, 2> link(std::size_t i) const {
        const double slope = curve * (double(i) - 0.5 * double(links - 1)) + tilt;
        const double cosine = 1.0 / std::sqrt(1.0 + slope * slope);
        return {cosine, slope * cosine};
    }
};

/// The zero of an increasing function between two places with f(low) < 0 < f(high): regula falsi with halved ends
/// (Illinois), to the last bits.
template <class Function>
double zero_between(const Function& f, double low, double high) {
    constexpr int most = 200;
    double f_low = f(low), f_high = f(high);
    if (f_low >= 0.0) return low;
    if (f_high <= 0.0) return high;
    int side = 0;
    for (int i = 0; i < most && high - low > 4e-16 * (std::fabs(low) + std::fabs(high)); ++i) {
        double middle = (low * f_high - high * f_low) / (f_high - f_low);
        if (!(middle > low && middle < high) || i % 3 == 2) middle = 0.5 * (low + high);
        const double value = f(middle);
        if (value == 0.0) return middle;
        if (value < 0.0) {
            low = middle, f_low = value;
            if (side < 0) f_high *= 0.5;
            side = -1;
        } else {
            high = middle, f_high = value;
            if (side > 0) f_low *= 0.5;
            side = 1;
        }
    }
    return 0.5 * (low + high);
}

/// A place above `start` where the increasing function is not negative.
template <class Function>
double place_above_zero(const Function& f, double start) {
    double at = start;
    constexpr int most = 40;  // a slope of 1e12 is vertical
    for (int i = 0; i < most && f(at) < 0.0; ++i) at *= 2.0;
    return at;
}

/// The tilt with which the ends are as far above each other as they should be.
Slopes tilted(std::size_t links, double curve, double rise_over_run) {
    if (rise_over_run == 0.0) return {links, curve, 0.0};
    const auto excess = [&](double tilt) {
        const auto [x, y] = Slopes{links, curve, tilt}.reach(links);
        return y - rise_over_run * x;
    };
    const double sign = rise_over_run > 0.0 ? 1.0 : -1.0;
    const auto above = [&](double size) { return sign * excess(sign * size); };
    const double far = place_above_zero(above, std::fabs(rise_over_run) + 1e-3 * curve);
    return {links, curve, sign * zero_between(above, 0.0, far)};
}

struct Chord {
    Vec3 from, to;
    double run, rise;  // m

    Chord(const Vec3& a, const Vec3& b)
        : from(a), to(b), run(Vec3(b.x() - a.x(), 0.0, b.z() - a.z()).norm()), rise(b.y() - a.y()) {}
    /// Lengths relative to the chord have no meaning for a chain that hangs from one place to one below.
    bool vertical() const { return run <= 1e-9 * std::fabs(rise) || run == 0.0; }
};

/// Links with these slopes from one end of the chord to the other.
ChainCurve placed(const Chord& chord, const Slopes& slopes) {
    const std::size_t n = slopes.links;
    const double link = chord.run / slopes.reach(n)[0];
    ChainCurve curve;
    curve.normal = normal_of_vertical_plane(chord.to - chord.from);
    const Vec3 along((chord.to.x() - chord.from.x()) / chord.run, 0.0, (chord.to.z() - chord.from.z()) / chord.run);
    curve.corners.push_back(chord.from);
    double x = 0.0, y = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto [dx, dy] = slopes.link(i);
        x += link * dx;
        y += link * dy;
        curve.corners.push_back(chord.from + x * along + y * Vec3::UnitY());
    }
    // The rest of rounding is spread over all links.
    const Vec3 rest = chord.to - curve.corners.back();
    for (std::size_t i = 1; i <= n; ++i) curve.corners[i] += rest * (double(i) / double(n));
    curve.corners.back() = chord.to;
    return curve;
}

/// The curve whose property, which grows with it, is 0; empty if there is none.
template <class Property>
std::optional<ChainCurve> curve_with(const Chord& chord, std::size_t links, const Property& property) {
    constexpr double tolerance = 1e-9;  // of the chord: rounding of long chains, and much less than a wrong curve
    if (chord.vertical()) return std::nullopt;
    const auto of_curve = [&](double curve) { return property(tilted(links, curve, chord.rise / chord.run)); };
    const double far = place_above_zero(of_curve, 1.0 / double(links));
    if (!(of_curve(far) >= 0.0)) return std::nullopt;
    const Slopes slopes = tilted(links, zero_between(of_curve, 0.0, far), chord.rise / chord.run);
    const auto [x, y] = slopes.reach(links);
    const double size = std::fabs(chord.run) + std::fabs(chord.rise);
    if (!(std::fabs(y / x * chord.run - chord.rise) <= tolerance * size)) return std::nullopt;
    if (!(std::fabs(property(slopes)) <= tolerance * size * double(links))) return std::nullopt;
    return placed(chord, slopes);
}

}  // namespace

ChainCurve straight_chain(const Vec3& from, const Vec3& to, std::size_t links) {
    ChainCurve curve;
    curve.normal = normal_of_vertical_plane(to - from);
    for (std::size_t i = 0; i <= links; ++i) curve.corners.push_back(from + (to - from) * (double(i) / double(links)));
    return curve;
}

std::optional<ChainCurve> hanging_chain_of_length(const Vec3& from, const Vec3& to, std::size_t links, double length) {
    const Chord chord(from, to);
    return curve_with(chord, links, [&](const Slopes& slopes) {
        return double(links) * chord.run - length * slopes.reach(links)[0];
    });
}

std::optional<ChainCurve> hanging_chain_of_sag(const Vec3& from, const Vec3& to, std::size_t links, double sag) {
    const Chord chord(from, to);
    return curve_with(chord, links, [&](const Slopes& slopes) {
        const double middle_link = links % 2 == 0 ? 0.0 : 0.5 * slopes.link(links / 2)[1];
        const double middle = slopes.reach(links / 2)[1] + middle_link;
        const double link = chord.run / slopes.reach(links)[0];
        return 0.5 * chord.rise - link * middle - sag;
    });
}

ChainCurve closed_chain(const Vec3& from, const Vec3& to, std::size_t links, const std::optional<Vec3>& normal) {
    ChainCurve curve;
    const Vec3 center = 0.5 * (from + to), arm = from - center;
    curve.normal = normal ? *normal : normal_of_vertical_plane(to - from);
    const Vec3 other = curve.normal.cross(arm);
    for (std::size_t i = 0; i < links; ++i) {
        const SinCos angle = sincos(2.0 * pi * double(i) / double(links));
        curve.corners.push_back(center + angle.cos * arm + angle.sin * other);
    }
    curve.corners.push_back(curve.corners.front());
    return curve;
}

}  // namespace tumble
