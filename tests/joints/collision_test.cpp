// Joined bodies that collide, in both modes: a pendulum and a wall, cradles, chains.
#include "joint_scenes.h"
#include "sim/checkpoint/archive.h"

#include <gtest/gtest.h>

namespace tumble::collision_test {
namespace {

using namespace testing;

double energy_of(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential;
}

// The pendulum of joint_scenes.h: m g l / 2 / I about the hinge.
constexpr double inertia = 1.01 / 12.0 + 0.25, rate_squared = 9.81 * 0.5 / inertia;

/// Time from rest at 90 degrees to the angle `to` on the other side, s: the elliptic integral, by Simpson's rule.
double time_to(double to) {
    const double k = std::sin(0.25 * std::numbers::pi), from = std::asin(std::sin(0.5 * to) / k);
    const int n = 2000;
    const double h = (0.5 * std::numbers::pi - from) / n;
    double sum = 0.0;
    for (int i = 0; i <= n; ++i) {
        const double sine = k * std::sin(from + i * h);
        sum += (i == 0 || i == n ? 1.0 : i % 2 ? 4.0 : 2.0) / std::sqrt(1.0 - sine * sine);
    }
    return sum * h / 3.0 / std::sqrt(rate_squared);
}

struct WallBlow {
    double time, speed_before, speed_after;  // s; rad/s
    double later, energy;                    // J: long after the blow
};

/// A pendulum from 90 degrees against a wall at x = -0.3 m.
WallBlow blow_of_pendulum(double restitution, ImpactMode mode, int steps_per_frame) {
    SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi, steps_per_frame);
    scene.simulation.impacts = mode;
    scene.bodies[0].restitution = restitution;
    BodyDescription& wall = add_body(scene, PlaneShape{Vec3::UnitX(), -0.3}, Vec3::Zero());
    wall.type = BodyType::fixed;
    wall.restitution = 0.0;
    World world(scene);
    world.record_contacts();
    WallBlow blow{0.0, 0.0, 0.0, 0.0, 0.0};
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        if (world.contact_records().impacts.empty() || blow.time > 0.0) continue;
        blow.time = world.contact_records().impacts[0].when.time;
        const auto& struck = world.contact_records().struck;
        for (const StruckBody& body : struck)
            if (body.angular_velocity_before.norm() > 0.0) {
                blow.speed_before = body.angular_velocity_before.z();
                blow.speed_after = body.angular_velocity_after.z();
            }
        blow.energy = energy_of(world);
    }
    blow.later = energy_of(world);
    return blow;
}

TEST(JointCollision, APendulumHitsAWallAtItsTime) {
    const double angle = std::asin(-0.3 / std::sqrt(1.0025)) + std::atan(0.05);
    const double speed = -std::sqrt(2.0 * rate_squared * std::cos(angle));
    for (const double e : {1.0, 0.5}) {
        for (const int steps : {1, 4, 16}) {
            const WallBlow blow = blow_of_pendulum(e, ImpactMode::exact, steps);
            EXPECT_NEAR(blow.time, time_to(angle), 1e-14);
            EXPECT_NEAR(blow.speed_before, speed, 1e-13);
            EXPECT_NEAR(blow.speed_after, -e * speed, 1e-13);
            EXPECT_NEAR(blow.later, blow.energy, 1e-12);
        }
        const WallBlow stepped = blow_of_pendulum(e, ImpactMode::stepped, 16);
        EXPECT_NEAR(stepped.time, time_to(angle), 2.0 / 960.0);
        EXPECT_NEAR(stepped.speed_after, -e * stepped.speed_before, 2e-4);
        EXPECT_NEAR(stepped.later, stepped.energy, 1e-3);
    }
}

