// One body under gravity, drag and a force at a point, in extended precision: the classical Runge-Kutta method in steps
// so small that its error is far below a double's rounding. Shares no code with the simulation.
#pragma once

#include "core/vector.h"

#include <array>
#include <cmath>

namespace tumble::testing {

struct ReferenceBody {
    using Real = long double;
    using Vector = std::array<Real, 3>;

    Real mass = 1;
    Vector inertia{1, 1, 1};  // about the body axes
    Vector gravity{0, 0, 0};
    Vector wind{0, 0, 0};
    Real drag = 0;             // F = drag |u| u
    Vector point{0, 0, 0};     // body frame, from the center of mass
    Vector force{0, 0, 0};     // at the point
    bool force_turns = false;  // with the body
    std::array<Real, 13> y{};  // x, q (w, x, y, z), v, L

    void advance(double seconds, int steps) {
        const Real h = Real(seconds) / steps;
        for (int i = 0; i < steps; ++i) {
            const auto k1 = rate(y), k2 = rate(moved(y, k1, h / 2)), k3 = rate(moved(y, k2, h / 2)),
                       k4 = rate(moved(y, k3, h));
            for (std::size_t n = 0; n < 13; ++n) y[n] += h / 6 * (k1[n] + 2 * k2[n] + 2 * k3[n] + k4[n]);
        }
    }

    Vec3 position() const { return {double(y[0]), double(y[1]), double(y[2])}; }
    Vec3 velocity() const { return {double(y[7]), double(y[8]), double(y[9])}; }
    Vec3 angular_momentum() const { return {double(y[10]), double(y[11]), double(y[12])}; }
    double angle_to(const Quat& q) const {
        const Real n = std::sqrt(y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6]);
        const Real w = q.w(), a = q.x(), b = q.y(), c = q.z();
        const Real i = y[3] * a - y[4] * w - y[5] * c + y[6] * b, j = y[3] * b + y[4] * c - y[5] * w - y[6] * a,
                   k = y[3] * c - y[4] * b + y[5] * a - y[6] * w;
        return double(2 * std::sqrt(i * i + j * j + k * k) / n);
    }

private:
    using State = std::array<Real, 13>;

    static State moved(const State& s, const State& k, Real h) {
        State r;
        for (std::size_t n = 0; n < 13; ++n) r[n] = s[n] + h * k[n];
        return r;
    }
    static Vector cross(const Vector& a, const Vector& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }
    // Columns are the body's axes.
    static std::array<Vector, 3> axes(const State& s) {
        const Real w = s[3], x = s[4], z = s[6], v = s[5], n = w * w + x * x + v * v + z * z;
        return {Vector{(w * w + x * x - v * v - z * z) / n, 2 * (x * v + w * z) / n, 2 * (x * z - w * v) / n},
                Vector{2 * (x * v - w * z) / n, (w * w - x * x + v * v - z * z) / n, 2 * (v * z + w * x) / n},
                Vector{2 * (x * z + w * v) / n, 2 * (v * z - w * x) / n, (w * w - x * x - v * v + z * z) / n}};
    }
    static Vector world(const std::array<Vector, 3>& a, const Vector& p) {
        Vector r{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t n = 0; n < 3; ++n) r[n] += a[i][n] * p[i];
        return r;
    }

    State rate(const State& s) const {
        const auto a = axes(s);
        Vector omega{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Real spin = (a[i][0] * s[10] + a[i][1] * s[11] + a[i][2] * s[12]) / inertia[i];
            for (std::size_t n = 0; n < 3; ++n) omega[n] += spin * a[i][n];
        }
        const Vector u{wind[0] - s[7], wind[1] - s[8], wind[2] - s[9]};
        const Real speed = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
        const Vector f = force_turns ? world(a, force) : force, torque = cross(world(a, point), f);
        State r;
        for (std::size_t n = 0; n < 3; ++n) {
            r[n] = s[7 + n];
            r[7 + n] = gravity[n] + (drag * speed * u[n] + f[n]) / mass;
            r[10 + n] = torque[n];
        }
        const Vector q{s[4], s[5], s[6]}, wq = cross(omega, q);
        r[3] = -(omega[0] * q[0] + omega[1] * q[1] + omega[2] * q[2]) / 2;
        for (std::size_t n = 0; n < 3; ++n) r[4 + n] = (s[3] * omega[n] + wq[n]) / 2;
        return r;
    }
};

}  // namespace tumble::testing
