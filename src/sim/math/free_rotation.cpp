#include "sim/math/free_rotation.h"

#include "core/deterministic_math.h"
#include "core/elliptic.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// For a modulus this small the functions are sines: its square is below the rounding of 1.
constexpr double smallest_modulus = 1e-9;
// Squares of (relative) momenta below this are at the end of a double's range; so small a wobble counts as steady.
constexpr double negligible = 1e-280;

struct HalfAngle {
    double cos, sin;
};

/// The angle in (-pi, pi] with this cosine and sine.
HalfAngle half_angle(double c, double s) {
    if (c >= 0.0) {
        const double h = std::sqrt(0.5 * (1.0 + c));
        return {h, 0.5 * s / h};
    }
    const double h = std::copysign(std::sqrt(0.5 * (1.0 - c)), s);
    return {0.5 * s / h, h};
}

/// The same orientation, with a length of one to second order of its rounding error.
Quat unit(const Quat& q) { return Quat(q.coeffs() * (1.5 - 0.5 * q.squaredNorm())); }

}  // namespace

FreeRotation::FreeRotation(const Vec3& principal_inertia, const Quat& principal_axes, const Quat& orientation,
                           const Vec3& angular_momentum)
    : start_(orientation), to_principal_(principal_axes.conjugate()) {
    begin(principal_inertia, principal_axes, angular_momentum);
}

void FreeRotation::begin(const Vec3& principal_inertia, const Quat& principal_axes, const Vec3& angular_momentum) {
    const double largest = angular_momentum.cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) return;
    const Vec3 scaled = angular_momentum / largest;  // squares of tiny momenta would be 0
    const double length = scaled.norm();
    axis_ = scaled / length;
    const double most = principal_inertia.maxCoeff();
    if (principal_inertia.minCoeff() == most) return set_steady(length * largest / most);

    // Moments near 1, scaled by a power of two: their differences must stay exact to the last bit.
    const double unit_inertia = std::ldexp(1.0, std::ilogb(most));
    const Vec3 inertia = principal_inertia / unit_inertia;
    const double rate = length * largest / unit_inertia;
    const Vec3 m = (start_ * principal_axes).conjugate() * axis_;
    // m x (m/I) = 0: m is a principal axis.
    Eigen::Index main;
    m.cwiseAbs().maxCoeff(&main);
    if (m.cross(m.cwiseQuotient(inertia)).isZero(0.0)) return set_steady(rate / inertia[main]);

    // Axes by moment of inertia; then cyclically permuted where needed, so that m circles axis 3 of (1, 2, 3).
    std::array<int, 3> o{0, 1, 2};
    std::sort(o.begin(), o.end(), [&](int a, int b) { return inertia[a] < inertia[b]; });
    // 2 T Imid - |L|^2, > 0 when m circles the axis of the least moment.
    const double side = m[o[0]] * m[o[0]] * ((inertia[o[1]] - inertia[o[0]]) / inertia[o[0]]) -
                        m[o[2]] * m[o[2]] * ((inertia[o[2]] - inertia[o[1]]) / inertia[o[2]]);
    const double s = side > 0.0 ? -1.0 : 1.0;
    if (side > 0.0) std::swap(o[0], o[2]);
    const bool right_handed = (o[1] - o[0] + 3) % 3 == 1;
    const double i1 = inertia[o[0]], i2 = inertia[o[1]], i3 = inertia[o[2]];
    const double m1 = m[o[0]], m2 = right_handed ? m[o[1]] : -m[o[1]], m3 = m[o[2]];
    const double d31 = s * (i3 - i1), d32 = s * (i3 - i2), d21 = s * (i2 - i1);
    const double a = m1 * m1 * (d31 / i1) + m2 * m2 * (d32 / i2);  // |2 T I3 - |L|^2|
    const double b = m2 * m2 * (d21 / i2) + m3 * m3 * (d31 / i3);  // ||L|^2 - 2 T I1|
    if (!(a > negligible) || !(d32 * b > negligible)) return set_steady(rate / inertia[main]);

    const double sense = std::copysign(1.0, m3) * s;  // direction of m around axis 3
    amplitude_cn_ = std::sqrt(i1 * a / d31);
    amplitude_sn_ = sense * std::sqrt(i2 * a / d32);
    amplitude_dn_ = std::copysign(std::sqrt(i3 * b / d31), m3);
    phase_rate_ = rate * std::sqrt(d32 * b / (i1 * i2 * i3));
    modulus_squared_ = std::min(1.0, d21 * a / (d32 * b));
    complement_squared_ = std::min(1.0, d31 * std::fabs(side) / (d32 * b));

    // The azimuth is that of one body axis, the pole, either axis 1 or axis 3. Its rate is, for axis 1,
    //   |L| (m2^2/I2 + m3^2/I3) / (m2^2 + m3^2) = |L| (1/I3 + (1/I2 - 1/I3) M2^2/M3^2 sn^2 / (1 + nu sn^2))
    // with nu = M1^2/M3^2, and for axis 3 the same with the axes 1 and 3 exchanged, sn^2 M2^2/M1^2 and
    // nu = M2^2/M1^2 - 1. Both are valid; the code chooses the one whose two terms are smaller, because their rounding
    // errors remain. Per |L| t, with t the time of about one revolution, they are:
    const double slowness =
        1.0 + 1.0 / (i2 * phase_rate_ / rate);  // of u: the initial phase counts as much as its change
    const double phases_1 = 1.0 / i3 + d31 * a / (i3 * (i3 * b + i1 * a)) * slowness;
    const double phases_3 = 1.0 / i1 + phase_rate_ / rate + d21 / (i1 * i2) * slowness;
    pole_circulates_ = phases_3 < phases_1;
    double factor;  // rad/s, of sn^2 / (1 + nu sn^2)
    if (pole_circulates_) {
        rate_ = rate / i1;
        factor = -s * rate * d21 * d31 / (i1 * i1 * d32);
        nu_ = i3 * d21 / (i1 * d32);
    } else {
        rate_ = rate / i3;
        factor = s * rate * a * d31 / (i3 * i3 * b);
        nu_ = i1 * a / (i3 * b);
    }
    azimuth_factor_ = factor / phase_rate_;
    order_ = pole_circulates_ ? std::array<int, 3>{o[2], o[0], o[1]} : o;
    if (!right_handed) sign_[pole_circulates_ ? 2 : 1] = -1.0;

    double cn = m1 / amplitude_cn_, sn = m2 / amplitude_sn_;
    const double circle = 1.0 / std::sqrt(cn * cn + sn * sn);
    sn *= circle;
    cn *= circle;
    if (complement_squared_ > 0.0) {
        start_periodic(sn, cn);
    } else {
        if (cn * cn < negligible) return set_steady(rate / inertia[main]);
        start_separatrix(sn, cn);
    }
    const Phase start = phase(phase_start_);
    integral_start_ = start.integral;
    start_ = start_ * principal_axes * from_principal(frame(start).conjugate());
}

