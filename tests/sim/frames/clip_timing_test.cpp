// Slow motion and speed-up compared with a run at normal speed.
#include "sim/frames/clip_timing.h"

#include "core/error.h"
#include "sim/world.h"

#include <gtest/gtest.h>

namespace tumble::clip_timing_test {
namespace {

SceneDescription falling_box() {
    SceneDescription scene;
    scene.output.fps = 60.0;
    scene.simulation.duration = 1.0;
    scene.simulation.steps_per_frame = 4;
    BodyDescription ground, box;
    ground.shape = PlaneShape{};
    ground.type = BodyType::fixed;
    box.shape = BoxShape{{1.0, 1.0, 1.0}};
    box.position = {0.0, 1.5, 0.0};
    box.angular_velocity = {1.0, 2.0, 0.5};
    scene.bodies = {ground, box};
    return scene;
}

std::vector<Snapshot> frames_of(const SceneDescription& scene, const FrameTiming& timing) {
    World world(scene, timing, 1);
    std::vector<Snapshot> frames{world.snapshot()};
    while (std::int64_t(frames.size()) < timing.frame_count(scene.simulation.duration)) {
        world.advance_frame();
        frames.push_back(world.snapshot());
    }
    return frames;
}

TEST(TimeScaling, KeepsTheStepIfPossible) {
    const SceneDescription scene = falling_box();
    const std::vector<Snapshot> normal = frames_of(scene, scene.timing());
    for (const auto& [speed, steps] : {std::pair{0.25, 1}, {0.5, 2}, {2.0, 8}, {3.0, 12}}) {
        const FrameTiming timing = timing_at_speed(scene, speed);
        EXPECT_EQ(timing.step(), scene.step());
        EXPECT_EQ(timing.steps_per_frame, steps);
        const std::vector<Snapshot> frames = frames_of(scene, timing);
        EXPECT_EQ(std::int64_t(frames.size()), std::int64_t(60.0 / speed) + 1);
        // Frame n shows the time n * speed of the normal run's frames, to the last bit if that is one of its frames.
        for (std::size_t n = 0; n < frames.size(); ++n) {
            const double at = double(n) * speed;
            if (at != double(std::size_t(at))) continue;
            const BodyState &a = frames[n].bodies[1], &b = normal[std::size_t(at)].bodies[1];
            ASSERT_EQ(a.origin, b.origin) << speed << ", frame " << n;
            ASSERT_EQ(a.orientation.coeffs(), b.orientation.coeffs()) << speed << ", frame " << n;
            ASSERT_EQ(frames[n].time, normal[std::size_t(at)].time);
        }
    }
}

TEST(TimeScaling, NeverMakesTheStepLonger) {
    for (double speed = slowest_speed; speed <= fastest_speed; speed *= 1.37) {
        const SceneDescription scene = falling_box();
        const FrameTiming timing = timing_at_speed(scene, speed);
        EXPECT_LE(timing.step(), scene.step() * (1.0 + 1e-9)) << speed;
        EXPECT_DOUBLE_EQ(timing.step() * timing.steps_per_frame, speed / scene.output.fps) << speed;
    }
}

TEST(Shutter, OpensForTheNearestPartOfAFrame) {
    const auto of = [](double degrees, int blur_samples) {
        const Shutter shutter = Shutter::of(degrees, blur_samples);
        return std::pair{shutter.intervals, shutter.blur_samples};
    };
    EXPECT_EQ(of(0.0, 8), (std::pair{1, 1}));
    EXPECT_EQ(of(180.0, 8), (std::pair{16, 8}));
    EXPECT_EQ(of(360.0, 8), (std::pair{8, 8}));
    EXPECT_EQ(of(90.0, 4), (std::pair{16, 4}));
    EXPECT_EQ(of(270.0, 8), (std::pair{11, 8}));  // 262 degrees
}

TEST(Shutter, PartsKeepTheStepWhereTheyCan) {
    const SceneDescription scene = falling_box();
    const FrameTiming timing = divided(scene.timing(), 4);
    EXPECT_EQ(timing.step(), scene.step());
    EXPECT_EQ(timing.fps, 240.0);
    const std::vector<Snapshot> normal = frames_of(scene, scene.timing()), parts = frames_of(scene, timing);
    ASSERT_EQ(parts.size(), 4 * (normal.size() - 1) + 1);
    for (std::size_t n = 0; n < normal.size(); ++n)
        EXPECT_EQ(parts[4 * n].bodies[1].origin, normal[n].bodies[1].origin);
}

TEST(TimeScaling, TooManyFramesAreRefused) {
    SceneDescription scene = falling_box();
    scene.simulation.duration = 1e6;
    EXPECT_THROW(timing_at_speed(scene, 1e-3), InputError);
}

}  // namespace
}  // namespace tumble::clip_timing_test
