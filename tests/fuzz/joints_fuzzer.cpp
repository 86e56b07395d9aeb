// A scene with joints: it is simulated for a few steps, or refused by an InputError; a motion that fails is a RunError.
// Scenes that take long are passed over: many bodies, many steps in a frame, meshes of many triangles.
#include "core/check.h"
#include "core/error.h"
#include "scene/load.h"
#include "sim/world.h"

#include <cstdint>
#include <string>
#include <variant>

namespace {

using namespace tumble;

constexpr std::size_t most_bodies = 24, most_joints = 32;
constexpr int steps = 6;

bool is_small(const SceneDescription& scene) {
    return !scene.joints.empty() && scene.bodies.size() <= most_bodies && scene.joints.size() <= most_joints;
}

void simulate(const SceneDescription& scene) {
    World world(scene, 1);
    world.record_contacts();
    world.joint_report();
    for (int n = 0; n < steps; ++n) world.step();
    world.measure();
    world.joint_states();
    world.snapshot();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const SceneDescription scene =
            parse_scene(std::string(reinterpret_cast<const char*>(data), size), "/nowhere/scene.toml");
        if (is_small(scene)) simulate(scene);
    } catch (const InputError&) {  // scene_fuzzer.cpp looks at these
    } catch (const RunError& error) {
        TUMBLE_CHECK_EQ(std::string(error.what()).empty(), false);
    }
    return 0;
}
