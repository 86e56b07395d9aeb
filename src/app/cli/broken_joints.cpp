#include "app/cli/broken_joints.h"

#include "app/cli/say.h"
#include "core/safe_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace tumble {
namespace {

constexpr std::size_t most_lines = 12;  // the others are counted

}  // namespace

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
    for (std::size_t i = 0; i < std::min(joints.size(), most_lines); ++i)
        say("joint '{}' broke at {:.4g} s\n", safe_text(joints[i].name), joints[i].time);
    if (joints.size() > most_lines) say("{} more joints broke\n", joints.size() - most_lines);
}

}  // namespace tumble
