// The target of a motor: constant, or through keyframes as a kinematic body moves through its own (keyframe_track.h).
#pragma once

#include "scene/description/joint.h"

namespace tumble {

/// m or rad. Precondition: the motor has targets.
double motor_target(const JointMotor& motor, double time);

}  // namespace tumble
