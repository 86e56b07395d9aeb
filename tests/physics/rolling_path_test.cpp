// Curved bodies that roll and slide on one point with exact impacts: energy, and independence of the step where one way
// of motion ends and another begins.
#include "core/deterministic_math.h"
#include "exact_scenes.h"
#include "support/curved.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tumble::rolling_path_test {
using namespace tumble::testing;

namespace {

struct Coin {
    double tilt = 60.0;  // degrees, of its faces from the ground
    double over = 1.05;  // angular velocity over that of steady precession about a center at rest
    double spin = 0.0;   // rad/s, about its axis
    double friction = 1.0;
    Vec3 slip = Vec3::Zero();  // m/s, of the contact point
    double radius = 0.04, height = 0.006;
};

// Its contact point lies below the center on +z. omega^2 = (4 g / r) sin(tilt) along the line to it (Moffatt 2000,
// "Euler's disk and its finite-time singularity", Nature 404).
SceneDescription coin_scene(const Coin& coin, bool on_box = false) {
    SceneDescription scene = ground_scene(0.0, coin.friction);
    if (on_box) {
        scene.bodies[0].shape = BoxShape{{12.0, 0.2, 12.0}};
        scene.bodies[0].position.y() = -0.1;
    }
    const SinCos tilt = sincos(coin.tilt * pi / 180.0);
    const Vec3 axis(0.0, tilt.cos, tilt.sin);
    const Vec3 arm = -0.5 * coin.height * axis + coin.radius * Vec3(0.0, -tilt.sin, tilt.cos);
    BodyDescription& body = add_body(scene, cylinder(coin.radius, coin.height), {0.0, -arm.y(), 0.0});
    body.rotation = turn(Vec3::UnitX(), coin.tilt * pi / 180.0);
    body.angular_velocity =
        coin.over * std::sqrt(4.0 * gravity / coin.radius * tilt.sin) * arm.normalized() + coin.spin * axis;
    body.velocity = coin.slip - body.angular_velocity.cross(arm);
    body.friction = coin.friction;
    body.restitution = 0.0;
    make_exact(scene);
    return scene;
}

// Dropped tilted and turning.
SceneDescription drop_scene(const CurvedShape& shape, double restitution, bool on_box) {
    SceneDescription scene = ground_scene(restitution, 0.6);
    if (on_box) {
        scene.bodies[0].shape = BoxShape{{12.0, 0.2, 12.0}};
        scene.bodies[0].position.y() = -0.1;
    }
    BodyDescription& body = add_body(scene, shape, {0.0, 0.1, 0.0});
    body.rotation = turn(Vec3(1.0, 0.0, 0.3), pi / 3.0);
    body.angular_velocity = {3.0, 5.0, 2.0};
    body.friction = 0.6;
    body.restitution = restitution;
    make_exact(scene);
    return scene;
}

BodyState after(SceneDescription scene, double rate, double time) {
    set_step(scene, rate);
    World world(scene);
    run(world, scene, time);
    return world.snapshot().bodies.back();
}

double difference(const BodyState& a, const BodyState& b) {
    return std::max({(a.center_of_mass - b.center_of_mass).norm(), 0.04 * a.orientation.angularDistance(b.orientation),
                     (a.velocity - b.velocity).norm()});
}

}  // namespace

TEST(RollingPath, EulersDiskKeepsItsEnergy) {
    const Coin coins[] = {
        {.tilt = 25.0, .over = 1.1}, {.tilt = 5.0}, {.tilt = 60.0}, {.tilt = 85.0, .over = 0.0, .spin = 40.0}};
    for (const Coin& coin : coins)
        for (const bool on_box : {false, true}) {
            SCOPED_TRACE(std::to_string(coin.tilt) + (on_box ? " on a box, stepped" : " on a plane"));
            SceneDescription scene = coin_scene(coin, on_box);
            if (on_box) scene.simulation.impacts = ImpactMode::stepped;
            World world(scene);
            world.record_energy();
            const double start = energy(world);
            run(world, scene, 2.0);
            EXPECT_NEAR(energy(world) / start, 1.0, 1e-10);
            EXPECT_GT(world.snapshot().bodies.back().angular_velocity.norm(), 1.0);
        }
}