// A rod turns about a pin, a fixed body that it overlaps, as if the pin had no shape: it is joined to it.
TEST(JointCollision, APinIsNoObstacle) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
        scene.simulation.impacts = mode;
        scene.simulation.integrator = IntegratorKind::exact;
        BodyDescription& pin = add_box(scene, {0.2, 0.2, 0.2}, Vec3::Zero());
        pin.type = BodyType::fixed;
        scene.joints[0].first = 1;
        World world(scene);
        world.record_contacts();
        const double start = energy_of(world);
        for (int frame = 0; frame < 60; ++frame) {
            world.advance_frame();
            EXPECT_TRUE(world.contact_records().impacts.empty());
        }
        EXPECT_NEAR(energy_of(world), start, 1e-13);
    }
}

/// Balls of radius 0.25 m side by side on pairs of rods of 2.5 m; the first is `angle` aside.
SceneDescription cradle_scene(int balls, double angle, double restitution) {
    SceneDescription scene;
    scene.simulation.sleep = false;
    for (int i = 0; i < balls; ++i) {
        const double x = 0.5 * i;
        const Vec3 place = i == 0 ? Vec3(x - 2.5 * std::sin(angle), 2.5 - 2.5 * std::cos(angle), 0.0) : Vec3(x, 0, 0);
        add_sphere(scene, 0.25, place).restitution = restitution;
        for (const double z : {-0.45, 0.45}) {
            JointDescription& rod =
                add_joint(scene, JointType::distance, std::nullopt, std::size_t(i), Vec3(x, 2.5, z));
            rod.anchor_second = Vec3::Zero();
            rod.length = std::hypot(2.5, 0.45);
        }
    }
    return scene;
}

TEST(JointCollision, AHangingCradlePassesTheImpulseOn) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = cradle_scene(5, 0.8, 1.0);
        scene.simulation.impacts = mode;
        World world(scene);
        const double start = energy_of(world);
        double highest = 0.0, others = 0.0;
        for (int frame = 0; frame < 140; ++frame) {  // the last ball returns after 149
            world.advance_frame();
            const Snapshot snapshot = world.snapshot();
            highest = std::max(highest, snapshot.bodies[4].center_of_mass.y());
            if (frame > 55)
                for (std::size_t i = 0; i < 4; ++i) others = std::max(others, snapshot.bodies[i].velocity.norm());
        }
        EXPECT_NEAR(highest, 2.5 * (1.0 - std::cos(0.8)), 1e-3);
        EXPECT_LT(others, mode == ImpactMode::exact ? 1e-11 : 1e-3);
        EXPECT_NEAR(energy_of(world), start, mode == ImpactMode::exact ? 1e-10 : 1e-2);
        EXPECT_LT(largest_gap(world), 1e-12);
    }
}

// A ball strikes a free chain: the blow is the chain's, at the time of the contact.
TEST(JointCollision, ABallStrikesAFreeChain) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = free_chain_scene(6);
        for (BodyDescription& link : scene.bodies) {
            link.velocity.setZero();
            link.restitution = 1.0;
        }
        scene.simulation.impacts = mode;
        BodyDescription& ball = add_sphere(scene, 0.1, {0.3, 1.0, 0.02}, 2.0);
        ball.velocity = {0.1, -4.0, 0.0};
        World world(scene);
        world.record_contacts();
        const Measurement before = world.measure();
        double time = 0.0, impulse = 0.0;
        for (int frame = 0; frame < 60; ++frame) {
            world.advance_frame();
            for (const ImpactRecord& impact : world.contact_records().impacts) {
                if (time == 0.0) time = impact.when.time;
                impulse += impact.impulse;
            }
        }
        const Measurement after = world.measure();
        const bool exact = mode == ImpactMode::exact;
        EXPECT_NEAR(time, 0.85 / 4.0, exact ? 1e-14 : 2.0 / 960.0);
        EXPECT_GT(impulse, 1.0);
        EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12);
        EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(), 1e-11);
        EXPECT_NEAR(after.kinetic, before.kinetic, exact ? 1e-9 : 3e-3);  // Verlet's method: not symplectic
        EXPECT_LT(largest_gap(world), 1e-12);
    }
}

