// Groups, loops and degrees of freedom of the joints that hold at the present poses.
#pragma once

#include "sim/joints/joint_set.h"
#include "sim/snapshot/joint_report.h"

#include <vector>

namespace tumble {

/// `nets`: nets are solved in sweeps.
JointReport describe_joints(const JointSet& joints, const std::vector<Body>& bodies, bool nets);

}  // namespace tumble
