// The step of a tree: its bodies, joints and forces, and the frame in which it is computed.
#pragma once

#include "core/vector.h"
#include "sim/articulation/settings.h"
#include "sim/dynamics/body.h"
#include "sim/dynamics/forces.h"
#include "sim/joints/joint.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct TreeStep {
    std::vector<Body>& bodies;
    std::span<const std::uint32_t> island;  // indices of the tree's bodies, ascending
    std::span<Joint* const> joints;
    const ForceField& forces;
    double from, h;                            // s: start and length
    double length;                             // m, mean radius of the bodies
    double whole = 0.0;                        // s: of the step that this one is a part of; 0: itself
    int most_steps = tuning::tree_most_steps;  // of half a radian each
    std::span<const Joint> all = {};           // that gears refer to
    bool late = false;                         // begins within a step, at whose start the carriers stand
};

/// A frame that falls freely, with the center of mass of a free tree: there uniform gravity does not act.
struct FallingFrame {
    Vec3 origin = Vec3::Zero(), velocity = Vec3::Zero(), gravity = Vec3::Zero();  // at the start of the step

    Vec3 place(double t) const { return origin + t * (velocity + 0.5 * t * gravity); }
    Vec3 speed(double t) const { return velocity + t * gravity; }
};

}  // namespace tumble
