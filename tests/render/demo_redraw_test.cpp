// Partial and full redraw of the demo scenes give the same bytes.
#include "render/render_switches.h"
#include "render/scene/pose_filter.h"
#include "scene/load.h"
#include "sim/world.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace tumble::demo_redraw_test {
namespace {

class DemoRedraw : public testing::TestWithParam<const char*> {};

TEST_P(DemoRedraw, HasTheBytesOfAFullRedraw) {
    SceneOverrides small;
    small.width = 160;
    small.height = 90;
    const SceneDescription scene = load_scene(
        std::filesystem::path(TUMBLE_SOURCE_DIR) / "assets" / "scenes" / (std::string(GetParam()) + ".toml"), small);
    const bool large = scene.bodies.size() > 500;
    World world(scene);
    PoseFilter poses(scene);
    RenderSwitches everything;
    everything.full_redraw = true;
    Renderer partial(scene), full(scene, everything);
    for (int i = 0; i < (large ? 12 : 36); ++i) {
        for (int skipped = 0; i > 0 && skipped < (large ? 1 : 3); ++skipped) world.advance_frame();
        Snapshot snapshot = world.snapshot();
        poses.follow(snapshot);
        ASSERT_EQ(partial.render(snapshot), full.render(snapshot)) << "frame " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DemoRedraw,
                         testing::Values("bouncing_balls", "chain_mail", "dominoes", "double_pendulums", "engine",
                                         "dice", "falling_boxes", "furniture", "hanging_cradle", "marbles",
                                         "mixed_heap", "newtons_cradle", "paddle", "ragdoll", "rope_bridge",
                                         "tennis_racket", "thousand_boxes", "tower_hit", "turntable", "wrecking_ball"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
}  // namespace tumble::demo_redraw_test