// Without friction nothing turns the body about the vertical, or pushes it aside.
TEST(RollingPath, FrictionlessCoinKeepsItsMomenta) {
    const SceneDescription scene = coin_scene({.friction = 0.0, .slip = {0.3, 0.0, -0.2}});
    World world(scene);
    const Measurement start = world.measure();
    const double before = energy(world);
    run(world, scene, 2.0);
    const Measurement end = world.measure();
    EXPECT_NEAR(energy(world) / before, 1.0, 1e-10);
    EXPECT_NEAR(end.momentum.x(), start.momentum.x(), 1e-13);
    EXPECT_NEAR(end.momentum.z(), start.momentum.z(), 1e-13);
    EXPECT_NEAR(end.angular_momentum.y(), start.angular_momentum.y(), 1e-13);
}

// A thin disk rolls upright in a stable way above v^2 = g r / 3 (Routh 1905, "Advanced Rigid Dynamics", art. 244).
TEST(RollingPath, AFastDiskStaysUpright) {
    for (const double spin : {30.0, 3.0}) {
        const SceneDescription scene = coin_scene({.tilt = 89.0, .over = 0.0, .spin = spin, .height = 0.0002});
        World world(scene);
        run(world, scene, 0.6);
        const double lean = std::abs((world.snapshot().bodies.back().orientation * Vec3::UnitY()).y());
        EXPECT_EQ(lean<0.05, spin> 10.0) << spin << " " << lean;
    }
}

// The slip begins, ends and turns at its own time, in a scene that would differ by its own size otherwise.
TEST(RollingPath, ASlipBeginsAndEndsAlikeAtAnyStep) {
    const Coin coins[] = {{.tilt = 65.0, .over = 0.6, .spin = 12.0, .friction = 0.3},
                          {.tilt = 65.0, .over = 0.5, .friction = 0.1, .slip = {0.1, 0.0, 0.3}},
                          {.tilt = 25.0, .over = 0.0, .spin = 30.0, .friction = 0.5, .slip = {0.0, 0.0, 0.3}}};
    for (const Coin& coin : coins) {
        SCOPED_TRACE(coin.spin);
        EXPECT_LT(difference(after(coin_scene(coin), 240.0, 0.2), after(coin_scene(coin), 960.0, 0.2)), 2e-5);
    }
}

TEST(RollingPath, ALandingIsAlikeAtAnyStep) {
    for (const bool on_box : {false, true})
        for (const double restitution : {0.0, 0.4})
            for (const CurvedShape& shape : {cylinder(0.04, 0.006), ellipsoid({0.04, 0.06, 0.03})}) {
                SCOPED_TRACE(std::to_string(restitution) + (on_box ? " on a box" : " on a plane"));
                const SceneDescription scene = drop_scene(shape, restitution, on_box);
                EXPECT_LT(difference(after(scene, 240.0, 0.4), after(scene, 960.0, 0.4)), 5e-5);
            }
}

// The change of the energy is the loss by friction, the change of the momenta the impulses of contact and gravity.
TEST(RollingPath, RecordsBalance) {
    SceneDescription scene = coin_scene({.tilt = 65.0, .over = 0.5, .friction = 0.1, .slip = {0.1, 0.0, 0.3}});
    World world(scene);
    world.record_contacts();
    const double start = energy(world);
    for (int frame = 0; frame < 30; ++frame) {
        const BodyState before = world.snapshot().bodies.back();
        world.advance_frame();
        const ContactRecords& records = world.contact_records();
        const BodyState now = world.snapshot().bodies.back();
        Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
        for (const ContactRecord& c : records.contacts) {
            EXPECT_NE(c.a, ContactRecord::nobody);
            const double sign = c.b == 1 ? 1.0 : -1.0;
            force += sign * (c.normal_force * c.normal + c.tangential_force);
            moment += sign * c.moment;
        }
        for (const ExternalLoad& load : records.loads) force += load.force, moment += load.moment;
        const double h = 1.0 / scene.output.fps;
        const Vec3 turned = now.angular_momentum - before.angular_momentum + now.center_of_mass.cross(now.momentum) -
                            before.center_of_mass.cross(before.momentum);
        EXPECT_LT((h * force - (now.momentum - before.momentum)).norm(), 1e-13);
        EXPECT_LT((h * moment - turned).norm(), 1e-13);
    }
    const EnergyLedger& losses = world.contact_records().energy;
    EXPECT_GT(losses.friction_loss, 0.0);
    EXPECT_NEAR(losses.friction_loss, start - energy(world), 1e-10 * start);
    EXPECT_NEAR(losses.impact_loss, 0.0, 1e-10 * start);
}

