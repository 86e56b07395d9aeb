// How easily a link swings about its joints: a pendulum under tension T, of lever r about a joint, swings at the rate
// sqrt(T r / I). The step must resolve it, because a joint's force keeps its direction through a step.
#pragma once

#include "sim/joints/joint.h"

#include <array>

namespace tumble {

/// The axes, world, about which a joint lets its bodies turn against each other. Three: all axes alike.
struct FreeAxes {
    int count = 3;
    std::array<Vec3, 3> axis;
};
FreeAxes free_axes(const Joint& joint, const JointGeometry& g);

/// Square of the rate of the swing (1/s^2) over the tension (N), of a body with the joint at `arm` (m) from its center
/// of mass. A rod has the lever l / 2 and I = m l^2 / 12: both of its joints together give 4 T / (m l).
double pendulum_compliance(const FreeAxes& axes, const Vec3& arm, const Mat3& inverse_inertia);

}  // namespace tumble
