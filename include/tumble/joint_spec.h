// Joints of a scene that is built in code. Fields have the names, defaults, units and ranges of
// docs/reference/scene-joints.md; one that is not given has the default. SI units, angles in degrees, their speeds in
// rad/s.
#pragma once

#include "vector.h"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

TUMBLE_BEGIN

// Names of the scene file; six_dof is "6dof".
enum class JointType { fixed, hinge, ball, slider, universal, cylindrical, planar, distance, six_dof, gear };
enum class JointFrame { world, first, second };
enum class Interpolation { smooth, linear };  // between keyframes

struct JointSpring {
    std::optional<double> stiffness;      // N/m, or N m/rad
    std::optional<double> damping;        // N s/m, or N m s/rad
    std::optional<double> frequency;      // Hz, in place of the two above
    std::optional<double> damping_ratio;  // with a frequency; 1 is critical
    std::optional<double> rest;           // m, or degrees
};

struct JointKeyframe {
    double time = 0.0;   // s, later than the keyframe before
    double value = 0.0;  // m, or degrees
};

/// With one of a speed, a target and keyframes.
struct JointMotor {
    std::optional<double> speed;   // m/s, or rad/s
    std::optional<double> target;  // m, or degrees
    std::vector<JointKeyframe> keyframes;
    Interpolation interpolation = Interpolation::smooth;
    std::optional<double> stiffness;   // N/m, or N m/rad
    std::optional<double> damping;     // N s/m, or N m s/rad
    std::optional<double> max_force;   // N, of displacements and distances
    std::optional<double> max_torque;  // N m, of angles
};

/// A coordinate of a joint of type six_dof that is not locked: free, unless it has limits.
struct JointCoordinate {
    std::optional<std::array<double, 2>> limits;  // m, or degrees
    std::optional<double> limit_restitution;
    std::optional<JointSpring> spring;
    std::optional<JointMotor> motor;
    std::optional<double> friction;  // N, or N m
};

struct Joint {
    std::string name;                   // unique; "joint N" with its index where empty
    JointType type = JointType::fixed;  // says which of the other fields may be given
    std::array<std::string, 2> bodies;  // names, or indices as text; "world" for the world

    // Places at the start.
    std::optional<Vec3> anchor;                  // m
    std::optional<std::array<Vec3, 2>> anchors;  // m, in the frames of the bodies, in place of the anchor
    std::optional<Vec3> axis, second_axis;       // their lengths are ignored
    std::optional<std::array<Vec3, 2>> axes;     // in the frames of the bodies, in place of the axis
    JointFrame frame = JointFrame::world;        // of anchor, axis and second_axis
    bool snap = false;                           // accepts a gap at the start
    std::optional<double> start_angle;           // degrees
    std::optional<double> start_position;        // m

    // Coordinates: the displacement or the angle of a joint that has one, and the angle of a cylindrical one
    // (turn_...).
    std::optional<std::array<double, 2>> limits, turn_limits, second_limits;  // m, or degrees
    std::optional<std::array<double, 2>> swing;                               // degrees, half angles about y and z
    std::optional<std::array<double, 2>> twist;                               // degrees
    std::optional<double> limit_restitution;
    std::optional<JointSpring> spring, turn_spring;
    std::optional<JointMotor> motor, turn_motor;
    std::optional<double> friction, turn_friction;         // N, or N m
    std::optional<double> friction_coefficient;            // of a bearing
    std::optional<double> bearing_radius;                  // m
    std::optional<double> armature;                        // kg m^2 of a hinge, kg of a slider
    std::optional<double> length, min_length, max_length;  // m, of a distance joint
    // Coordinates of a joint of type six_dof: displacements along and angles about x, y and z; locked where not given.
    std::array<std::optional<JointCoordinate>, 3> move, turn;

    // Joints of a gear: names of two hinges or sliders, with theta_1 + ratio theta_2 constant.
    std::array<std::string, 2> joints;
    std::optional<double> ratio;  // unit of the first coordinate over that of the second, rad and m

    std::optional<double> break_force, break_torque, break_impulse;     // N, N m, N s
    std::optional<bool> collide;                                        // of its two bodies with each other
    double start = 0.0, end = std::numeric_limits<double>::infinity();  // s: it holds in this span (`enabled`)
    bool visible = false;                                               // it is drawn
};

TUMBLE_END
