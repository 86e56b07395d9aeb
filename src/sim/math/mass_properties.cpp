#include "sim/math/mass_properties.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {

MassProperties placed(const MassProperties& properties, const Vec3& position, const Quat& rotation) {
    MassProperties p = properties;
    p.center_of_mass = position + rotation * properties.center_of_mass;
    const Mat3 turn = rotation.toRotationMatrix();
    const Mat3 inertia = turn * properties.inertia * turn.transpose();
    p.inertia = 0.5 * (inertia + inertia.transpose());  // symmetric to the last bit
    return p;
}

MassProperties sum_of_masses(const std::vector<MassProperties>& parts) {
    MassProperties whole;
    Vec3 first = Vec3::Zero();  // sum of m x
    for (const MassProperties& part : parts) {
        whole.mass += part.mass;
        first += part.mass * part.center_of_mass;
    }
    if (!(whole.mass > 0.0)) return whole;
    whole.center_of_mass = first / whole.mass;
    for (const MassProperties& part : parts) {
        const Vec3 d = part.center_of_mass - whole.center_of_mass;
        whole.inertia += part.inertia + part.mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    }
    return whole;
}

MassProperties with_mass(const MassProperties& properties, double mass) {
    MassProperties p = properties;
    p.inertia *= mass / properties.mass;
    p.mass = mass;
    return p;
}

PrincipalInertia principal_inertia(const Mat3& tensor) {
    // Tolerance relative to the moments: the largest rounding error of integrals over a mesh of thousands of triangles.
    constexpr double same = 1e-14;
    Mat3 a = tensor, axes = Mat3::Identity();
    const auto negligible = [&](int p, int q) { return std::abs(a(p, q)) <= same * std::min(a(p, p), a(q, q)); };
    // Each sweep squares the remaining off-diagonal elements, and 5 or 6 are enough.
    for (int sweep = 0; sweep < 20; ++sweep) {
        if (negligible(0, 1) && negligible(0, 2) && negligible(1, 2)) break;
        for (const auto& [p, q] : {std::array{0, 1}, std::array{0, 2}, std::array{1, 2}}) {
            if (a(p, q) == 0.0) continue;
            // The smaller root t = tan of t^2 + 2 theta t - 1 = 0 makes a_pq zero.
            const double theta = (a(q, q) - a(p, p)) / (2.0 * a(p, q));
            const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
            const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
            const int r = 3 - p - q;
            const double app = a(p, p) - t * a(p, q), aqq = a(q, q) + t * a(p, q);
            const double arp = c * a(r, p) - s * a(r, q), arq = s * a(r, p) + c * a(r, q);
            a(p, p) = app;
            a(q, q) = aqq;
            a(p, q) = a(q, p) = 0.0;
            a(r, p) = a(p, r) = arp;
            a(r, q) = a(q, r) = arq;
            const Vec3 vp = axes.col(p), vq = axes.col(q);
            axes.col(p) = c * vp - s * vq;
            axes.col(q) = s * vp + c * vq;
        }
    }
    PrincipalInertia result{a.diagonal(), Quat(axes).normalized()};
    Vec3& m = result.moments;
    const auto equal = [&](int i, int j) { return std::abs(m[i] - m[j]) <= same * std::max(m[i], m[j]); };
    if (equal(0, 1) && equal(0, 2) && equal(1, 2)) {
        if (m[0] != m[1] || m[0] != m[2]) m.setConstant(m.sum() / 3.0);
        result.axes.setIdentity();
    } else {
        for (const auto& [i, j] : {std::array{0, 1}, std::array{0, 2}, std::array{1, 2}})
            if (equal(i, j) && m[i] != m[j]) m[i] = m[j] = 0.5 * (m[i] + m[j]);
    }
    return result;
}

}  // namespace tumble
