// Keys of bodies: the weight, the center of mass and the inertia that they are given, layers, and parts that nothing
// touches.
#include "support/compounds.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::body_keys_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

double energy(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential;
}

CompoundShape dumbbell(bool second_collides) {
    std::vector<CompoundPart> parts(2);
    for (const int k : {0, 1}) {
        parts[std::size_t(k)].shape = SphereShape{0.2};
        parts[std::size_t(k)].position = {0.0, k == 0 ? 0.0 : -1.0, 0.0};
    }
    parts[1].collide = second_collides;
    return {std::make_shared<const std::vector<CompoundPart>>(parts)};
}

}  // namespace

TEST(GravityScale, ScalesTheFallOfEachBody) {
    for (const ImpactMode impacts : {ImpactMode::stepped, ImpactMode::exact})
        for (const IntegratorKind integrator :
             {IntegratorKind::symplectic_euler, IntegratorKind::explicit_euler, IntegratorKind::splitting,
              IntegratorKind::runge_kutta_4, IntegratorKind::exact}) {
            SceneDescription scene;
            scene.simulation.impacts = impacts;
            scene.simulation.integrator = integrator;
            for (const double scale : {1.0, 0.0, -0.5, 0.165})
                add_sphere(scene, 0.1, {double(scene.bodies.size()), 10.0, 0.0}).gravity_scale = scale;
            World world(scene);
            const double start = energy(world);
            run(world, scene, 1.0);
            const auto bodies = world.snapshot().bodies;
            for (std::size_t i = 0; i < 4; ++i)
                EXPECT_NEAR(bodies[i].velocity.y(), -g * scene.bodies[i].gravity_scale, 1e-9);
            EXPECT_EQ(bodies[1].origin, scene.bodies[1].position);
            EXPECT_NEAR(energy(world), start, 0.02 * g) << "the potential energy has the scaled weight";
        }
}

TEST(GravityScale, ABalloonRestsUnderACeiling) {
    SceneDescription scene;
    BodyDescription& ceiling = add_body(scene, BoxShape{{4.0, 1.0, 4.0}}, {0.0, 2.5, 0.0});
    ceiling.type = BodyType::fixed;
    add_sphere(scene, 0.25, {0.0, 1.0, 0.0}).gravity_scale = -0.2;
    World world(scene);
    run(world, scene, 5.0);
    EXPECT_NEAR(world.snapshot().bodies[1].origin.y(), 1.75, 1e-3);
    EXPECT_TRUE(world.snapshot().bodies[1].asleep);
}

TEST(GravityScale, TheLedgerIsClosed) {
    for (const ImpactMode impacts : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = ground_scene(0.5, 0.3);
        scene.simulation.impacts = impacts;
        scene.simulation.integrator = IntegratorKind::exact;
        add_box(scene, {0.3, 0.2, 0.4}, {0.0, 1.0, 0.0}).gravity_scale = 0.4;
        scene.bodies[1].velocity = {1.0, 0.0, 0.0};
        World world(scene);
        world.record_energy();
        const double start = energy(world);
        run(world, scene, 2.0);
        const EnergyLedger e = world.contact_records().energy;
        EXPECT_NEAR(energy(world), start + e.work - e.friction_loss - e.impact_loss, 1e-9 * g);
    }
}

// In flight, by joint coordinates and by rows: the period of a pendulum grows by the root of the scale.
TEST(GravityScale, APendulumSwingsSlower) {
    const auto turned = [](double scale, double seconds, IntegratorKind integrator) {
        SceneDescription scene;
        scene.simulation.integrator = integrator;
        add_box(scene, {1.0, 0.1, 0.1}, {0.5, 0.0, 0.0}).gravity_scale = scale;
        JointDescription hinge;
        hinge.name = "hinge";
        hinge.type = JointType::hinge;
        hinge.first = std::nullopt;
        hinge.second = 0;
        hinge.anchor_second = {-0.5, 0.0, 0.0};
        hinge.frame_first = hinge.frame_second = turn(Vec3::UnitY(), -0.5 * pi);
        hinge.turn[0].motion = JointAxis::Motion::free;
        scene.joints.push_back(hinge);
        World world(scene);
        run(world, scene, seconds);
        return world.snapshot().bodies[0].origin;
    };
    for (const IntegratorKind integrator : {IntegratorKind::symplectic_euler, IntegratorKind::exact})
        EXPECT_LT((turned(0.25, 2.0, integrator) - turned(1.0, 1.0, integrator)).norm(), 5e-3);
}

TEST(GivenInertia, ReplacesThatOfTheShape) {
    SceneDescription scene = empty_scene();
    BodyDescription& body = add_box(scene, {1.0, 1.0, 1.0}, Vec3::Zero(), 2.0);
    body.center_of_mass = Vec3(0.1, 0.0, 0.0);
    body.inertia = {2.0, 3.0, 4.0, 0.1, 0.2, 0.3};
    const BodyReport report = World(scene).report(0);
    Mat3 tensor;
    tensor << 2.0, 0.1, 0.2, 0.1, 3.0, 0.3, 0.2, 0.3, 4.0;
    EXPECT_EQ(report.inertia, tensor);
    EXPECT_EQ(report.center_of_mass, Vec3(0.1, 0.0, 0.0));
    EXPECT_EQ(report.mass, 2.0);
}

