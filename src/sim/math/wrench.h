// Resultant of the forces on a rigid body; world frame.
#pragma once

#include "core/vector.h"

namespace tumble {

struct Wrench {
    Vec3 force = Vec3::Zero();   // N
    Vec3 torque = Vec3::Zero();  // N m, about the center of mass
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [force, torque] = self;
        archive.keep(force, torque);
    }
};

/// Integral of a wrench over a span of time; world frame.
struct Impulse {
    Vec3 linear = Vec3::Zero();   // N s
    Vec3 angular = Vec3::Zero();  // N m s, about the center of mass
    friend Impulse operator+(const Impulse& l, const Impulse& r) {
        return {l.linear + r.linear, l.angular + r.angular};
    }
    friend Impulse operator-(const Impulse& l, const Impulse& r) {
        return {l.linear - r.linear, l.angular - r.angular};
    }
};

}  // namespace tumble
