#include "scene/keys/forces_and_cords.h"

#include "scene/keys/body_index.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <limits>

namespace tumble {
namespace {

constexpr Choice<bool> force_frames[] = {{"world", false}, {"body", true}};

}  // namespace

void read_forces(const TomlTable& root, SceneDescription& scene) {
    const auto list = root.find("force");
    if (!list) return;
    const BodyIndex bodies(scene.bodies);
    for (TomlTable& table : list->tables("; write [[force]] for each")) {
        table.set_title("[[force]]");
        table.expect_keys({"body", "point", "force", "frame", "start", "end"});
        ForceDescription force;
        force.end = std::numeric_limits<double>::infinity();
        const TomlValue body = table.require("body");
        force.body = bodies.find(body);
        if (scene.bodies[force.body].type != BodyType::dynamic) {
            body.fail("must be a dynamic body: no force moves another");
        }
        table.read("point", force.point, limits::coordinate);
        force.force = table.require("force").vector(limits::force);
        table.read<bool>("frame", force.body_frame, force_frames);
        table.read("start", force.start, limits::time);
        table.read("end", force.end, limits::time);
        if (force.end <= force.start) {
            table.find(table.has("end") ? "end" : "start")
                ->fail(fmt::format("makes the force end before it starts, at {} s", number_text(force.start)));
        }
        scene.forces.push_back(force);
    }
}

void read_cords(const TomlTable& root, SceneDescription& scene) {
    const auto list = root.find("cord");
    if (!list) return;
    const BodyIndex bodies(scene.bodies);
    for (TomlTable& table : list->tables("; write [[cord]] for each")) {
        table.set_title("[[cord]]");
        table.expect_keys({"body", "point", "anchor", "radius", "color"});
        CordDescription cord;
        cord.body = bodies.find(table.require("body"));
        table.read("point", cord.point, limits::coordinate);
        cord.anchor = table.require("anchor").vector(limits::coordinate);
        table.read("radius", cord.radius, limits::size);
        table.read("color", cord.color);
        scene.cords.push_back(cord);
    }
}

}  // namespace tumble
