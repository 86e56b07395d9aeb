// Joints of a frame. Forces act on the second body, the opposite ones on the first. SI units, world frame; angles in
// rad.
#pragma once

#include "vector.h"

#include <array>
#include <optional>

TUMBLE_BEGIN

struct JointState {
    Vec3 point;  // m, of the second body's anchor
    // Six coordinates: displacements along x, y and z of the first body's joint frame, then angles about them. A
    // distance joint has the first alone, the distance of its anchors.
    std::array<bool, 6> free{};                 // or limited, otherwise locked
    std::array<double, 6> position{}, speed{};  // m and rad, m/s and rad/s; of locked coordinates: 0
    Vec3 force, torque;                         // N, N m about the anchor: means over the frame
    Vec3 moment;                                // N m about the world origin, of both: mean over the frame
    double gap = 0.0;                           // m, largest error of the locked coordinates; angles times the size
    int limit = 0;                              // -1 at a lower limit, 1 at an upper one or at the border of a cone
    bool active = true;                         // holds its bodies
    std::optional<double> broken_at;            // s
};

TUMBLE_END
