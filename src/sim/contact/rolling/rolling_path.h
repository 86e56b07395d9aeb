// A curved body that touches a fixed plane at one point, under gravity: it rolls, slides, leaves the plane, and changes
// from one to the other at any time. With the contact's arm r from the center, its force F and the plane's normal n,
// Newton and Euler (notes section 2) are
//   M v' = M g + F,  I w' = -w x I w + r x F,
// and the contact point's acceleration gives F (Rosenberg 1977, "Analytical Dynamics of Discrete Systems", rolling
// disk):
//   rolls:   0 = v' + w' x r + w x r'         and |F - (n.F) n| <= mu n.F
//   slides:  0 = n.(v' + w' x r + w x r')     and F = N (n - mu s), s the direction of the slip
// r' has the rotation of the body and the motion of the contact over it, from the derivative of the support point.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/dynamics/integrators/rigid_state.h"

#include <optional>

namespace tumble {

struct RollingPlane {
    Vec3 normal = Vec3::UnitY();  // unit, out of the solid
    double offset = 0.0;          // m, normal . p of its surface
    double friction = 0.0, restitution = 0.0;
};

struct RolledStep {
    RigidState end;
    double slipped = 0.0;  // J, lost by friction
};

/// The motion through `span` s from the body's present state under the acceleration `gravity` (m/s^2), to 1e-12 of the
/// body's size. A body that leaves the plane flies, and lands without a bounce. None where the body tilts onto a face,
/// where its contact jumps (from one rim to the other) and may bounce, or where it changes its way too often: the
/// contact solver has to decide. Precondition: body.collider is a CurvedBody.
std::optional<RolledStep> roll(const Body& body, const RollingPlane& plane, const Vec3& gravity, double span);

}  // namespace tumble
