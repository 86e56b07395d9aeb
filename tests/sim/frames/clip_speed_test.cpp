// Clips whose speed changes: frames lie on steps of one simulation, holds repeat a frame, impacts give times.
#include "sim/frames/clip_speed.h"

#include "core/error.h"
#include "sim/frames/frame_sequence.h"
#include "sim/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tumble::clip_speed_test {
namespace {

/// A ball of radius 0.5 m that falls from 5 m: it meets the ground after sqrt(2 * 4.5 / g) = 0.9578 s.
SceneDescription falling_ball() {
    SceneDescription scene;
    scene.output.fps = 60.0;
    scene.simulation.duration = 2.0;
    scene.simulation.steps_per_frame = 8;
    BodyDescription ground, ball;
    ground.shape = PlaneShape{};
    ground.type = BodyType::fixed;
    ground.name = "ground";
    ball.shape = SphereShape{0.5};
    ball.name = "ball";
    ball.position = {0.0, 5.0, 0.0};
    scene.bodies = {ground, ball};
    return scene;
}

SpeedKeyframe at(double time, double factor, SpeedEasing easing = SpeedEasing::step, double hold = 0.0) {
    SpeedKeyframe key;
    key.time = time;
    key.factor = factor;
    key.easing = easing;
    key.hold = hold;
    return key;
}

struct Clip {
    FrameTiming timing;
    std::vector<int> steps;
    std::vector<double> times;
};

Clip clip_of(const SceneDescription& scene, double speed = 1.0, const Shutter& shutter = {}) {
    Clip clip;
    clip.timing = timing_at_speeds(scene, speed, shutter);
    clip.steps = steps_of_frames(scene, clip_speed(scene, clip.timing).keys, speed, clip.timing, shutter);
    std::int64_t steps = 0;
    for (const int one : clip.steps) {
        clip.times.push_back(double(steps) * shutter.intervals * clip.timing.step());
        steps += one;
    }
    return clip;
}

TEST(ClipSpeed, IsThatOfAPlainClipWithoutAChange) {
    SceneDescription scene = falling_ball();
    scene.speed = {at(0.5, 1.0)};
    for (const double speed : {1.0, 0.5, 0.1, 3.0}) {
        const Clip clip = clip_of(scene, speed);
        EXPECT_EQ(std::int64_t(clip.steps.size()), timing_at_speed(scene, speed).frame_count(2.0)) << speed;
        for (std::size_t n = 0; n < clip.times.size(); ++n) EXPECT_NEAR(clip.times[n], double(n) * speed / 60.0, 1e-12);
    }
}

TEST(ClipSpeed, SlowMotionHasTheFramesThatItsLengthNeeds) {
    SceneDescription scene = falling_ball();
    scene.speed = {at(0.5, 0.1), at(1.0, 1.0)};
    const Clip clip = clip_of(scene);
    // 0.5 s, 0.5 s at a tenth of the speed, 1 s: 6.5 s.
    EXPECT_NEAR(double(clip.steps.size()), 6.5 * 60.0 + 1.0, 2.0);
    const auto slow = std::ranges::count_if(clip.times, [](double t) { return t > 0.5 && t < 1.0; });
    EXPECT_NEAR(double(slow), 300.0, 1.0);
}

TEST(ClipSpeed, EasesBetweenKeyframes) {
    SceneDescription scene = falling_ball();
    for (const SpeedEasing easing : {SpeedEasing::linear, SpeedEasing::smooth}) {
        scene.speed = {at(0.5, 1.0, easing), at(1.0, 0.25)};
        const Clip clip = clip_of(scene);
        // Its time in the clip is the integral of dt / f.
        double frames = 0.0;
        constexpr int parts = 20000;
        for (int i = 0; i < parts; ++i) {
            const double part = (i + 0.5) / parts;
            const double eased = easing == SpeedEasing::smooth ? part * part * (3.0 - 2.0 * part) : part;
            frames += 0.5 / parts / (1.0 - 0.75 * eased) * 60.0;
        }
        const auto between = std::ranges::count_if(clip.times, [](double t) { return t > 0.5 && t <= 1.0; });
        EXPECT_NEAR(double(between), frames, 1.5);
        EXPECT_TRUE(std::ranges::is_sorted(clip.times));
        for (std::size_t n = 1; n < clip.times.size(); ++n)
            EXPECT_LE(clip.times[n] - clip.times[n - 1], 1.0 / 60.0 + 1e-9);
    }
}

TEST(ClipSpeed, AHoldRepeatsTheFrameOfItsTime) {
    SceneDescription scene = falling_ball();
    for (const double time : {0.0, 0.51}) {
        scene.speed = {at(time, 1.0, SpeedEasing::step, 0.5)};
        const Clip clip = clip_of(scene);
        const double step = clip.timing.step();
        const auto held =
            std::ranges::count_if(clip.times, [&](double t) { return std::fabs(t - time) <= 0.5 * step + 1e-12; });
        EXPECT_EQ(held, 31) << time;  // the frame itself, and half a second more
        World world(scene, clip.timing, 1);
        FrameSequence sequence(world, {}, clip.steps);
        for (const double expected : clip.times) EXPECT_NEAR(sequence.next_start().time, expected, 1e-12);
    }
}

// The frames are states of the simulation: those of an even clip of that step, to the last bit.
TEST(ClipSpeed, FramesAreStatesOfOneSimulation) {
    SceneDescription scene = falling_ball();
    scene.speed = {at(0.9, 0.1), at(1.1, 1.0)};
    const Clip clip = clip_of(scene);
    World even(scene, {clip.timing.fps * clip.timing.steps_per_frame, 1}, 1), world(scene, clip.timing, 1);
    FrameSequence sequence(world, {}, clip.steps);
    for (std::size_t n = 0; n < clip.steps.size(); ++n) {
        EXPECT_EQ(sequence.next_start().bodies[1].origin, even.snapshot().bodies[1].origin) << n;
        for (int i = 0; i < clip.steps[n]; ++i) even.advance_frame();
    }
}

TEST(ClipSpeed, TheShutterIsOpenForAPartOfEachFrame) {
    SceneDescription scene = falling_ball();
    scene.speed = {at(0.5, 0.1), at(0.7, 1.0, SpeedEasing::step, 0.1)};
    const Shutter shutter = Shutter::of(180.0, 4);
    const Clip clip = clip_of(scene, 1.0, shutter);
    World world(scene, clip.timing, 1);
    FrameSequence sequence(world, shutter, clip.steps);
    for (std::size_t n = 0; n + 1 < clip.steps.size(); ++n) {
        const std::vector<Snapshot> moments = sequence.next();
        EXPECT_NEAR(moments.front().time, clip.times[n], 1e-12);
        if (clip.steps[n] == 0) {
            EXPECT_EQ(moments.size(), 1u);
            continue;
        }
        ASSERT_EQ(moments.size(), 5u);
        const double interval = clip.steps[n] * clip.timing.step();
        for (std::size_t i = 1; i < moments.size(); ++i)
            EXPECT_NEAR(moments[i].time, clip.times[n] + (double(i) - 0.5) * interval, 1e-9);
    }
}

TEST(ClipSpeed, FindsTheFirstImpactOfTwoBodies) {
    SceneDescription scene = falling_ball();
    SpeedKeyframe key = at(-0.1, 0.2);
    key.impact = {1, 0};
    scene.speed = {key};
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        scene.simulation.impacts = mode;
        const ClipSpeed found = clip_speed(scene, timing_at_speeds(scene, 1.0, {}));
        ASSERT_EQ(found.keys.size(), 1u);
        EXPECT_FALSE(found.keys[0].impact);
        EXPECT_NEAR(found.keys[0].time, std::sqrt(9.0 / 9.81) - 0.1, mode == ImpactMode::exact ? 1e-3 : 5e-3);
    }
}

TEST(ClipSpeed, LeavesOutAnImpactThatDoesNotHappen) {
    SceneDescription scene = falling_ball();
    scene.simulation.duration = 0.5;
    SpeedKeyframe key = at(0.0, 0.2);
    key.impact = {1, 0};
    scene.speed = {key};
    const ClipSpeed found = clip_speed(scene, timing_at_speeds(scene, 1.0, {}));
    EXPECT_TRUE(found.keys.empty());
    EXPECT_EQ(found.missing, std::vector<std::string>{"ball and ground"});
}

TEST(ClipSpeed, RefusesMoreFramesThanAClipMayHave) {
    SceneDescription scene = falling_ball();
    scene.speed = {at(0.0, 1.0, SpeedEasing::step, 1e9)};
    const FrameTiming timing = timing_at_speeds(scene, 1.0, {});
    EXPECT_THROW(steps_of_frames(scene, scene.speed, 1.0, timing, {}), InputError);
}

}  // namespace
}  // namespace tumble::clip_speed_test