void FreeRotation::set_steady(double rate) {
    kind_ = Kind::steady;
    rate_ = rate;
}

// u0 from the start's sn and cn, where cn = dn = sech: m1 keeps its sign too.
void FreeRotation::start_separatrix(double sn, double cn) {
    kind_ = Kind::separatrix;
    if (cn < 0.0) {
        amplitude_cn_ = -amplitude_cn_;
        amplitude_sn_ = -amplitude_sn_;
        sn = -sn;
    }
    phase_start_ = sn * carlson_rf(cn * cn, cn * cn, 1.0);  // asinh(sn / cn)
}

// The same for other parameters, and the constants of the modulus.
void FreeRotation::start_periodic(double sn, double cn) {
    kind_ = Kind::periodic;
    // Descending Landen transformation: k1 = (1 - k')/(1 + k'), k1'^2 = 4 k'/(1 + k')^2 (DLMF 19.8.12).
    double k = std::sqrt(modulus_squared_), complement = std::sqrt(complement_squared_);
    while (k > smallest_modulus && levels_ < most_levels) {
        const double sum = 1.0 + complement;
        k = (1.0 - complement) / sum;  // its accuracy is an absolute rounding error
        complement = 2.0 * std::sqrt(complement) / sum;
        level_[std::size_t(levels_++)] = {k, complement * complement};
        landen_scale_ /= 1.0 + k;
    }
    half_period_ = pi / landen_scale_;
    if (azimuth_factor_ != 0.0)
        integral_half_period_ = 2.0 / 3.0 * carlson_rj(0.0, complement_squared_, 1.0, 1.0 + nu_);

    const double dn_squared = complement_squared_ + modulus_squared_ * cn * cn;
    const double first = sn * carlson_rf(cn * cn, dn_squared, 1.0);
    phase_start_ = cn >= 0.0 ? first : std::copysign(half_period_, sn) - first;
}

