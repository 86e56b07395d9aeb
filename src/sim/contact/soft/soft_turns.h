// The turns of a joint in the soft kernel (TurnRows in soft_joint_rows.h): its axes, limits, dampers and friction, from
// the joint to a lane and back.
#pragma once

#include "sim/contact/soft/soft_joint_rows.h"
#include "sim/joints/joint.h"

#include <array>

namespace tumble {

/// Kind of a joint that sweeps know (known_to_sweeps).
soft::JointKind kind_in_sweeps(const Joint& joint);

/// The axes of a joint's turns, one for each of the coordinates 3 to 5, of the poses at the start of a step.
struct TurnAxes {
    std::array<Vec3, 3> axis;           // unit, world
    std::array<double, 3> scale;        // rate of the coordinate over that of the turn about the axis
    std::array<double, 3> least, most;  // rad, about the axis
    std::array<bool, 3> locked{};
    Vec3 bend = Vec3::Zero();  // as in soft::TurnRows
    double circle = 0.0, twist = 0.0;
    bool round = false;  // of a round cone
    double limit = 0.0;  // rad, its half angle
    Vec3 twist_a, twist_b;
};
TurnAxes turn_axes(const Joint& joint, const JointGeometry& g);

struct TurnUnits {
    double share;    // of a step's impulse in a substep, over the unit of mass
    double substep;  // s
    double mass;     // kg, of the kernel's numbers
};
void pack_turns(const Joint& joint, const JointGeometry& g, const TurnAxes& axes, const TurnUnits& units,
                const soft::TurnLane& lane, bool driven);

/// The impulses about the axes, for the next step: into Joint::impulse.
void unpack_turns(const TurnAxes& axes, const Mat3& frame, const TurnUnits& units, const soft::TurnLane& lane,
                  Joint& joint, bool driven);

}  // namespace tumble
