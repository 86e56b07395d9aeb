// Fields and forces between bodies against closed forms of mechanics.
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble::fields_test {
using namespace tumble::testing;

namespace {

constexpr double pi = std::numbers::pi;

FieldDescription& add_field(SceneDescription& scene, FieldKind type) {
    FieldDescription field;
    field.type = type;
    field.end = infinity;
    return scene.fields.emplace_back(field);
}

SceneDescription space(IntegratorKind integrator) {
    SceneDescription scene = empty_scene();
    scene.simulation.gravity = Vec3::Zero();
    scene.simulation.integrator = integrator;
    scene.simulation.sleep = false;
    return scene;
}

void run_frames(World& world, int frames) {
    for (int n = 0; n < frames; ++n) world.advance_frame();
}

Vec3 position(const World& world, std::size_t body = 0) { return world.snapshot().bodies[body].center_of_mass; }
Vec3 velocity(const World& world, std::size_t body = 0) { return world.snapshot().bodies[body].velocity; }

double total(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential + m.elastic;
}

constexpr double mu = 2.5, axis = 1.0, eccentricity = 0.6;
const double period = 2.0 * pi * std::sqrt(axis * axis * axis / mu);

/// At the perihelion of an ellipse about `center`; a frame lasts an n-th of the period.
SceneDescription ellipse(IntegratorKind integrator, int frames, const Vec3& center) {
    SceneDescription scene = space(integrator);
    scene.output.fps = frames / period;
    const double near = axis * (1.0 - eccentricity);
    BodyDescription& moon = add_sphere(scene, 0.01, center + Vec3(near, 0.0, 0.0), 3.0);
    moon.velocity = {0.0, std::sqrt(mu * (2.0 / near - 1.0 / axis)), 0.0};
    FieldDescription& sun = add_field(scene, FieldKind::point);
    sun.center = center;
    sun.strength = mu;
    return scene;
}

TEST(Fields, AnEllipseClosesAfterItsPeriod) {
    const Vec3 center(3.0, -2.0, 1.0);
    SceneDescription scene = ellipse(IntegratorKind::exact, 64, center);
    World world(scene);
    world.record_energy();
    const Vec3 at = position(world), v = velocity(world);
    const double energy = total(world);
    EXPECT_NEAR(energy, -3.0 * mu / (2.0 * axis), 1e-13);
    run_frames(world, 3 * 64);
    EXPECT_LT((position(world) - at).norm(), 1e-10);
    EXPECT_LT((velocity(world) - v).norm(), 1e-10);
    EXPECT_NEAR(total(world), energy, 1e-12);
    EXPECT_NEAR(world.contact_records().energy.work, 0.0, 1e-11);
    // The perihelion does not turn: e = v x L / mu - r / |r|.
    const Vec3 r = position(world) - center, u = velocity(world);
    EXPECT_LT((u.cross(r.cross(u)) / mu - r.normalized() - Vec3(eccentricity, 0.0, 0.0)).norm(), 1e-10);
}

// Errors at the aphelion with half the step are 2, 4 and 16 times less.
TEST(Fields, IntegratorsKeepTheirOrder) {
    const auto error = [&](IntegratorKind integrator, int steps) {
        SceneDescription scene = ellipse(integrator, 60, Vec3::Zero());
        scene.simulation.steps_per_frame = steps;
        World world(scene);
        run_frames(world, 30);
        return (position(world) - Vec3(-axis * (1.0 + eccentricity), 0.0, 0.0)).norm();
    };
    for (const auto& [integrator, order] : {std::pair(IntegratorKind::explicit_euler, 1.0),
                                            {IntegratorKind::symplectic_euler, 1.0},
                                            {IntegratorKind::splitting, 2.0},
                                            {IntegratorKind::runge_kutta_4, 4.0}})
        EXPECT_NEAR(std::log2(error(integrator, 32) / error(integrator, 64)), order, 0.3) << int(integrator);
}

// Both bodies of a pair turn about their common center, at 2 pi sqrt(a^3 / (G (m1 + m2))).
TEST(Fields, TwoBodiesTurnAboutTheirCenter) {
    for (const auto& [integrator, bound] : {std::pair(IntegratorKind::exact, 1e-10),
                                            {IntegratorKind::runge_kutta_4, 1e-6},
                                            {IntegratorKind::splitting, 5e-3}}) {
        constexpr double first = 2.0, second = 5.0, strength = 0.7;
        SceneDescription scene = space(integrator);
        scene.output.fps = 64.0 / (2.0 * pi * std::sqrt(1.0 / (strength * (first + second))));
        const double speed = std::sqrt(strength * (first + second) * (2.0 / (1.0 - eccentricity) - 1.0));
        const double distance = 1.0 - eccentricity, share = second / (first + second);
        add_sphere(scene, 0.01, {-share * distance, 0.0, 0.0}, first).velocity = {0.0, -share * speed, 0.0};
        add_sphere(scene, 0.01, {(1.0 - share) * distance, 0.0, 0.0}, second).velocity = {0.0, (1.0 - share) * speed,
                                                                                          0.0};
        add_pair_force(scene, PairForceKind::gravity, strength, {0, 1});
        World world(scene);
        world.record_energy();
        const Vec3 at[2] = {position(world, 0), position(world, 1)};
        run_frames(world, 64);
        for (const std::size_t body : {0, 1}) EXPECT_LT((position(world, body) - at[body]).norm(), bound);
        EXPECT_NEAR(total(world), -0.5 * strength * first * second, bound);
        EXPECT_LT(world.measure().momentum.norm(), 1e-14);
        EXPECT_NEAR(world.contact_records().energy.work, 0.0, std::max(1e-10, bound));
    }
}

// Three bodies on the figure of eight (Chenciner and Montgomery 2000; initial values of C. Simo).
TEST(Fields, ThreeBodiesFollowTheFigureOfEight) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = space(IntegratorKind::exact);
        scene.simulation.impacts = mode;
        scene.output.fps = 100.0 / 6.32591398292621;
        const Vec3 at(0.97000435669734, -0.24308753153583, 0.0), speed(-0.93240737144104, -0.86473146092102, 0.0);
        add_sphere(scene, 0.01, at, 1.0).velocity = -0.5 * speed;
        add_sphere(scene, 0.01, -at, 1.0).velocity = -0.5 * speed;
        add_sphere(scene, 0.01, Vec3::Zero(), 1.0).velocity = speed;
        add_pair_force(scene, PairForceKind::gravity, 1.0, {0, 1, 2});
        World world(scene);
        run_frames(world, 100);
        EXPECT_LT((position(world, 0) - at).norm(), 1e-9);
        EXPECT_LT((position(world, 1) + at).norm(), 1e-9);
        EXPECT_LT(position(world, 2).norm(), 1e-9);
    }
}

