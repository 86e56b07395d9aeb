// Joints that have broken in a run, for its summary.
#pragma once

#include "sim/world.h"

#include <string>
#include <vector>

namespace tumble {

struct BrokenJoint {
    double time = 0.0;  // s
    std::string name;
};

/// In order of time.
std::vector<BrokenJoint> broken_joints(const SceneDescription& scene, const World& world);

/// A line for each of the first ones; with --log json an event for each.
void say_broken(const std::vector<BrokenJoint>& joints);

}  // namespace tumble
