// Torque-free rotation by Taylor series in higher precision: the reference for the double-precision code.
// Independent of it: body momentum and quaternion are integrated from Euler's equations, step by step.
#pragma once

#include "core/vector.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble::testing {

template <class Real>
using Quadruple = std::array<Real, 4>;  // w, x, y, z

/// dm/dt = m x m/I, dq/dt = q (m/I) / 2 with m = R(q)^T L made anew each step. The nearest pole in complex time is at
/// least about pi/2 / |omega| away: steps of 0.3 / |omega| to the 30th order are good for 20 digits.
template <class Real>
class RotationReference {
public:
    /// Principal axes are body axes.
    RotationReference(const Vec3& inertia, const Quat& orientation, const Vec3& angular_momentum)
        : q_{orientation.w(), orientation.x(), orientation.y(), orientation.z()} {
        for (int i = 0; i < 3; ++i) {
            inverse_[std::size_t(i)] = Real(1) / Real(inertia[i]);
            momentum_[std::size_t(i)] = angular_momentum[i];
        }
        const Vec3 m = orientation.conjugate() * angular_momentum;
        // |omega| varies by no more than energy allows.
        const Vec3 j = inertia.cwiseInverse();
        spin_ = std::min(std::sqrt(m.dot(j.cwiseProduct(m)) * j.maxCoeff()), m.norm() * j.maxCoeff());
    }

    void advance(double t) {
        const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(t) * spin_ / 0.3)));
        const Real h = Real(t) / Real(steps);
        for (int i = 0; i < steps; ++i) step(h);
    }

    const Quadruple<Real>& orientation() const { return q_; }

    /// Angle of the turn from here to q, rad.
    double angle_to(const Quat& q) const {
        const Real w = q.w(), x = q.x(), y = q.y(), z = q.z();
        const Real a = q_[0] * x - q_[1] * w - q_[2] * z + q_[3] * y;
        const Real b = q_[0] * y + q_[1] * z - q_[2] * w - q_[3] * x;
        const Real c = q_[0] * z - q_[1] * y + q_[2] * x - q_[3] * w;
        return 2.0 * std::sqrt(double(a * a + b * b + c * c));
    }

private:
    static constexpr std::size_t order = 30;

    // R(q)^T L.
    std::array<Real, 3> body_momentum() const {
        const auto& [w, x, y, z] = q_;
        const auto& l = momentum_;
        const Real t0 = 2 * (z * l[1] - y * l[2]), t1 = 2 * (x * l[2] - z * l[0]), t2 = 2 * (y * l[0] - x * l[1]);
        return {l[0] + w * t0 + z * t1 - y * t2, l[1] + w * t1 + x * t2 - z * t0, l[2] + w * t2 + y * t0 - x * t1};
    }

    void step(Real h) {
        std::array<std::array<Real, order + 1>, 3> m, w;
        std::array<std::array<Real, order + 1>, 4> q;
        const auto start = body_momentum();
        for (std::size_t i = 0; i < 3; ++i) m[i][0] = start[i];
        for (std::size_t i = 0; i < 4; ++i) q[i][0] = q_[i];
        for (std::size_t n = 0; n < order; ++n) {
            for (std::size_t i = 0; i < 3; ++i) w[i][n] = m[i][n] * inverse_[i];
            std::array<Real, 3> dm{};
            std::array<Real, 4> dq{};
            for (std::size_t k = 0; k <= n; ++k) {
                const std::size_t l = n - k;
                for (std::size_t i = 0; i < 3; ++i) {
                    const std::size_t a = (i + 1) % 3, b = (i + 2) % 3;
                    dm[i] += m[a][k] * w[b][l] - m[b][k] * w[a][l];
                    dq[1 + i] += q[0][k] * w[i][l] + q[1 + a][k] * w[b][l] - q[1 + b][k] * w[a][l];
                }
                dq[0] -= q[1][k] * w[0][l] + q[2][k] * w[1][l] + q[3][k] * w[2][l];
            }
            const Real next = Real(1) / Real(int(n + 1));
            for (std::size_t i = 0; i < 3; ++i) m[i][n + 1] = dm[i] * next;
            for (std::size_t i = 0; i < 4; ++i) q[i][n + 1] = dq[i] * next / 2;
        }
        Real norm = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            Real sum = q[i][order];
            for (std::size_t n = order; n-- > 0;) sum = sum * h + q[i][n];
            q_[i] = sum;
            norm += sum * sum;
        }
        for (Real& component : q_) component *= (3 - norm) / 2;
    }

    std::array<Real, 3> inverse_, momentum_;
    Quadruple<Real> q_;
    double spin_;  // rad/s, a bound
};

}  // namespace tumble::testing
