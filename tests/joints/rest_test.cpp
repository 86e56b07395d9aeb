// Joined bodies come to rest: jammed figures, dampers, and doors that turn back, which do not rest.
#include "joint_scenes.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tumble::joint_rest_test {
using namespace tumble::testing;

namespace {

bool all_asleep(const World& world) {
    const Snapshot now = world.snapshot();
    return std::all_of(now.bodies.begin(), now.bodies.end(),
                       [](const BodyState& body) { return body.asleep || body.mass == 0.0; });
}

/// A trunk with a head and four limbs of two parts, with limits, dry friction and dampers, dropped on a floor with a
/// step.
SceneDescription fallen_figure_scene(int trial) {
    SceneDescription scene = ground_scene(0.0, 0.6, 4);
    BodyDescription& stone = add_box(scene, {2.0, 0.2, 6.0}, {1.3, 0.1, 0.0});
    stone.type = BodyType::fixed;
    stone.friction = 0.6;
    Random random{std::uint64_t(trial)};
    const Quat pose = turn(random.direction(), 2.0);
    const auto place = [&](const Vec3& at) { return Vec3(Vec3(0.0, 1.2, 0.0) + pose * at); };
    const auto part = [&](const Vec3& size, const Vec3& at, double mass) {
        BodyDescription& body = add_box(scene, size, place(at), mass);
        body.rotation = pose;
        body.friction = 0.3;
        return scene.bodies.size() - 1;
    };
    const auto join = [&](JointType type, std::size_t a, std::size_t b, const Vec3& at, double most) {
        JointDescription& joint = add_joint(scene, type, a, b, place(at), pose * Vec3::UnitZ());
        for (JointAxis& axis : joint.turn) {
            if (axis.motion == JointAxis::Motion::locked) continue;
            axis.friction = 0.03;
            axis.spring = JointSpring{};
            axis.spring->damping = 0.3;
        }
        if (type == JointType::hinge) {
            joint.turn[0].motion = JointAxis::Motion::limited;
            joint.turn[0].lower = -0.05;
            joint.turn[0].upper = most;
        }
    };
    const std::size_t trunk = part({0.2, 0.5, 0.3}, {0.0, 0.0, 0.0}, 15.0);
    join(JointType::ball, trunk, part({0.16, 0.2, 0.16}, {0.0, 0.37, 0.0}, 3.0), {0.0, 0.26, 0.0}, 0.0);
    for (const double side : {-1.0, 1.0})
        for (const double up : {-1.0, 1.0}) {
            const double z = side * (up > 0.0 ? 0.22 : 0.1), y = up > 0.0 ? 0.05 : -0.45;
            const std::size_t upper = part({0.1, 0.32, 0.1}, {0.0, y, z}, 3.0),
                              lower = part({0.08, 0.3, 0.08}, {0.0, y - 0.34, z}, 2.0);
            join(JointType::ball, trunk, upper, {0.0, y + 0.17, z}, 0.0);
            join(JointType::hinge, upper, lower, {0.0, y - 0.17, z}, 2.0);
        }
    return scene;
}

/// A rod hinged to the world about z, hanging, `angle` (rad) aside, with a damper that lets it sink back as exp(-t /
/// `time`).
SceneDescription damped_rod_scene(double angle, double time) {
    SceneDescription scene = pendulum_scene(angle, 4);
    scene.simulation.sleep = true;
    JointAxis& axis = scene.joints[0].turn[0];
    axis.spring = JointSpring{};
    axis.spring->damping = time * 9.81 * 0.5;  // N m s/rad: times the weight's torque per radian of 1 kg at 0.5 m
    return scene;
}

// Its limbs hold each other up. Rounds that end with soft friction leave it a creep, or friction that never settles.
TEST(JointRest, AJammedFigureFallsAsleep) {
    for (int trial = 0; trial < 17; ++trial) {
        World world(fallen_figure_scene(trial));
        for (int frame = 0; frame < 300 && !(frame > 60 && all_asleep(world)); ++frame) world.advance_frame();
        EXPECT_TRUE(all_asleep(world)) << trial;
    }
}

// theta = theta_0 exp(-t/T) with T = 3 s, whose velocity changes by less than a thirtieth from sample to sample: it
// falls asleep where the way that is left, theta of the surface, is 2e-4 radii, and not before.
TEST(JointRest, ADampedRodFallsAsleepNearItsEnd) {
    World world(damped_rod_scene(0.3, 3.0));
    int frame = 0;
    for (; frame < 1800 && !all_asleep(world); ++frame) world.advance_frame();
    EXPECT_LT(frame, 1800);
    const double left = 0.3 - std::abs(world.joint_states()[0].position[3]);  // from the start
    EXPECT_LT(left, 2e-4);
    EXPECT_GT(left, 1e-4);
}

// A door on hinges that lean by an angle of 1e-5 or 1e-7, pushed up: it turns back after 1.3 s, and sleep changes no
// digit. With a damper its velocity decays too, and reverses.
TEST(JointRest, ADoorThatTurnsBackStaysAwake) {
    for (const double slope : {1e-5, 1e-7})
        for (const double damping : {0.0, 0.2})
            for (const int steps : {1, 4}) {
                const double rate = 9.81 * slope * 0.5 / (1.0 / 3.0 + 0.01 / 12.0);  // rad/s^2
                Vec3 ends[2];
                for (const bool sleep : {false, true}) {
                    SceneDescription scene;
                    scene.simulation.steps_per_frame = steps;
                    scene.simulation.sleep = sleep;
                    scene.simulation.gravity = Vec3(0.0, -9.81, 9.81 * slope);
                    BodyDescription& door = add_box(scene, {1.0, 0.1, 0.1}, {0.5, 0.0, 0.0});
                    JointAxis& axis =
                        add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitY()).turn[0];
                    if (damping > 0.0) {
                        axis.spring = JointSpring{};
                        axis.spring->damping = damping;
                    }
                    const double spin = 1.3 * rate;
                    door.angular_velocity = Vec3(0.0, spin, 0.0);
                    door.velocity = Vec3(0.0, 0.0, -0.5 * spin);
                    World world(scene);
                    run(world, scene, 5.0);
                    ends[sleep] = world.snapshot().bodies[0].center_of_mass;
                }
                EXPECT_EQ(ends[0], ends[1]) << slope << " " << damping << " " << steps;
                if (damping > 0.0) continue;
                const double way = 0.5 * rate * (0.5 * 25.0 - 1.3 * 5.0);
                EXPECT_NEAR(ends[1].z(), way, 0.02 * way) << slope << " " << steps;
            }
}

}  // namespace
}  // namespace tumble::joint_rest_test