// DLMF 22.7.2-4, upwards from the last level, where sn and cn are sine and cosine.
FreeRotation::Jacobi FreeRotation::jacobi(double u) const {
    auto [s, c] = sincos(u * landen_scale_);
    for (int i = levels_ - 1; i >= 0; --i) {
        const auto [k, complement_squared] = level_[std::size_t(i)];
        const double inverse = 1.0 / (1.0 + k * s * s);
        c *= std::sqrt(complement_squared + k * k * c * c) * inverse;
        s *= (1.0 + k) * inverse;
    }
    return {s, c, std::sqrt(complement_squared_ + modulus_squared_ * c * c)};
}

// int_0^u sn^2 / (1 + nu sn^2) du = sn^3 / 3 R_J(cn^2, dn^2, 1, 1 + nu sn^2) (DLMF 19.25.14), |u| <= K.
double FreeRotation::integral(const Jacobi& v) const {
    const double square = v.sn * v.sn;
    return square * v.sn / 3.0 * carlson_rj(v.cn * v.cn, v.dn * v.dn, 1.0, 1.0 + nu_ * square);
}

namespace {

// A whole number modulo 4; 0 where it is beyond all numbers, as with rates of a damaged checkpoint.
int quarter(double whole) {
    const double rest = whole - 4.0 * std::floor(0.25 * whole);
    return rest > 0.0 && rest < 4.0 ? int(rest) : 0;
}

}  // namespace

FreeRotation::Phase FreeRotation::phase(double u) const {
    Phase p;
    if (kind_ == Kind::separatrix) {
        const TanhSech at = tanh_sech(u);
        p.value = {at.tanh, at.sech, at.sech};
        // int_0^u tanh^2 / (1 + nu tanh^2) du, by partial fractions in tanh.
        const double root = std::sqrt(nu_);
        p.integral = (u - arc_tangent(root * at.tanh) / root) / (1.0 + nu_);
        return p;
    }
    p.half_periods = std::nearbyint(u / half_period_);
    p.value = jacobi(u - p.half_periods * half_period_);
    if (azimuth_factor_ != 0.0) p.integral = p.half_periods * integral_half_period_ + integral(p.value);
    return p;
}

// The rotation from the principal frame to one whose first axis is L's: R_b(-theta) R_p(-alpha), with theta the angle
// between m and the pole, and alpha that of m about the pole. Half angles by square roots.
Quat FreeRotation::frame(const Phase& phase) const {
    // The signs of sn and cn change after each half period.
    const double turned = quarter(phase.half_periods) % 2 != 0 && !pole_circulates_ ? -1.0 : 1.0;
    const double x = turned * amplitude_cn_ * phase.value.cn, y = turned * amplitude_sn_ * phase.value.sn,
                 z = amplitude_dn_ * phase.value.dn;
    const double p = pole_circulates_ ? z : x, a = pole_circulates_ ? x : y, b = pole_circulates_ ? y : z;
    const double across = std::sqrt(a * a + b * b), all = std::sqrt(across * across + p * p);
    HalfAngle alpha = half_angle(a / across, b / across);
    const HalfAngle theta = half_angle(p / all, across / all);
    if (pole_circulates_) {
        // Each half period of the phase is half a revolution of alpha: a quarter revolution of its half.
        switch (quarter(amplitude_sn_ < 0.0 ? -phase.half_periods : phase.half_periods)) {
            case 1:
                alpha = {-alpha.sin, alpha.cos};
                break;
            case 2:
                alpha = {-alpha.cos, -alpha.sin};
                break;
            case 3:
                alpha = {alpha.sin, -alpha.cos};
                break;
            default:
                break;
        }
    }
    return Quat(theta.cos * alpha.cos, -theta.cos * alpha.sin, theta.sin * alpha.sin, -theta.sin * alpha.cos);
}

Quat FreeRotation::from_principal(const Quat& turn) const {
    Quat q(turn.w(), 0.0, 0.0, 0.0);
    for (std::size_t i = 0; i < 3; ++i) q.vec()[order_[i]] = sign_[i] * turn.vec()[Eigen::Index(i)];
    return q;
}

Quat FreeRotation::at(double t) const {
    if (kind_ == Kind::rest) return start_;
    if (kind_ == Kind::steady) {
        const SinCos half = sincos(0.5 * rate_ * t);
        const Vec3 v = half.sin * axis_;
        return unit(Quat(half.cos, v.x(), v.y(), v.z()) * start_);
    }
    const Phase now = phase(phase_rate_ * t + phase_start_);
    const double azimuth = rate_ * t + azimuth_factor_ * (now.integral - integral_start_);
    const SinCos half = sincos(0.5 * azimuth);
    const Quat turn = Quat(half.cos, half.sin, 0.0, 0.0) * frame(now);
    return unit(start_ * from_principal(turn) * to_principal_);
}

}  // namespace tumble
