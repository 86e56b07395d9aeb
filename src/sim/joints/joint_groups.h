// Groups of dynamic bodies that joints connect. Joints to the world, or to a body that is not dynamic, connect nothing.
#pragma once

#include "sim/joints/joint_set.h"

#include <cstdint>
#include <vector>

namespace tumble {

struct JointGroup {
    std::vector<std::uint32_t> bodies;  // ascending
    std::vector<std::uint32_t> joints;  // indices into JointSet::joints(), ascending
    bool anchored = false;              // by a joint to the world, or to a body that is not dynamic
};

/// Groups of the joints that hold, in the order of their lowest bodies.
std::vector<JointGroup> find_joint_groups(const JointSet& joints, const std::vector<Body>& bodies);

}  // namespace tumble
