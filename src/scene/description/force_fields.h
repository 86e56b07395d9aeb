// Forces that depend on the place of a body, and forces between bodies at a distance. World frame, SI units.
#pragma once

#include "core/vector.h"

#include <cstddef>
#include <vector>

namespace tumble {

enum class FieldKind { uniform, point, vortex, drag };
enum class RegionKind { all, box, sphere };

/// Where a field acts: on bodies whose center of mass is inside.
struct FieldRegion {
    RegionKind kind = RegionKind::all;
    Vec3 center = Vec3::Zero();  // m
    Vec3 size = Vec3::Zero();    // m, of a box along the axes of the world
    double radius = 0.0;         // m, of a sphere

    bool contains(const Vec3& p) const {
        const Vec3 r = p - center;
        if (kind == RegionKind::sphere) return r.squaredNorm() <= radius * radius;
        return kind == RegionKind::all || (r.cwiseAbs().array() <= 0.5 * size.array()).all();
    }
};

/// A force on the center of mass of each dynamic body, r = x - center, in [start, end).
///   uniform  m acceleration
///   point    -m strength r / (|r|^2 + softening^2)^(3/2)
///   vortex   m strength axis x r / (|axis x r|^2 + softening^2)
///   drag     linear u + quadratic |u| u, of u = velocity - v
struct FieldDescription {
    FieldKind type = FieldKind::uniform;
    Vec3 acceleration = Vec3::Zero();      // m/s^2
    Vec3 center = Vec3::Zero();            // m
    Vec3 axis{0.0, 1.0, 0.0};              // unit
    double strength = 0.0;                 // m^3/s^2; of a vortex m^2/s^2
    double softening = 0.0;                // m
    Vec3 velocity = Vec3::Zero();          // m/s, of the medium
    double linear = 0.0, quadratic = 0.0;  // N s/m, N s^2/m^2
    FieldRegion region;
    double start = 0.0, end = 0.0;  // s; infinity: forever
};

enum class PairForceKind { gravity, coulomb, spring, inverse_square, dipole };

/// A force between the centers of mass of each two of the bodies, at the distance d, with s = d^2 + softening^2.
///   gravity         attracts by strength m1 m2 d / s^(3/2)
///   coulomb         repels by strength q1 q2 d / s^(3/2)
///   inverse_square  attracts by strength d / s^(3/2)
///   spring          attracts by stiffness (d - length) + damping d'
///   dipole          force and torques of the energy strength (m1 m2 / s^(3/2) - 3 (m1 d) (m2 d) / s^(5/2))
struct PairForceDescription {
    PairForceKind type = PairForceKind::gravity;
    std::vector<std::size_t> bodies;                      // indices into bodies, at least two
    double strength = 0.0;                                // m^3/(kg s^2), N m^2/C^2, N m^2, N/A^2
    double softening = 0.0;                               // m
    std::vector<double> charges;                          // C, of the bodies
    std::vector<Vec3> moments;                            // A m^2, of the bodies, body frame
    double stiffness = 0.0, damping = 0.0, length = 0.0;  // N/m, N s/m, m
    double start = 0.0, end = 0.0;                        // s; infinity: forever
};

/// At a time each dynamic body takes the impulse that the explosion sends into the directions in which it sees the
/// body, times (1 - d^2 / radius^2)^2, with d the distance of its center of mass.
struct ExplosionDescription {
    Vec3 center = Vec3::Zero();  // m
    double time = 0.0;           // s
    double impulse = 0.0;        // N s, the sum of the lengths over all directions
    double radius = infinity;    // m
};

}  // namespace tumble
