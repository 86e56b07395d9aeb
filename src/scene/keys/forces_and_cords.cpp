#include "scene/keys/forces_and_cords.h"

#include "core/safe_text.h"
#include "scene/fields/body_fields.h"
#include "scene/keys/body_index.h"
#include "scene/keys/joint_pins.h"
#include "scene/keys/joints.h"
#include "scene/keys/read_fields.h"

#include <fmt/format.h>

namespace tumble {
namespace {

void read_place_of_cord(const TomlTable& table, const BodyIndex& bodies, CordDescription& cord) {
    cord.body = bodies.find(table.require("body"));
    table.require("anchor");
}

/// From the anchor of the one side to that of the other; the first end is a body.
void place_between_anchors(const JointDescription& joint, const std::vector<JointDescription>& joints,
                           CordDescription& cord) {
    cord.joint = std::size_t(&joint - joints.data());
    const bool from_second = joint.second.has_value();
    cord.body = from_second ? *joint.second : *joint.first;
    cord.point = from_second ? joint.anchor_second : joint.anchor_first;
    cord.anchor_body = from_second ? joint.first : joint.second;
    cord.anchor = from_second ? joint.anchor_first : joint.anchor_second;
}

void read_place_from_joint(const TomlTable& table, const TomlValue& value, const std::vector<JointDescription>& joints,
                           CordDescription& cord) {
    for (const char* key : {"body", "point", "anchor"})
        if (const auto given = table.find(key))
            given->origin().fail("and joint exclude each other: the joint gives the place");
    const JointDescription& joint = find_joint(value, joints);
    if (joint.type == JointType::gear) value.fail("is a gear, which has no anchors: give one of its joints");
    place_between_anchors(joint, joints, cord);
}

}  // namespace

void read_forces(const TomlTable& root, SceneDescription& scene) {
    const auto list = root.find("force");
    if (!list) return;
    const BodyIndex bodies(scene.bodies);
    for (TomlTable& table : list->tables("; write [[force]] for each")) {
        table.set_title("[[force]]");
        ForceDescription initial;
        initial.end = infinity;
        ForceDescription force = read_all_fields(table, initial);
        const TomlValue body = table.require("body");
        force.body = bodies.find(body);
        if (scene.bodies[force.body].type != BodyType::dynamic) {
            body.fail("must be a dynamic body: no force moves another");
        }
        if (force.end <= force.start) {
            table.find(table.has("end") ? "end" : "start")
                ->fail(fmt::format("makes the force end before it starts, at {} s", number_text(force.start)));
        }
        scene.forces.push_back(force);
    }
}

void add_cords_of_joints(SceneDescription& scene) {
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
        const JointDescription& joint = scene.joints[i];
        if (!joint.visible) continue;
        if (joint.type != JointType::distance) {
            const std::vector<CordDescription> pins = pins_of(scene, i);
            scene.cords.insert(scene.cords.end(), pins.begin(), pins.end());
            continue;
        }
        CordDescription cord;
        place_between_anchors(joint, scene.joints, cord);
        scene.cords.push_back(cord);
    }
}

void read_cords(const TomlTable& root, SceneDescription& scene) {
    const auto list = root.find("cord");
    if (!list) return;
    const BodyIndex bodies(scene.bodies);
    for (TomlTable& table : list->tables("; write [[cord]] for each")) {
        table.set_title("[[cord]]");
        CordDescription cord = read_all_fields<CordDescription>(table);
        if (const auto joint = table.find("joint"))
            read_place_from_joint(table, *joint, scene.joints, cord);
        else
            read_place_of_cord(table, bodies, cord);
        scene.cords.push_back(cord);
    }
}

}  // namespace tumble
