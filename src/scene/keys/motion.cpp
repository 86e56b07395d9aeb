#include "scene/keys/motion.h"

#include "core/deterministic_math.h"
#include "scene/fields/body_fields.h"
#include "scene/keys/read_fields.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <cmath>

namespace tumble {
namespace {

Quat rotation_about_axis(const TomlTable& table) {
    table.expect_keys({"axis", "angle"});
    const Vec3 axis = table.require("axis").direction();
    const double angle = table.require("angle").number(limits::angle);
    // Whole turns are removed first, in degrees, where they are exact: 360 degrees are no rotation at all.
    const SinCos half = sincos(0.5 * std::remainder(angle, 360.0) * pi / 180.0);
    const Vec3 v = half.sin * axis;
    return Quat(half.cos, v.x(), v.y(), v.z()).normalized();
}

Quat rotation_from_numbers(const TomlValue& value) {
    constexpr Range component{-1e6, 1e6, ""};  // far above a unit quaternion, with a finite square
    const auto item = value.items(4, "numbers w, x, y, z (or a table with axis and angle)");
    const Quat q(item[0].number(component), item[1].number(component), item[2].number(component),
                 item[3].number(component));
    const double norm = q.norm();
    if (std::fabs(norm - 1.0) > limits::quaternion_tolerance) {
        value.origin().fail(fmt::format("must be a quaternion of length 1 (given one of length {:.6g})", norm));
    }
    return q.normalized();
}

void check_velocities(const TomlTable& table, const BodyDescription& body) {
    if (body.type == BodyType::dynamic) return;
    for (const char* key : {"velocity", "angular_velocity"}) {
        const auto value = table.find(key);
        if (!value || value->vector(limits::velocity) == Vec3(Vec3::Zero())) continue;
        value->fail(body.type == BodyType::fixed ? "must be zero for a fixed body"
                                                 : "must be zero for a kinematic body: give it keyframes");
    }
}

std::vector<Keyframe> read_keyframes(const TomlValue& value, const BodyDescription& body) {
    std::vector<Keyframe> keyframes;
    for (TomlTable& table : value.tables(" { time, position, rotation }")) {
        table.set_title("a keyframe");
        const Keyframe key = read_all_fields(table, Keyframe{0.0, body.position, body.rotation});
        if (!keyframes.empty() && key.time <= keyframes.back().time) {
            table.require("time").fail(
                fmt::format("must come after the keyframe before, at {} s", number_text(keyframes.back().time)));
        }
        keyframes.push_back(key);
    }
    if (keyframes.empty()) value.fail("must hold at least one keyframe");
    return keyframes;
}

}  // namespace

Quat read_rotation(const TomlValue& value) {
    if (!value.is_table()) return rotation_from_numbers(value);
    TomlTable table = value.table();
    table.set_title("a rotation");
    return rotation_about_axis(table);
}

void check_motion(const TomlTable& table, BodyDescription& body) {
    check_velocities(table, body);
    if (body.type != BodyType::kinematic) {
        for (const char* key : {"keyframes", "interpolation"}) {
            if (const auto value = table.find(key)) value->origin().fail("is for bodies of type \"kinematic\"");
        }
        return;
    }
    if (const auto keyframes = table.find("keyframes")) {
        body.keyframes = read_keyframes(*keyframes, body);
        body.position = body.keyframes.front().position;
        body.rotation = body.keyframes.front().rotation;
    }
}

}  // namespace tumble