// v = v_t tanh(g t / v_t), v_t = sqrt(m g / k); and (m g / c)(1 - exp(-c t / m)).
TEST(Fields, FallingBodiesReachTheirTerminalSpeed) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact})
        for (const bool quadratic : {false, true}) {
            constexpr double g = 9.81, mass = 2.0, k = 3.0;
            SceneDescription scene = space(IntegratorKind::exact);
            scene.simulation.gravity = {0.0, -g, 0.0};
            scene.simulation.impacts = mode;
            add_sphere(scene, 0.1, Vec3::Zero(), mass);
            (quadratic ? add_field(scene, FieldKind::drag).quadratic : add_field(scene, FieldKind::drag).linear) = k;
            World world(scene);
            run_frames(world, 30);
            const double last = std::sqrt(mass * g / k);
            EXPECT_NEAR(-velocity(world).y(),
                        quadratic ? last * std::tanh(0.5 * g / last) : mass * g / k * (1.0 - std::exp(-0.5 * k / mass)),
                        1e-10);
        }
}

// Two masses on a spring: 2 pi sqrt(m / k) of the reduced mass, and a damper takes energy.
TEST(Fields, ASpringBetweenBodiesSwings) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = space(IntegratorKind::exact);
        scene.simulation.impacts = mode;
        add_sphere(scene, 0.1, {-1.0, 0.0, 0.0}, 1.0);
        add_sphere(scene, 0.1, {1.0, 0.0, 0.0}, 3.0);
        PairForceDescription& spring = add_pair_force(scene, PairForceKind::spring, 0.0, {0, 1});
        spring.length = 1.5;
        spring.stiffness = 40.0;
        scene.output.fps = 32.0 / (2.0 * pi * std::sqrt(0.75 / spring.stiffness));
        World world(scene);
        const double energy = total(world);
        EXPECT_NEAR(energy, 0.5 * 40.0 * 0.25, 1e-13);
        run_frames(world, 16);
        EXPECT_NEAR((position(world, 1) - position(world, 0)).x(), 1.0, 1e-11);
        EXPECT_NEAR(total(world), energy, 1e-12);
    }
}

