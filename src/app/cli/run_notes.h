// Notes about a run: meshes without a volume, bodies that overlap at its start, and joints that broke.
#pragma once

#include "scene/description/description.h"
#include "sim/world.h"

#include <string>
#include <vector>

namespace tumble {

/// Lines that name meshes whose mass is not that of a volume, because they have none, and faces that were dropped; and
/// bodies that overlap at the start: the contact pushes them apart, with energy out of nothing. Empty where there are
/// none. Precondition: the world is at time 0.
std::string start_notes(const SceneDescription& scene, const World& world);

/// A joint that has broken in a run.
struct BrokenJoint {
    double time = 0.0;  // s
    std::string name;
};

/// In order of time.
std::vector<BrokenJoint> broken_joints(const SceneDescription& scene, const World& world);

/// A line for each of the first ones; with --log json an event for each.
void say_broken(const std::vector<BrokenJoint>& joints);

}  // namespace tumble
