#include "scene/keys/joint_coordinates.h"

#include "core/deterministic_math.h"
#include "scene/fields/joint_fields.h"
#include "scene/keys/read_fields.h"

#include "scene/toml/limits.h"

#include <fmt/format.h>

namespace tumble {

const CoordinateUnit length_unit{
    1.0,         "m",         limits::coordinate, limits::velocity, limits::joint_force, limits::strength_force,
    "max_force", "max_torque"};
const CoordinateUnit angle_unit{pi / 180.0,           "degrees",
                                limits::hinge_angle,  limits::angular_velocity,
                                limits::joint_torque, limits::strength_torque,
                                "max_torque",         "max_force"};

namespace {

std::string text_of(double si, const CoordinateUnit& unit) {
    return fmt::format("{:.6g} {}", si / unit.in_si, unit.name);
}

std::vector<JointTarget> read_targets(const TomlValue& value, const CoordinateUnit& unit) {
    std::vector<JointTarget> targets;
    for (TomlTable& table : value.tables(" { time, value }")) {
        table.set_title("a keyframe of a motor");
        JointTarget target = read_all_fields<JointTarget>(table);
        if (!targets.empty() && target.time <= targets.back().time) {
            table.require("time").fail(
                fmt::format("must come after the keyframe before, at {} s", number_text(targets.back().time)));
        }
        target.value = table.require("value").number(unit.value) * unit.in_si;
        targets.push_back(target);
    }
    if (targets.empty()) value.fail("must hold at least one keyframe");
    return targets;
}

/// Only one of the three ways to drive a coordinate: the key of the one that is given.
const char* way_of_motor(const TomlTable& table, const TomlValue& motor) {
    const char* given = nullptr;
    for (const char* key : {"speed", "target", "keyframes"}) {
        if (!table.has(key)) continue;
        if (given) {
            table.find(key)->origin().fail(fmt::format("and {} exclude each other: give one of them", given));
        }
        given = key;
    }
    if (!given) motor.origin().fail("needs a speed, a target or keyframes (not given)");
    return given;
}

void check_ways_of_spring(const TomlTable& table, const TomlValue& spring) {
    const bool physical = table.has("stiffness") || table.has("damping");
    for (const char* key : {"frequency", "damping_ratio"})
        if (physical && table.has(key)) {
            table.find(key)->origin().fail(
                fmt::format("and {} exclude each other: give stiffness and damping, or frequency and damping_ratio",
                            table.has("stiffness") ? "stiffness" : "damping"));
        }
    if (const auto ratio = table.find("damping_ratio"); ratio && !table.has("frequency"))
        ratio->origin().fail("needs a frequency (not given)");
    if (!physical && !table.has("frequency"))
        spring.origin().fail("needs a stiffness, a damping or a frequency (not given)");
}

}  // namespace

std::array<double, 2> read_limits(const TomlValue& value, const CoordinateUnit& unit, const Range& range) {
    const auto end = value.items(2, "numbers, the lower and the upper limit");
    const double lower = end[0].number(range), upper = end[1].number(range);
    if (lower >= upper) value.fail("must have the lower limit first, and it must be less than the upper one");
    return {lower * unit.in_si, upper * unit.in_si};
}

void check_start(const TomlValue& limits, const std::array<double, 2>& range, const CoordinateUnit& unit,
                 const CoordinateStart& start) {
    const bool inside =
        start.value >= range[0] - limits::start_tolerance && start.value <= range[1] + limits::start_tolerance;
    if (inside || start.accepted) return;
    limits.fail(fmt::format("must contain the start, {}; {}", text_of(start.value, unit), start.remedy));
}

JointSpring read_spring(const TomlValue& value, const CoordinateUnit& unit, double rest) {
    TomlTable table = value.table();
    table.set_title("a spring");
    JointSpring spring = read_all_fields<JointSpring>(table);
    check_ways_of_spring(table, value);
    spring.rest = rest;
    if (const auto given = table.find("rest")) spring.rest = given->number(unit.value) * unit.in_si;
    return spring;
}

JointMotor read_motor(const TomlValue& value, const CoordinateUnit& unit) {
    TomlTable table = value.table();
    table.set_title("a motor");
    JointMotor motor = read_all_fields<JointMotor>(table);
    const std::string_view way = way_of_motor(table, value);
    if (way == "speed") {
        motor.speed = table.require("speed").number(unit.speed);
        for (const char* key : {"stiffness", "damping"})
            if (const auto given = table.find(key)) given->origin().fail("is for a motor with a target or keyframes");
    } else {
        if (way == "target")
            motor.targets = {{0.0, table.require("target").number(unit.value) * unit.in_si}};
        else
            motor.targets = read_targets(table.require("keyframes"), unit);
        table.require("stiffness");
    }
    if (const auto interpolation = table.find("interpolation"); interpolation && way != "keyframes")
        interpolation->origin().fail("is for a motor with keyframes");
    if (const auto other = table.find(unit.other_max_key)) {
        other->origin().fail(fmt::format("is not for a motor of a coordinate in {}: give {}", unit.name, unit.max_key));
    }
    table.read(unit.max_key, motor.max_force, unit.strength);
    return motor;
}

void read_coordinate(const TomlTable& table, const CoordinateKeys& keys, const CoordinateUnit& unit,
                     const CoordinateStart& start, JointAxis& axis) {
    axis.motion = JointAxis::Motion::free;
    const auto find = [&](const char* key) { return key ? table.find(key) : std::nullopt; };
    if (const auto value = find(keys.limits)) {
        const std::array<double, 2> range = read_limits(*value, unit, unit.value);
        check_start(*value, range, unit, start);
        axis.motion = JointAxis::Motion::limited;
        axis.lower = range[0];
        axis.upper = range[1];
    }
    if (const auto value = find(keys.spring)) axis.spring = read_spring(*value, unit, 0.0);
    if (const auto value = find(keys.motor)) axis.motor = read_motor(*value, unit);
    if (const auto value = find(keys.friction)) axis.friction = value->number(unit.friction);
}

void read_free_form_coordinate(const TomlValue& value, const CoordinateUnit& unit, const CoordinateStart& start,
                               JointAxis& axis) {
    using Motion = JointAxis::Motion;
    constexpr Choice<Motion> motions[] = {{"free", Motion::free}, {"locked", Motion::locked}};
    if (value.is_text()) {
        axis.motion = value.choice<Motion>(motions);
    } else if (value.is_array()) {
        const std::array<double, 2> range = read_limits(value, unit, unit.value);
        check_start(value, range, unit, start);
        axis.motion = Motion::limited;
        axis.lower = range[0];
        axis.upper = range[1];
    } else if (value.is_table()) {
        TomlTable table = value.table();
        table.set_title("a coordinate");
        table.expect_keys(list_keys<JointAxis>().keys);
        read_fields(table, axis);
        read_coordinate(table, {"limits", "spring", "motor", "friction"}, unit, start, axis);
        if (const auto restitution = table.find("limit_restitution"))
            if (axis.motion != Motion::limited) restitution->origin().fail("needs limits (not given)");
    } else {
        value.fail("must be \"free\", \"locked\", [lower, upper] or a table");
    }
    const bool at_zero = std::abs(start.value) <= limits::axis_tolerance;
    if (axis.motion == Motion::locked && !at_zero && !start.accepted) {
        value.origin().fail(fmt::format("is locked, and at the start it is {} in place of 0; {}",
                                        text_of(start.value, unit),
                                        "give one anchor and one axis for both bodies, or snap = true"));
    }
}

}  // namespace tumble
