// One coordinate of a joint: its limits, spring, motor and friction.
#pragma once

#include "scene/description/joint.h"
#include "scene/toml/toml_reader.h"

#include <array>

namespace tumble {

/// How a file gives a coordinate: angles in degrees, with speeds in rad/s and torques; displacements in SI units.
struct CoordinateUnit {
    double in_si;         // one unit of the file
    const char* name;     // for messages
    Range value;          // of limits and targets, in the unit of the file
    Range speed;          // of motors, SI
    Range friction;       // SI
    Range strength;       // of motors, SI
    const char* max_key;  // of motors
    const char* other_max_key;
};

extern const CoordinateUnit length_unit, angle_unit;

/// Keys of one coordinate in a joint's table; null: the joint has no such key.
struct CoordinateKeys {
    const char* limits = nullptr;
    const char* spring = nullptr;
    const char* motor = nullptr;
    const char* friction = nullptr;
};

/// The coordinate at the start, in SI units. A start outside of the limits is an error unless it is accepted.
struct CoordinateStart {
    double value = 0.0;
    bool accepted = false;
    const char* remedy = "give other limits, or snap = true";
};

/// `[lower, upper]`, in SI units.
std::array<double, 2> read_limits(const TomlValue& value, const CoordinateUnit& unit, const Range& range);

/// Fails at the limits if the start is outside of them.
void check_start(const TomlValue& limits, const std::array<double, 2>& range, const CoordinateUnit& unit,
                 const CoordinateStart& start);

/// `{ stiffness, damping, rest }` or `{ frequency, damping_ratio, rest }`; `rest`: default, in SI units.
JointSpring read_spring(const TomlValue& value, const CoordinateUnit& unit, double rest);

/// `{ speed | target | keyframes, interpolation, stiffness, damping, max_torque | max_force }`.
JointMotor read_motor(const TomlValue& value, const CoordinateUnit& unit);

/// Reads the keys of a coordinate that is free, unless its limits are given.
void read_coordinate(const TomlTable& table, const CoordinateKeys& keys, const CoordinateUnit& unit,
                     const CoordinateStart& start, JointAxis& axis);

/// Reads a coordinate of a joint of six: "free", "locked", [lower, upper], or a table.
void read_free_form_coordinate(const TomlValue& value, const CoordinateUnit& unit, const CoordinateStart& start,
                               JointAxis& axis);

}  // namespace tumble
