// What forces do to a rigid body, taken together; world frame.
#pragma once

#include "core/vector.h"

namespace tumble {

struct Wrench {
    Vec3 force = Vec3::Zero();    // N
    Vec3 torque = Vec3::Zero();   // N m, about the centre of mass
};

}  // namespace tumble
