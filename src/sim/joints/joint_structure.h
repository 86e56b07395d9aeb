// Groups, loops and degrees of freedom of the joints that hold at the present poses.
#pragma once

#include "sim/joints/joint_set.h"
#include "sim/joints/net_way.h"
#include "sim/snapshot/joint_report.h"

#include <vector>

namespace tumble {

/// `nets`: the groups that are solved in sweeps.
JointReport describe_joints(const JointSet& joints, const std::vector<Body>& bodies, NetRule nets);

}  // namespace tumble
