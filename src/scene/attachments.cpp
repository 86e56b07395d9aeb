#include "scene/attachments.h"

#include "scene/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>

namespace tumble {
namespace {

constexpr Choice<bool> force_frames[] = {{"world", false}, {"body", true}};

/// Bodies by name. A body without a name has its index for one; a given name of that text comes first.
class BodyIndex {
public:
    explicit BodyIndex(const std::vector<BodyDescription>& bodies) {
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            const bool is_own_index = bodies[i].name == std::to_string(i);
            if (!is_own_index) index_[bodies[i].name] = i;
            else index_.try_emplace(bodies[i].name, i);
        }
    }

    std::size_t find(const TomlValue& value) const {
        const std::string name = value.text();
        if (const auto found = index_.find(name); found != index_.end()) return found->second;
        if (index_.count(name + ".0")) {
            value.origin().fail(
                fmt::format("\"{0}\" is many bodies: name one of its copies, \"{0}.0\" for the first", name));
        }
        std::vector<std::string_view> known;
        for (const auto& [other, i] : index_) known.push_back(other);
        value.origin().fail(fmt::format("\"{}\" is not the name of a body{}", name, suggestion(name, known)));
    }

private:
    std::map<std::string, std::size_t> index_;
};

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
            table.find(table.has("end") ? "end" : "start")->fail(
                fmt::format("makes the force end before it starts, at {} s", number_text(force.start)));
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
