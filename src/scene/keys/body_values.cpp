#include "scene/keys/body_values.h"

#include "core/deterministic_math.h"
#include "core/safe_text.h"
#include "scene/fields/body_fields.h"
#include "scene/keys/read_fields.h"
#include "scene/toml/error_text.h"
#include "scene/toml/limits.h"
#include "sim/math/mass_properties.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

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

namespace {

std::array<double, 6> six_numbers(const Mat3& m) { return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)}; }

/// Fails unless matter with positive density can have these moments.
void check_moments(const Vec3& moments, const TomlValue& value) {
    Vec3 sorted = moments;
    std::sort(sorted.data(), sorted.data() + 3);
    const std::string given =
        fmt::format("(given the moments {:.6g}, {:.6g} and {:.6g} kg m^2 about its principal axes)", sorted[0],
                    sorted[1], sorted[2]);
    if (!(sorted[0] > 0.0)) value.origin().fail("must be positive about every axis " + given);
    if (sorted[2] - sorted[0] - sorted[1] > limits::inertia_tolerance * sorted[2])
        value.origin().fail(
            fmt::format("breaks the triangle inequality, and no body has it: the largest moment is at most the sum of "
                        "the other two, here {:.6g} {}",
                        sorted[0] + sorted[1], given));
}

std::array<double, 6> read_inertia(const TomlValue& value) {
    Mat3 tensor;
    if (value.is_table()) {
        TomlTable table = value.table();
        table.set_title("an inertia");
        table.expect_keys({"principal", "rotation"});
        const Vec3 moments = table.require("principal").vector(limits::inertia);
        check_moments(moments, value);
        const auto rotation = table.find("rotation");
        const Mat3 turn = rotation ? read_rotation(*rotation).toRotationMatrix() : Mat3(Mat3::Identity());
        tensor = turn * moments.asDiagonal() * turn.transpose();
    } else {
        const auto item = value.items(6, "numbers xx, yy, zz, xy, xz, yz (or a table with principal and rotation)");
        for (int k = 0; k < 3; ++k) tensor(k, k) = item[std::size_t(k)].number(limits::inertia);
        const double xy = item[3].number(limits::inertia_product), xz = item[4].number(limits::inertia_product),
                     yz = item[5].number(limits::inertia_product);
        tensor(0, 1) = tensor(1, 0) = xy;
        tensor(0, 2) = tensor(2, 0) = xz;
        tensor(1, 2) = tensor(2, 1) = yz;
        check_moments(principal_inertia(tensor).moments, value);
    }
    return six_numbers(tensor);
}

std::vector<std::string> read_names(const TomlValue& value) {
    std::vector<std::string> names;
    for (const TomlValue& item : value.items()) {
        names.push_back(item.text());
        if (names.back().empty()) item.fail("must not be empty");
    }
    return names;
}

void check_uses(const TomlTable& table, const std::set<std::string>& layers) {
    const auto bodies = table.find("body");
    if (!bodies) return;
    for (const TomlTable& body : bodies->tables()) {
        const auto given = body.find("collide_with");
        if (!given) continue;
        for (const TomlValue& item : given->items()) {
            const std::string name = item.text();
            if (layers.contains(name)) continue;
            const std::vector<std::string_view> known(layers.begin(), layers.end());
            item.origin().fail(fmt::format("\"{}\" is the layer of no body{}", safe_text(name),
                                           known.empty() ? ": give a body layers = [...]" : suggestion(name, known)));
        }
    }
}

}  // namespace

void read_matter(const TomlTable& table, BodyDescription& body) {
    for (const char* key : {"inertia", "center_of_mass"})
        if (const auto value = table.find(key); value && !body.dynamic())
            value->origin().fail("is for dynamic bodies: others move by no force");
    if (const auto value = table.find("inertia")) body.inertia = read_inertia(*value);
    if (const auto value = table.find("layers")) body.layers = read_names(*value);
    if (const auto value = table.find("collide_with")) body.collide_with = read_names(*value);
}

void check_layers(const TomlTable& root, const SceneDescription& scene) {
    std::set<std::string> layers;
    bool used = false;
    for (const BodyDescription& body : scene.bodies) {
        layers.insert(body.layers.begin(), body.layers.end());
        used = used || body.collide_with;
    }
    if (layers.size() > std::size_t(limits::layers))
        root.origin().fail(
            fmt::format("has too many layers: the limit is {} (given {})", limits::layers, layers.size()));
    if (!used) return;
    check_uses(root, layers);
    if (const auto templates = root.find("template"))
        for (const auto& [name, content] : templates->table().entries()) check_uses(content.table(), layers);
}

}  // namespace tumble
