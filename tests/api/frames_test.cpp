// Frames of a clip: their moments are states of the plain simulation.
#include "scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace tumble {
namespace {

TEST(Frames, AreThoseOfTheWorldAtNormalSpeed) {
    const Scene scene(crate_and_ball());
    FrameSequence frames(scene);
    EXPECT_EQ(frames.frame_count(), scene.frame_count());
    World world(scene);
    for (int n = 0; n < 5; ++n) {
        if (n > 0) world.advance_frame();
        const std::vector<Snapshot> moments = frames.next();
        ASSERT_EQ(moments.size(), 1u);
        EXPECT_TRUE(same(moments[0], world.snapshot())) << n;
    }
}

// At a quarter of the speed, with four moments in a whole frame, each moment is the middle of one of 16 steps of a
// normal frame.
TEST(Frames, OfSlowMotionAndBlurAreInTheMiddleOfStepsOfTheNormalRun) {
    const Scene scene(crate_and_ball());
    FrameSequence frames(scene, {0.25, 360.0, 4}, 2);
    EXPECT_EQ(frames.frame_count(), 4 * (scene.frame_count() - 1) + 1);
    World world(scene);
    for (int n = 0; n < 12; ++n) {
        const std::vector<Snapshot> moments = frames.next();
        ASSERT_EQ(moments.size(), 4u);
        for (const Snapshot& moment : moments) {
            const Snapshot before = world.snapshot();
            world.advance_step();
            const Snapshot after = world.snapshot();
            EXPECT_EQ(moment.frame, n);
            EXPECT_NEAR(moment.time, 0.5 * (before.time + after.time), 1e-12);
            const Vec3 a = before.bodies[1].origin, b = after.bodies[1].origin, middle = moment.bodies[1].origin;
            EXPECT_NEAR(middle.x, 0.5 * (a.x + b.x), 1e-12);
            EXPECT_NEAR(middle.y, 0.5 * (a.y + b.y), 1e-12);
        }
    }
}

TEST(Frames, AShutterOfHalfAFrameLeavesOutTheOtherHalf) {
    const Scene scene(crate_and_ball());
    FrameSequence frames(scene, {1.0, 180.0, 2});
    const double frame = 1.0 / scene.output().fps;
    for (int n = 0; n < 3; ++n) {
        const std::vector<Snapshot> moments = frames.next();
        ASSERT_EQ(moments.size(), 2u);
        EXPECT_NEAR(moments[0].time, (n + 0.125) * frame, 1e-12);
        EXPECT_NEAR(moments[1].time, (n + 0.375) * frame, 1e-12);
    }
}

TEST(Frames, ABlurredImageIsTheMeanInLinearLight) {
    SceneSpec spec = crate_and_ball();
    spec.light.shadows = false;
    const Scene scene(spec);
    const std::vector<Snapshot> moments = FrameSequence(scene, {1.0, 360.0, 2}).next();
    Renderer renderer(scene);
    const Image blurred = renderer.render_blurred(moments);
    const Image first = renderer.render(moments[0]), second = renderer.render(moments[1]);
    int between = 0;
    for (std::size_t i = 0; i < blurred.pixels.size(); ++i) {
        const int a = first.pixels[i], b = second.pixels[i], mean = blurred.pixels[i];
        ASSERT_TRUE(mean >= std::min(a, b) && mean <= std::max(a, b)) << i;
        if (a == b) continue;
        ++between;
        EXPECT_GE(2 * mean, a + b - 1) << i;  // the mean of light is at least as bright as that of sRGB values
    }
    EXPECT_GT(between, 0);
    EXPECT_EQ(renderer.render_blurred({moments[0], moments[0]}), first);
    EXPECT_THROW(renderer.render_blurred({}), Error);
}

}  // namespace
}  // namespace tumble