// The Dzhanibekov effect of a ball: by its moments alone.
TEST(GivenInertia, ABallFlipsAboutItsMiddleAxis) {
    SceneDescription scene = empty_scene();
    scene.simulation.integrator = IntegratorKind::exact;
    BodyDescription& ball = add_sphere(scene, 0.5, Vec3::Zero());
    ball.inertia = {0.1, 0.15, 0.2, 0.0, 0.0, 0.0};
    ball.angular_velocity = {0.01, 5.0, 0.0};
    World world(scene);
    double lowest = 1.0;
    for (int frame = 0; frame < 600; ++frame) {
        world.advance_frame();
        lowest = std::min(lowest, (world.snapshot().bodies[0].orientation * Vec3::UnitY()).y());
    }
    EXPECT_LT(lowest, -0.9);
}

// A ball whose center of mass lies below its middle stands up.
TEST(GivenInertia, AWeebleStandsUp) {
    SceneDescription scene = ground_scene(0.0, 0.5);
    BodyDescription& weeble = add_sphere(scene, 0.5, {0.0, 0.5, 0.0});
    weeble.center_of_mass = Vec3(0.0, -0.2, 0.0);
    weeble.rotation = turn(Vec3::UnitX(), 1.0);
    weeble.rolling_friction = 0.05;
    World world(scene);
    run(world, scene, 6.0);
    const BodyState end = world.snapshot().bodies[1];
    EXPECT_GT((end.orientation * Vec3::UnitY()).y(), 0.99);
    EXPECT_NEAR(end.origin.y(), 0.5, 1e-3);
}

TEST(Layers, BodiesPassThroughThoseOfOtherLayers) {
    for (const ImpactMode impacts : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = ground_scene(0.0, 0.5);
        scene.simulation.impacts = impacts;
        scene.bodies[0].layers = {"ground"};
        BodyDescription& shelf = add_body(scene, BoxShape{{8.0, 0.2, 2.0}}, {0.0, 1.0, 0.0});
        shelf.type = BodyType::fixed;
        shelf.layers = {"shelf", "wood"};
        const auto add = [&](double x) -> BodyDescription& { return add_sphere(scene, 0.1, {x, 2.0, 0.0}); };
        add(-3.0);                                                            // all
        add(-2.0).collide_with = std::vector<std::string>{"ground"};          // through the shelf
        add(-1.0).collide_with = std::vector<std::string>{"wood", "ground"};  // one of its layers is enough
        add(0.0).collide_with = std::vector<std::string>{};                   // through all
        BodyDescription& refused = add(1.0);                                  // the shelf below refuses it
        refused.layers = {"ghost"};
        scene.bodies[1].collide_with = std::vector<std::string>{"ghost", "none"};
        World world(scene);
        run(world, scene, 1.5);
        const auto y = [&](std::size_t i) { return world.snapshot().bodies[i].origin.y(); };
        EXPECT_NEAR(y(2), 0.1, 1e-3) << "the shelf collides with ghosts alone";
        EXPECT_NEAR(y(3), 0.1, 1e-3);
        EXPECT_NEAR(y(4), 0.1, 1e-3);
        EXPECT_LT(y(5), -5.0);
        EXPECT_NEAR(y(6), 1.2, 1e-3);
        scene.bodies[1].collide_with.reset();
        World open(scene);
        run(open, scene, 1.5);
        EXPECT_NEAR(open.snapshot().bodies[2].origin.y(), 1.2, 1e-3);
        EXPECT_NEAR(open.snapshot().bodies[3].origin.y(), 0.1, 1e-3);
        EXPECT_NEAR(open.snapshot().bodies[4].origin.y(), 1.2, 1e-3);
    }
}

TEST(Layers, JointsStillKeepTheirBodiesApart) {
    SceneDescription scene = empty_scene();
    for (const double x : {0.0, 0.3}) add_sphere(scene, 0.2, {x, 0.0, 0.0}).layers = {"a"};
    JointDescription weld;
    weld.name = "weld";
    weld.first = 0;
    weld.second = 1;
    weld.anchor_first = {0.3, 0.0, 0.0};
    scene.joints.push_back(weld);
    EXPECT_TRUE(World(scene).overlaps().empty());
    scene.joints.clear();
    EXPECT_EQ(World(scene).overlaps().size(), 1u);
    scene.bodies[0].collide_with = std::vector<std::string>{};
    EXPECT_TRUE(World(scene).overlaps().empty());
}

TEST(Parts, NothingTouchesAPartThatDoesNotCollide) {
    SceneDescription scene = ground_scene(0.0, 0.5);
    add_body(scene, dumbbell(false), {0.0, 1.5, 0.0}).restitution = 0.0;
    add_body(scene, dumbbell(true), {2.0, 1.5, 0.0}).restitution = 0.0;
    World world(scene);
    EXPECT_EQ(world.report(1).mass, world.report(2).mass);
    EXPECT_EQ(world.report(1).center_of_mass, Vec3(0.0, -0.5, 0.0));
    run(world, scene, 1.5);
    EXPECT_NEAR(world.snapshot().bodies[1].origin.y(), 0.2, 1e-3);
    EXPECT_GT(world.snapshot().bodies[2].origin.y(), 1.0);
}

}  // namespace tumble::body_keys_test
