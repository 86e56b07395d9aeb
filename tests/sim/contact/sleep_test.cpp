// Which bodies fall asleep, and when; which wake, and with which others.
#include "sim/contact/model/sleep.h"
#include "sim/contact_scenes.h"

#include <gtest/gtest.h>

namespace tumble::sleep_test {
using namespace tumble::testing;

namespace {

constexpr double h = 1.0 / 64.0;  // exact in binary: half a second is 32 steps
constexpr double shortest = tuning::sleep_times.front(), longest = tuning::sleep_times.back();

/// A floor (0), two boxes one on the other (1, 2), and one apart from them on the floor (3); nothing moves unless a
/// test moves it.
struct Yard {
    std::vector<Body> bodies;
    std::vector<Manifold> manifolds = {touch(0, 1), touch(0, 3), touch(1, 2)};
    std::vector<std::uint32_t> awake = {1, 2, 3};
    ContactIslands islands{4};
    SleepMonitor sleep{4};

    Yard() {
        SceneDescription scene = ground_scene(0.0, 0.5);
        for (const double y : {0.5, 1.5}) add_box(scene, {1.0, 1.0, 1.0}, {0.0, y, 0.0});
        add_box(scene, {1.0, 1.0, 1.0}, {5.0, 0.5, 0.0});
        bodies = build_bodies(scene);
        for (Manifold& m : manifolds) m.points[0].impulse = 1.0;
    }
    void observe(int steps = 1) {
        for (int k = 0; k < steps; ++k) {
            islands.find(body_pairs(manifolds), bodies, awake);
            sleep.observe(islands, manifolds, bodies, h);
        }
    }
    int asleep() const {
        return int(std::count_if(bodies.begin(), bodies.end(), [](const Body& b) { return b.asleep; }));
    }
};

}  // namespace

TEST(SleepMonitor, AfterHalfASecondOfRest) {
    Yard yard;
    const int steps = int(tuning::sleep_times[0] / h);
    yard.observe(steps);  // the span starts with the first observation
    EXPECT_EQ(yard.asleep(), 0);
    yard.bodies[1].momentum = Vec3(0.0, 1e-7, 0.0);  // the residual motion is removed
    yard.observe();
    EXPECT_EQ(yard.asleep(), 3);
    EXPECT_TRUE(yard.bodies[1].momentum.isZero(0.0));
    EXPECT_TRUE(yard.bodies[1].velocity.isZero(0.0));
}

// One restless body keeps its island awake, and no other.
TEST(SleepMonitor, IslandsSleepAsOne) {
    Yard yard;
    for (int k = 0; k < 100; ++k) {
        yard.bodies[2].position.x() += 1.01 * tuning::sleep_drift(longest) * yard.bodies[2].radius;
        yard.observe();
    }
    EXPECT_FALSE(yard.bodies[1].asleep);
    EXPECT_FALSE(yard.bodies[2].asleep);
    EXPECT_TRUE(yard.bodies[3].asleep);
}

// Rotation in place is motion too.
TEST(SleepMonitor, SpinsAreNotRest) {
    Yard yard;
    for (int k = 0; k < 100; ++k) {
        yard.bodies[3].orientation = turn(Vec3::UnitY(), 1.1 * tuning::sleep_drift(longest) * k);
        yard.observe();
    }
    EXPECT_FALSE(yard.bodies[3].asleep);
    EXPECT_TRUE(yard.bodies[1].asleep);
}

// Trembling counts as rest, after a while; creeping beyond the amplitude does not.
TEST(SleepMonitor, TremblingIsRestAndCreepingIsNot) {
    Yard yard;
    const double drift = tuning::sleep_drift(longest) * yard.bodies[3].radius;
    for (int k = 0; k * h < longest + 1.0; ++k) {
        yard.bodies[3].position.x() = 5.0 + (k % 2 ? 0.45 : -0.45) * drift;
        yard.bodies[1].position.x() = 0.1 * k * drift;  // the whole drift in ten steps
        yard.observe();
    }
    EXPECT_TRUE(yard.bodies[3].asleep);
    EXPECT_FALSE(yard.bodies[1].asleep);
}

// A body that gains speed is not at rest, however slowly: its motion in half a second is no evidence. Nor is one that
// turns back.
TEST(SleepMonitor, GainingSpeedIsNotRest) {
    for (const double share : {1e-9, 0.25, 3.0})
        for (const double turns_back_after : {0.0, 1.3}) {
            Yard yard;
            const double rate = share * tuning::sleep_acceleration * yard.bodies[3].radius;
            for (int k = 0; k * h < 10.0 * shortest; ++k) {
                const double t = k * h - turns_back_after;
                yard.bodies[3].position.x() = 5.0 + 0.5 * rate * t * t;
                yard.bodies[3].velocity.x() = rate * t;
                yard.observe();
            }
            EXPECT_FALSE(yard.bodies[3].asleep) << share << " " << turns_back_after;
        }
}

TEST(SleepMonitor, GainingSpinIsNotRest) {
    Yard yard;
    for (int k = 0; k * h < 10.0 * shortest; ++k) {
        yard.bodies[3].angular_velocity.y() = 1e-9 * k * h;
        yard.observe();
    }
    EXPECT_FALSE(yard.bodies[3].asleep);
    EXPECT_TRUE(yard.bodies[1].asleep);
}

// A decaying creep is rest, and so is a drift at constant speed, too slow to be visible.
TEST(SleepMonitor, SettlingIsRest) {
    Yard yard;
    double speed = 1e-6;
    for (int k = 0; k * h < 4.0 * shortest; ++k, speed *= 0.97) {
        yard.bodies[3].velocity.y() = -speed;
        yard.bodies[1].velocity.x() = 1e-7;
        yard.observe();
    }
    EXPECT_TRUE(yard.bodies[3].asleep);
    EXPECT_TRUE(yard.bodies[1].asleep);
}

TEST(SleepMonitor, OnlyIslandsThatTouchAFixedBody) {
    Yard yard;
    yard.manifolds[0].points[0].impulse = 0.0;  // the pair touches the floor without weight
    yard.bodies[0].type = BodyType::fixed;
    yard.observe(100);
    EXPECT_FALSE(yard.bodies[1].asleep);
    EXPECT_TRUE(yard.bodies[3].asleep);
}

TEST(SleepMonitor, WakesTheGroupThatIsTouchedAndNoOther) {
    Yard yard;
    yard.observe(100);
    ASSERT_EQ(yard.asleep(), 3);
    const auto before = yard.sleep.changes();
    // A ball above the upper box, a centimeter off: too slow to arrive in this step, then fast enough.
    SceneDescription scene;
    add_sphere(scene, 0.5, {0.0, 2.51, 0.0});
    yard.bodies.push_back(BodyBuilder().build(scene.bodies[0], IntegratorKind::symplectic_euler));
    Manifold m = touch(2, 4);
    m.points[0].separation = 0.01;
    m.points[0].position = Vec3(0.0, 2.0, 0.0);
    const auto fall = [&](double speed) {
        yard.bodies[4].momentum = Vec3(0.0, -speed, 0.0);
        yard.bodies[4].derive();
        return yard.sleep.wake_touched({m}, yard.bodies, h, 0.0);
    };
    EXPECT_FALSE(fall(0.99 * 0.01 / h));
    EXPECT_EQ(yard.asleep(), 3);
    EXPECT_TRUE(fall(1.01 * 0.01 / h));
    EXPECT_EQ(yard.sleep.changes(), before + 1);
    EXPECT_FALSE(yard.bodies[1].asleep);  // with the one below it
    EXPECT_FALSE(yard.bodies[2].asleep);
    EXPECT_TRUE(yard.bodies[3].asleep);
}

// A body that stands still, fixed or kinematic, wakes nothing by touch; a moving kinematic body wakes at once.
TEST(SleepMonitor, AMovingSupportWakesAStandingOneDoesNot) {
    Yard yard;
    yard.bodies[0].type = BodyType::kinematic;
    yard.bodies[0].radius = 1.0;
    yard.observe(100);
    ASSERT_EQ(yard.asleep(), 3);
    EXPECT_FALSE(yard.sleep.wake_touched(yard.manifolds, yard.bodies, h, 0.1));
    yard.bodies[0].velocity = Vec3(0.0, -1e-9, 0.0);
    EXPECT_TRUE(yard.sleep.wake_touched(yard.manifolds, yard.bodies, h, 0.1));
    EXPECT_EQ(yard.asleep(), 0);
}

// One wakes the next: a row of sleeping groups, each touching the last one.
TEST(SleepMonitor, WakingPropagates) {
    Yard yard;
    yard.observe(100);
    std::vector<Manifold> manifolds = {touch(2, 3), touch(1, 2)};  // the third touches the pair only in this list
    yard.sleep.wake(3, yard.bodies);
    EXPECT_EQ(yard.asleep(), 2);
    EXPECT_TRUE(yard.sleep.wake_touched(manifolds, yard.bodies, h, 0.0));
    EXPECT_EQ(yard.asleep(), 0);
    // A woken body starts a new half second.
    yard.observe(int(tuning::sleep_times[0] / h));
    EXPECT_EQ(yard.asleep(), 0);
    yard.observe();
    EXPECT_EQ(yard.asleep(), 3);
}

}  // namespace tumble::sleep_test
