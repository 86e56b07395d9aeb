#include "app/cli/run_notes.h"

#include "app/cli/say.h"
#include "core/safe_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace tumble {
namespace {

constexpr double named_share = 0.01;  // of the smaller body's thickness: more than hand-written numbers round
constexpr std::size_t most_overlaps = 6, most_broken = 12;  // lines; the others are counted

}  // namespace

std::string overlap_warning(const SceneDescription& scene, const World& world) {
    std::vector<Overlap> overlaps = world.overlaps();
    std::erase_if(overlaps, [](const Overlap& overlap) { return overlap.share <= named_share; });
    if (overlaps.empty()) return "";
    std::string lines;
    for (std::size_t i = 0; i < std::min(overlaps.size(), most_overlaps); ++i) {
        const Overlap& o = overlaps[i];
        lines += fmt::format(
            "warning: bodies '{}' and '{}' overlap by {:.3g} m at the start, {:.3g} % of the smaller one's thickness\n",
            safe_text(scene.bodies[o.a].name), safe_text(scene.bodies[o.b].name), o.depth, 100.0 * o.share);
    }
    if (overlaps.size() > most_overlaps)
        lines +=
            fmt::format("warning: {} more pairs of bodies overlap at the start\n", overlaps.size() - most_overlaps);
    return lines + "         contact pushes them apart, which gives them energy: move them, or join them\n";
}

std::vector<BrokenJoint> broken_joints(const SceneDescription& scene, const World& world) {
    std::vector<BrokenJoint> broken;
    if (scene.joints.empty()) return broken;
    const std::vector<JointState> states = world.joint_states();
    for (std::size_t k = 0; k < states.size(); ++k)
        if (states[k].broken_at) broken.push_back({*states[k].broken_at, scene.joints[k].name});
    std::stable_sort(broken.begin(), broken.end(), [](const auto& l, const auto& r) { return l.time < r.time; });
    return broken;
}

void say_broken(const std::vector<BrokenJoint>& joints) {
    if (messages().json()) {
        for (const BrokenJoint& joint : joints)
            messages().event("broke", {{"joint", safe_text(joint.name)}, {"time", joint.time}});
        return;
    }
    for (std::size_t i = 0; i < std::min(joints.size(), most_broken); ++i)
        say("joint '{}' broke at {:.4g} s\n", safe_text(joints[i].name), joints[i].time);
    if (joints.size() > most_broken) say("{} more joints broke\n", joints.size() - most_broken);
}

}  // namespace tumble