// Over a frame with a blow, the momentum changes by the joint's mean force, gravity and the blow.
TEST(JointCollision, TheLoadOfAFrameHasTheBlow) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
        scene.simulation.impacts = mode;
        scene.bodies[0].restitution = 0.8;
        scene.bodies[0].friction = 0.0;
        add_body(scene, PlaneShape{Vec3::UnitX(), -0.3}, Vec3::Zero()).type = BodyType::fixed;
        World world(scene);
        world.record_contacts();
        const double frame = 1.0 / scene.output.fps;
        double lost = 0.0;
        std::size_t blows = 0;
        for (int n = 0; n < 90; ++n) {
            const Measurement before = world.measure();
            world.advance_frame();
            const Measurement after = world.measure();
            const ContactRecords& records = world.contact_records();
            Vec3 force = world.joint_states()[0].mean_force + records.loads[0].force;
            for (const ImpactRecord& impact : records.impacts) {
                force += impact.impulse * (impact.a == 0 ? -1.0 : 1.0) / frame * impact.normal;
                lost -= 0.5 * impact.impulse * (impact.speed_before + impact.speed_after);
            }
            blows += records.impacts.size();
            for (const ContactRecord& contact : records.contacts)
                force +=
                    (contact.a == 0 ? -1.0 : 1.0) * (contact.normal_force * contact.normal + contact.tangential_force);
            EXPECT_LT((after.momentum - before.momentum - frame * force).norm(), 1e-12) << n;
        }
        EXPECT_GT(blows, 0u);
        EXPECT_NEAR(world.contact_records().energy.impact_loss, lost, 0.02 * lost);
    }
}

// A rope of hinged boxes falls on a table: no energy from nothing, joints closed, at rest in the end.
TEST(JointCollision, AChainFallsOnATable) {
    SceneDescription scene = ground_scene(0.4, 0.5);
    scene.simulation.impacts = ImpactMode::exact;
    for (int i = 0; i < 8; ++i) {
        add_box(scene, {0.2, 0.1, 0.1}, {0.2 * i, 0.5 + 0.05 * i, 0.0}, 1.0 + i % 3).friction = 0.5;
        if (i > 0)
            add_joint(scene, JointType::hinge, std::size_t(i), std::size_t(i + 1),
                      {0.2 * i - 0.1, 0.5 + 0.05 * i - 0.025, 0.0}, Vec3::UnitZ());
    }
    World world(scene);
    double gap = 0.0, last = energy_of(world), gain = 0.0;
    for (int frame = 0; frame < 300; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
        gain = std::max(gain, energy_of(world) - last);
        last = energy_of(world);
    }
    const Snapshot snapshot = world.snapshot();
    EXPECT_LT(gap, 1e-6);
    EXPECT_LT(gain, 1e-4);
    EXPECT_TRUE(std::all_of(snapshot.bodies.begin() + 1, snapshot.bodies.end(),
                            [](const BodyState& body) { return body.asleep; }));
}

/// A ball strikes the lower of two hanging rods, of a restitution of 1. 12.5 J.
SceneDescription struck_rods_scene(ImpactMode mode, int steps_per_frame, double break_impulse) {
    SceneDescription scene = empty_scene(steps_per_frame);
    scene.simulation.impacts = mode;
    add_box(scene, {0.1, 0.9, 0.1}, {0.0, -0.5, 0.0}).restitution = 1.0;
    add_box(scene, {0.1, 0.9, 0.1}, {0.0, -1.5, 0.0}).restitution = 1.0;
    add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitZ());
    add_joint(scene, JointType::hinge, 0, 1, {0.0, -1.0, 0.0}, Vec3::UnitZ()).break_impulse = break_impulse;
    add_sphere(scene, 0.1, {-1.0, -1.9, 0.0}).velocity = {5.0, 0.0, 0.0};
    return scene;
}

