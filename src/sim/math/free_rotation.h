// Torque-free rotation of a rigid body in closed form: the solution of Euler's equations at any later or earlier time,
// at the same cost and with the same error for all times. There is no step.
//
// The momentum in body axes, m(t), moves along the curve where the sphere |m| = |L| meets the energy's ellipsoid; its
// components are Jacobi's elliptic functions cn, sn and dn of a phase u = lambda t + u0. That gives the orientation
// except for a rotation about L: the azimuth of one body axis, the pole, whose rate is an elliptic integral of the
// third kind. So
//   q(t) = (frame of m and the pole at 0)^-1, rotation by the azimuth about L, (the same frame at t).
//
// van Zon and Schofield 2007, "Numerical implementation of the exact dynamics of free rigid bodies", J. Comput. Phys.
// 225; Landau and Lifshitz, "Mechanics", section 37; Jacobi's functions by the ascending Landen transformation (DLMF
// 22.7), the integrals by Carlson's method (core/elliptic.h). Written without cancellation: differences of moments of
// inertia are taken first, the complementary modulus is kept instead of 1 - k^2, and the pole is the axis whose azimuth
// is the smaller phase.
//
// Error: a few roundings of the phase, about 1e-15 (1 + |omega| t) rad, also near the separatrix and for needles.
#pragma once

#include "core/vector.h"

#include <array>

namespace tumble {

class FreeRotation {
public:
    FreeRotation() = default;  // constant orientation

    /// principal_inertia: kg m^2; principal_axes rotates principal coordinates into body coordinates; orientation
    /// rotates body into world; angular_momentum: world, kg m^2/s. All at t = 0.
    FreeRotation(const Vec3& principal_inertia, const Quat& principal_axes, const Quat& orientation,
                 const Vec3& angular_momentum);

    /// Body to world, t s after the start (before it, if negative).
    Quat at(double t) const;

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [kind, start, to_principal, axis, rate, order, sign, pole_circulates, amplitude_cn, amplitude_sn,
               amplitude_dn, phase_rate, phase_start, half_period, azimuth_factor, nu, modulus_squared,
               complement_squared, integral_start, integral_half_period, levels, level, landen_scale] = self;
        archive.enumeration(kind, Kind::separatrix);
        archive.keep(start, to_principal, axis, rate, sign, pole_circulates, amplitude_cn, amplitude_sn, amplitude_dn,
                     phase_rate, phase_start, half_period, azimuth_factor, nu, modulus_squared, complement_squared,
                     integral_start, integral_half_period, level, landen_scale);
        archive.between(0, levels, most_levels);
        for (auto& principal : order) archive.between(0, principal, 2);
    }

private:
    enum class Kind {
        rest,
        steady,      // about a constant axis: a sphere, or a spin about a principal axis
        periodic,    // about the axis of the least or the greatest moment of inertia
        separatrix,  // exactly between these two: approaches the middle axis, once
    };

    struct Jacobi {
        double sn, cn, dn;
    };
    struct Phase {
        double half_periods = 0.0;    // integer: u = 2 K half_periods + rest
        Jacobi value{0.0, 1.0, 1.0};  // at the rest; cn >= 0
        double integral = 0.0;        // int_0^u sn^2 / (1 + nu sn^2) du
    };

    void begin(const Vec3& principal_inertia, const Quat& principal_axes, const Vec3& angular_momentum);
    void set_steady(double rate);
    void start_periodic(double sn, double cn);
    void start_separatrix(double sn, double cn);
    Jacobi jacobi(double u) const;
    double integral(const Jacobi& value) const;
    Phase phase(double u) const;
    Quat frame(const Phase& phase) const;
    Quat from_principal(const Quat& turn) const;

    static constexpr int most_levels = 16;  // the smallest k' of a double needs 12

    Kind kind_ = Kind::rest;
    Quat start_ = Quat::Identity();  // orientation at t = 0; of the periodic kinds, relative to the frame of m at t = 0
    Quat to_principal_ = Quat::Identity();
    Vec3 axis_ = Vec3::UnitY();  // steady: of L, world, unit
    double rate_ = 0.0;          // rad/s; steady: of the rotation; otherwise of the azimuth where sn = 0

    // Principal axes in the order (pole, a, b), a right-handed frame: index and sign of each.
    std::array<int, 3> order_{0, 1, 2};
    std::array<double, 3> sign_{1.0, 1.0, 1.0};
    bool pole_circulates_ = false;  // the pole is the axis that m circles (dn); otherwise it is that of cn
    double amplitude_cn_ = 0.0, amplitude_sn_ = 0.0, amplitude_dn_ = 0.0;  // amplitudes of m / |L|, signed
    double phase_rate_ = 0.0, phase_start_ = 0.0;                          // lambda (rad/s), u0
    double half_period_ = 0.0;                                             // 2 K
    double azimuth_factor_ = 0.0;                                          // rad, factor of the integral
    double nu_ = 0.0;
    double modulus_squared_ = 0.0, complement_squared_ = 0.0;  // k^2, k'^2
    double integral_start_ = 0.0, integral_half_period_ = 0.0;
    // Landen's descending moduli, and the squares of their complements.
    struct Level {
        double modulus, complement_squared;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [modulus, complement_squared] = self;
            archive.keep(modulus, complement_squared);
        }
    };
    int levels_ = 0;
    std::array<Level, most_levels> level_{};
    double landen_scale_ = 1.0;  // factor of u at the last level
};

}  // namespace tumble
