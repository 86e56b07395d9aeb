// The square root of a body's inverse mass matrix: the map from its mass-weighted velocity to its velocities.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/impact/velocity_row.h"

namespace tumble {

/// The square root of a dynamic body's inverse mass matrix: M^-1/2, and C with C C^T = I^-1.
struct MassRoot {
    double translation;  // kg^-1/2
    Mat3 turn;           // kg^-1/2 / m; by Cholesky in the body's frame, where needles and plates lose no digits

    explicit MassRoot(const Body& body);
    /// n . (v + omega x r) as a form of y, for an arm r and direction n.
    Vec6 row(const Vec3& arm, const Vec3& direction) const;
    /// n . omega as a form of y.
    Vec6 turning_row(const Vec3& direction) const;
    /// y of the body's velocities.
    Vec6 weighted(const Body& body) const;
};

}  // namespace tumble
