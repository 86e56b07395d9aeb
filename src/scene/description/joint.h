// Joints between two bodies, or between a body and the world: plain values, checked and with all defaults filled in.
//
// A joint has a frame fixed in each of its two bodies. The pose of the second frame relative to the first has six
// coordinates: three displacements along the axes of the first frame, and three angles. Each of them is locked, free or
// limited. The types of joint are presets of these six; a distance joint has one coordinate, the distance of its
// anchors. A gear has none: it couples the coordinates of two other joints.
#pragma once

#include "core/vector.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Interpolation between keyframes: of bodies, the camera and motors.
enum class Interpolation { smooth, linear };

enum class JointType { fixed, hinge, ball, slider, universal, cylindrical, planar, distance, six_dof, gear };

/// A spring with a damper along one coordinate, implicit in time: stable for any stiffness.
struct JointSpring {
    double stiffness = 0.0;    // N/m, or N m/rad
    double damping = 0.0;      // N s/m, or N m s/rad
    double frequency = 0.0;    // Hz; above 0 instead of the two above, for the effective mass of the joint at the start
    double damping_ratio = 0;  // of critical damping, with a frequency
    double rest = 0.0;         // m, or rad
};

struct JointTarget {
    double time = 0.0;   // s, increasing
    double value = 0.0;  // m, or rad
};

/// A motor along one coordinate: it keeps a speed, or it moves to a target as a spring with a damper.
struct JointMotor {
    std::optional<double> speed;       // m/s, or rad/s
    std::vector<JointTarget> targets;  // one: constant; several: keyframes
    Interpolation interpolation = Interpolation::smooth;
    double stiffness = 0.0;       // N/m, or N m/rad; of the motor with a target
    double damping = 0.0;         // N s/m, or N m s/rad
    double max_force = infinity;  // N, or N m
};

/// One coordinate of a joint.
struct JointAxis {
    enum class Motion { locked, free, limited };
    Motion motion = Motion::locked;
    double lower = -infinity, upper = infinity;  // m, or rad; of a limited coordinate
    double restitution = 0.0;                    // 0..1, at the limits
    std::optional<JointSpring> spring;
    std::optional<JointMotor> motor;
    double friction = 0.0;  // N, or N m: the largest force of dry friction
};

struct JointDescription {
    std::string name;  // given, or "joint N" with its index
    JointType type = JointType::fixed;
    std::optional<std::size_t> first, second;  // indices into bodies; empty: the world
    // Joint frame of each side: in the body's frame, from the body's origin; in world coordinates for the world. x is
    // the axis of a hinge, slider, cylindrical joint or twist, and the normal of a planar joint; a universal joint has
    // its first axis x in the first body and its second axis y in the second body.
    Vec3 anchor_first = Vec3::Zero(), anchor_second = Vec3::Zero();        // m
    Quat frame_first = Quat::Identity(), frame_second = Quat::Identity();  // joint frame to body frame
    std::array<JointAxis, 3> move, turn;                                   // along and about x, y, z of the frame
    std::optional<std::array<double, 2>> swing;  // rad: half angles of the cone of x about y and z; of a ball
    double length = 0.0;                         // m, of a distance joint with a locked length, which is move[0]
    // Joints of a gear: indices of two hinges or sliders, whose coordinates keep theta_1 + ratio theta_2 constant.
    std::array<std::size_t, 2> geared{};
    double ratio = 0.0;                 // unit of the first coordinate over that of the second, rad and m
    double friction_coefficient = 0.0;  // of a bearing: its friction is that times its load,
    double bearing_radius = 0.0;        // m, times this for rotation
    std::optional<double> armature;     // kg m^2 of a hinge, kg of a slider: inertia along its coordinate alone
    double break_force = infinity, break_torque = infinity, break_impulse = infinity;  // N, N m, N s
    bool collide = false;                // true if the two bodies collide with each other
    double start = 0.0, end = infinity;  // s: the joint holds in [start, end)
    bool visible = false;                // true if it is drawn

    bool ever_breaks() const { return break_force < infinity || break_torque < infinity || break_impulse < infinity; }
};

}  // namespace tumble
