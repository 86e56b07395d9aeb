// Rolling and spinning friction of a contact under the load N.
//
// Rolling friction c resists the relative angular velocity across the normal, with a torque of at most c N r. r is the
// radius of the rounded surface; of two rounded surfaces, the radius r1 r2 / (r1 + r2) of a ball on a plane that is
// curved alike. Corners and edges have none. Spinning friction s (m) resists the angular velocity about the normal,
// with at most s N, beside the torsional friction of the contact area (spin_friction.h).
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/manifold.h"

namespace tumble {

struct RotationalFriction {
    double rolling = 0.0, spinning = 0.0;  // m, torque over load: c r and s

    bool none() const { return !(rolling > 0.0) && !(spinning > 0.0); }
};

RotationalFriction rotational_friction(const Manifold& manifold, const Body& a, const Body& b);

/// True if some contact of the body may have a resistance.
inline bool has_rotational_friction(const Body& body) {
    return body.rolling_friction > 0.0 || body.spinning_friction > 0.0;
}

}  // namespace tumble