// Coins within reach of each other in a coarse step that do not meet.
TEST(RollingPath, CoinsPassEachOther) {
    SceneDescription scene = coin_scene({.tilt = 35.0});
    BodyDescription other = coin_scene({.tilt = 85.0, .over = 0.0, .spin = 25.0}).bodies.back();
    other.position += Vec3(other.velocity.x() > 0.0 ? -0.3 : 0.3, 0.0, 0.1);
    scene.bodies.push_back(other);
    set_step(scene, 60.0);
    World world(scene);
    const double start = energy(world);
    double nearest = infinity;
    for (int frame = 0; frame < 40; ++frame) {
        world.advance_frame();
        const Snapshot now = world.snapshot();
        nearest = std::min(nearest, (now.bodies[1].center_of_mass - now.bodies[2].center_of_mass).norm());
    }
    EXPECT_LT(nearest, 0.115);
    EXPECT_NEAR(energy(world) / start, 1.0, 1e-10);
}

// A coin that CCD stops at another body within a step is there on its rim, with the energy of that moment.
TEST(RollingPath, AStoppedCoinStaysOnItsRim) {
    for (const ImpactMode mode : {ImpactMode::exact, ImpactMode::stepped}) {
        SceneDescription scene = coin_scene({.tilt = 85.0, .over = 0.0, .spin = 40.0});
        const double speed = scene.bodies.back().velocity.x();
        BodyDescription& wall =
            add_fixed_box(scene, {0.1, 0.2, 1.0}, {std::copysign(0.05 + 0.06, speed), 0.1, 0.0}, 0.0);
        wall.friction = 0.0;
        std::swap(scene.bodies[1], scene.bodies[2]);
        scene.simulation.impacts = mode;
        set_step(scene, 60.0);
        World world(scene);
        const double start = energy(world);
        for (int frame = 0; frame < 6; ++frame) {
            world.advance_frame();
            EXPECT_LT(energy(world), start * (1.0 + 1e-6));
            for (const Overlap& overlap : world.overlaps()) EXPECT_LT(overlap.depth, 1e-4) << frame;
        }
    }
}

// A cylinder on one rim tilts over its side, and the other rim meets the plane: an impact, which gains no energy.
TEST(RollingPath, TheOtherRimMeetsThePlaneInAnImpact) {
    for (const ImpactMode mode : {ImpactMode::exact, ImpactMode::stepped})
        for (const double restitution : {0.0, 0.5})
            for (const double height : {0.325, 0.33}) {
                SCOPED_TRACE(std::to_string(int(mode)) + " " + std::to_string(restitution) + " " +
                             std::to_string(height));
                SceneDescription scene = ground_scene(restitution, 0.35);
                BodyDescription& body = add_body(scene, cylinder(0.3, 0.5), {0.0, height, 0.0});
                body.rotation = turn(Vec3::UnitX(), 84.0 * pi / 180.0);
                body.angular_velocity = {1.0, 4.0, 4.0};
                body.velocity = {0.5, 0.0, -1.0};
                body.friction = 0.35;
                body.restitution = restitution;
                make_exact(scene);
                scene.simulation.impacts = mode;
                set_step(scene, 240.0);
                World world(scene);
                const auto tilt = [&] { return (world.snapshot().bodies.back().orientation * Vec3::UnitY()).y(); };
                const double start = energy(world);
                double before = start, other_rim = tilt();
                for (int frame = 0; frame < 240; ++frame) {
                    world.advance_frame();
                    // A lift out of an overlap adds energy.
                    EXPECT_LT(energy(world), before + 1e-3 * start) << frame;
                    before = energy(world);
                    other_rim = std::min(other_rim, tilt());
                }
                EXPECT_LT(other_rim, 0.0);
            }
}

// Other contacts and rolling friction leave the body to the contact solver, and it comes to rest.
TEST(RollingPath, RollingFrictionEndsTheMotion) {
    SceneDescription scene = coin_scene({.tilt = 40.0});
    scene.bodies.back().rolling_friction = 0.02;
    scene.bodies.back().spinning_friction = 0.001;
    World world(scene);
    run(world, scene, 8.0);
    EXPECT_TRUE(world.snapshot().bodies.back().asleep);
}

}  // namespace tumble::rolling_path_test
