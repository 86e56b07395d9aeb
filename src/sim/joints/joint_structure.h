// Groups, loops and degrees of freedom of the joints that hold at the present poses.
#pragma once

#include "sim/joints/joint_set.h"
#include "sim/joints/joint_way.h"
#include "sim/snapshot/joint_report.h"

#include <vector>

namespace tumble {

JointReport describe_joints(const JointSet& joints, const std::vector<Body>& bodies, SweepRule rule);

}  // namespace tumble
