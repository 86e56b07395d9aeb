// The moments of frames with an open shutter: the middles of its parts.
#include "sim/frames/frame_sequence.h"

#include "support/compounds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::frame_sequence_test {
namespace {

constexpr double g = 9.81;  // m/s^2

/// A thrown brick that turns about its axis of symmetry, with its origin beside its center of mass; nothing touches it.
SceneDescription thrown_brick(int steps_per_frame) {
    SceneDescription scene;
    scene.output.fps = 20.0;
    scene.simulation.duration = 1.0;
    scene.simulation.steps_per_frame = steps_per_frame;
    scene.simulation.integrator = IntegratorKind::exact;
    BodyDescription brick;
    brick.shape = testing::compound_of({testing::part(BoxShape{{0.4, 0.2, 0.4}}, {0.3, 0.0, 0.0})});
    brick.velocity = {3.0, 4.0, 0.0};
    brick.angular_velocity = {0.0, 2.0, 0.0};
    scene.bodies = {brick};
    return scene;
}

void expect_state_at(const Snapshot& moment, double time, double tolerance) {
    const BodyState& body = moment.bodies[0];
    EXPECT_NEAR(moment.time, time, 1e-12);
    const Vec3 center(0.3 + 3.0 * time, 4.0 * time - 0.5 * g * time * time, 0.0);
    EXPECT_LT((body.center_of_mass - center).norm(), tolerance) << time;
    const Quat turn(std::cos(time), 0.0, std::sin(time), 0.0);  // 2 rad/s
    EXPECT_LT(body.orientation.angularDistance(turn), 1e-9) << time;
    EXPECT_LT((body.origin - (center - turn * Vec3(0.3, 0.0, 0.0))).norm(), tolerance) << time;
}

TEST(FrameSequence, MomentsAreTheMiddlesOfTheParts) {
    for (const int samples : {2, 3, 4, 5, 7, 8, 16})
        for (const double degrees : {360.0, 180.0})
            for (const int steps : {1, 4, 16, 48}) {
                const SceneDescription scene = thrown_brick(steps);
                const Shutter shutter = Shutter::of(degrees, samples);
                const FrameTiming timing = divided(scene.timing(), shutter.intervals);
                World world(scene, timing, 1);
                FrameSequence sequence(world, shutter);
                const double frame = 1.0 / scene.output.fps, part = frame / shutter.intervals, step = timing.step();
                // Where the number of steps is odd, the middle is that of a chord of the parabola.
                const double tolerance = timing.steps_per_frame % 2 == 0 ? 1e-9 : g * step * step / 8.0 + 1e-9;
                for (int n = 0; n < 3; ++n) {
                    const std::vector<Snapshot> moments = sequence.next();
                    ASSERT_EQ(int(moments.size()), 1 + samples);
                    expect_state_at(moments[0], n * frame, 1e-9);
                    for (int i = 0; i < samples; ++i)
                        expect_state_at(moments[std::size_t(1 + i)], n * frame + (i + 0.5) * part, tolerance);
                }
            }
}

TEST(FrameSequence, MiddlesLeaveTheMotionAsItIs) {
    SceneDescription scene = thrown_brick(16);
    BodyDescription ground;
    ground.shape = PlaneShape{};
    ground.type = BodyType::fixed;
    scene.bodies.push_back(ground);
    scene.bodies[0].position = {0.0, 1.0, 0.0};
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        scene.simulation.impacts = mode;
        World plain(scene), blurred(scene, divided(scene.timing(), 16), 1);
        FrameSequence sequence(blurred, Shutter::of(180.0, 8));
        for (int n = 0; n < 20; ++n) {
            if (n > 0) plain.advance_frame();
            const BodyState a = plain.snapshot().bodies[0], b = sequence.next().front().bodies[0];
            ASSERT_EQ(a.origin, b.origin) << n;
            ASSERT_EQ(a.orientation.coeffs(), b.orientation.coeffs()) << n;
        }
    }
}

TEST(FrameSequence, WithoutAShutterThereIsOneMoment) {
    const SceneDescription scene = thrown_brick(16);
    World world(scene);
    FrameSequence sequence(world, {});
    for (int n = 0; n < 3; ++n) {
        const std::vector<Snapshot> moments = sequence.next();
        ASSERT_EQ(moments.size(), 1u);
        expect_state_at(moments[0], n / scene.output.fps, 1e-9);
    }
}

}  // namespace
}  // namespace tumble::frame_sequence_test