// The hinge between the rods breaks at its strength.
TEST(JointCollision, ABlowBreaksAHinge) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        const SceneDescription scene = struck_rods_scene(mode, 16, 0.1);
        World world(scene);
        const double start = energy_of(world);
        run(world, scene, 0.5);
        EXPECT_LE(energy_of(world), start);
        ASSERT_TRUE(world.joint_states()[1].broken_at.has_value());
        // The upper rod gets what the hinge could give, at a meter from its own.
        EXPECT_NEAR(*world.joint_states()[1].broken_at, 0.17, 2.0 / 960.0);
        EXPECT_NEAR(world.snapshot().bodies[0].angular_velocity.z(), -0.1 / (0.82 / 12.0 + 0.25), 1e-3);
    }
}

// The blow keeps the energy. That of Verlet's method after it oscillates by (h w)^2: by a quarter with half the step.
TEST(JointCollision, ABlowOnHeldRodsKeepsTheEnergy) {
    const auto error = [](ImpactMode mode, int steps) {
        const SceneDescription scene = struck_rods_scene(mode, steps, infinity);
        World world(scene);
        const double start = energy_of(world);
        double most = 0.0;
        for (int frame = 0; frame < 30; ++frame) {
            world.advance_frame();
            most = std::max(most, std::abs(energy_of(world) - start));
        }
        return most;
    };
    for (const int steps : {4, 16}) EXPECT_LT(error(ImpactMode::exact, steps), 1e-12);
    const double coarse = error(ImpactMode::stepped, 16), fine = error(ImpactMode::stepped, 32);
    EXPECT_LT(coarse, 2e-4);
    EXPECT_NEAR(coarse / fine, 4.0, 0.1);
}

TEST(JointCollision, ThreadsAndOrderChangeNoByte) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = ground_scene(0.6, 0.5);
        scene.simulation.impacts = mode;
        for (int c = 0; c < 4; ++c)
            for (int i = 0; i < 3; ++i) {
                BodyDescription& box = add_box(scene, {0.2, 0.1, 0.1}, {0.2 * i, 0.3 + 0.25 * c, 0.4 * (c % 2)});
                box.friction = 0.4;
                box.restitution = 0.6;
                const std::size_t body = scene.bodies.size() - 1;
                if (i > 0)
                    add_joint(scene, JointType::hinge, body - 1, body, {0.2 * i - 0.1, 0.3 + 0.25 * c, 0.4 * (c % 2)},
                              Vec3::UnitZ());
            }
        World one(scene, 1), two(scene, 2);
        for (int frame = 0; frame < 24; ++frame) {
            one.advance_frame();
            two.advance_frame();
            const Snapshot a = one.snapshot(), b = two.snapshot();
            for (std::size_t i = 0; i < a.bodies.size(); ++i) {
                ASSERT_EQ(a.bodies[i].center_of_mass, b.bodies[i].center_of_mass) << frame << " " << i;
                ASSERT_EQ(a.bodies[i].orientation.coeffs(), b.bodies[i].orientation.coeffs());
            }
        }
    }
}

// A world restored in the middle goes on to the last byte.
TEST(JointCollision, ACheckpointGoesOn) {
    SceneDescription scene = cradle_scene(4, 0.8, 0.9);
    scene.simulation.impacts = ImpactMode::exact;
    World whole(scene);
    CheckpointWriter middle, end;
    for (int frame = 0; frame < 120; ++frame) {
        if (frame == 35) whole.save(middle);
        whole.advance_frame();
    }
    whole.save(end);
    World part(scene);
    CheckpointReader reader(middle.bytes());
    part.restore(reader);
    for (int frame = 35; frame < 120; ++frame) part.advance_frame();
    CheckpointWriter again;
    part.save(again);
    EXPECT_TRUE(std::ranges::equal(end.bytes(), again.bytes()));
}

}  // namespace
}  // namespace tumble::collision_test
