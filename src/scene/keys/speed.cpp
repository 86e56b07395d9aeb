#include "scene/keys/readers.h"

#include "scene/fields/settings_fields.h"
#include "scene/keys/body_index.h"
#include "scene/keys/read_fields.h"

#include <fmt/format.h>

#include <string>

namespace tumble {
namespace {

constexpr std::string_view impact_prefix = "impact:";

/// The bodies of "impact:A,B". Names may have commas: the first one that separates two names of bodies counts.
std::array<std::size_t, 2> read_impact(const TomlValue& time, const SceneDescription& scene, const BodyIndex& bodies) {
    const std::string text = time.text();
    const std::size_t first = text.find(',');
    if (!text.starts_with(impact_prefix) || first == std::string::npos)
        time.fail("must be a number of seconds, or \"impact:A,B\" for the first impact of the bodies A and B");
    std::size_t comma = first;
    const auto name_before = [&] { return text.substr(impact_prefix.size(), comma - impact_prefix.size()); };
    const auto name_behind = [&] { return text.substr(comma + 1); };
    for (std::size_t at = first; at != std::string::npos; at = text.find(',', at + 1)) {
        comma = at;
        if (bodies.has(name_before()) && bodies.has(name_behind())) break;
        comma = first;
    }
    const std::array<std::size_t, 2> pair{bodies.find(time, name_before()), bodies.find(time, name_behind())};
    if (pair[0] == pair[1]) time.fail("must name two different bodies");
    for (const std::size_t body : pair)
        if (scene.bodies[body].type == BodyType::dynamic) return pair;
    time.fail("must name a dynamic body: other ones have no impacts with each other");
}

}  // namespace

void read_speed(const TomlTable& root, SceneDescription& scene) {
    const auto list = root.find("speed");
    if (!list) return;
    const BodyIndex bodies(scene.bodies);
    for (TomlTable& table : list->tables("; write [[speed]] for each")) {
        table.set_title("[[speed]]");
        SpeedKeyframe key = read_all_fields<SpeedKeyframe>(table);
        const TomlValue time = table.require("time");
        const auto after = table.find("after");
        if (time.is_text()) {
            key.impact = read_impact(time, scene, bodies);
            if (after) key.time = after->number({-limits::time.max, limits::time.max, limits::time.unit});
        } else {
            key.time = time.number(limits::time);
            if (after) after->origin().fail("is for a time of an impact: give the time itself");
        }
        if (!key.impact && !scene.speed.empty() && !scene.speed.back().impact && key.time <= scene.speed.back().time)
            time.fail(
                fmt::format("must come after the keyframe before, at {} s", number_text(scene.speed.back().time)));
        scene.speed.push_back(key);
    }
}

}  // namespace tumble