// tan(theta / 2) = k q1 q2 / (m v^2 b), from far away.
TEST(Fields, AChargeIsScatteredByRutherfordsAngle) {
    SceneDescription scene = space(IntegratorKind::exact);
    constexpr double far = 400.0, b = 0.5, speed = 40.0;
    BodyDescription& nucleus = add_sphere(scene, 0.01, Vec3::Zero());
    nucleus.type = BodyType::fixed;
    add_sphere(scene, 0.01, {-far, b, 0.0}, 1.0).velocity = {speed, 0.0, 0.0};
    add_pair_force(scene, PairForceKind::coulomb, 1.0, {0, 1}).charges = {20.0, 30.0};
    World world(scene);
    run_frames(world, 60 * 20);
    const Vec3 v = velocity(world, 1);
    EXPECT_NEAR(std::atan2(v.y(), v.x()), 2.0 * std::atan(600.0 / (speed * speed * b)), 5e-3);
}

// In the region and the span alone: the impulse is m a t, and its work is external.
TEST(Fields, RegionsAndSpansBoundAField) {
    for (const IntegratorKind integrator : {IntegratorKind::symplectic_euler, IntegratorKind::exact}) {
        SceneDescription scene = space(integrator);
        add_sphere(scene, 0.1, Vec3::Zero(), 2.0);
        add_sphere(scene, 0.1, {3.0, 0.0, 0.0}, 2.0);
        FieldDescription& wind = add_field(scene, FieldKind::uniform);
        wind.acceleration = {0.0, 2.0, 0.0};
        wind.region.kind = RegionKind::sphere;
        wind.region.radius = 1.0;
        wind.start = 0.1003;
        wind.end = 0.2509;
        World world(scene);
        world.record_energy();
        run_frames(world, 30);
        EXPECT_NEAR(velocity(world, 0).y(), 2.0 * (wind.end - wind.start), 1e-12);
        EXPECT_TRUE(velocity(world, 1).isZero(0.0));
        EXPECT_NEAR(world.contact_records().energy.work, world.measure().kinetic, 1e-3);
    }
}

// On a circle about the axis a vortex accelerates along the way: its power is m s.
TEST(Fields, AVortexDrivesBodiesAround) {
    SceneDescription scene = space(IntegratorKind::exact);
    add_sphere(scene, 0.1, {1.0, 0.0, 0.0}, 2.0);
    FieldDescription& vortex = add_field(scene, FieldKind::vortex);
    vortex.axis = Vec3::UnitZ();
    vortex.strength = 3.0;
    World world(scene);
    world.step();
    const double h = scene.step();
    EXPECT_NEAR(velocity(world).y(), 3.0 * h, 1e-8);
    run_frames(world, 0);
    EXPECT_NEAR(velocity(world).x(), 0.0, 1e-8);
}

// A charge on a table is held there, and lifted by a stronger one: friction and contact know the field.
TEST(Fields, AFieldActsOnBodiesInContact) {
    SceneDescription scene = ground_scene(0.0, 0.5);
    scene.simulation.sleep = true;
    add_box(scene, {0.2, 0.2, 0.2}, {0.0, 0.1, 0.0}, 1.0).friction = 0.5;
    add_field(scene, FieldKind::uniform).acceleration = {4.0, 0.0, 0.0};  // below the friction
    World world(scene);
    run_frames(world, 120);
    EXPECT_LT(position(world, 1).x(), 1e-3);
    EXPECT_TRUE(world.snapshot().bodies[1].asleep);
    scene.fields[0].acceleration = {6.0, 0.0, 0.0};
    World sliding(scene);
    run_frames(sliding, 60);
    EXPECT_NEAR(velocity(sliding, 1).x(), 6.0 - 0.5 * 9.81, 2e-2);
}

}  // namespace
}  // namespace tumble::fields_test
