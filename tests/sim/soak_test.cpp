// Random scenes of every kind of body: the state stays finite, nothing sinks into the ground, energy does not grow.
// "Scale" is the bodies' weight times one meter plus their first kinetic energy.
//
// Allowed growth of energy in a frame, and its cause:
// - without restitution: lifting by the position correction of overlaps (measured: up to 4e-5); the solver itself only
//   removes energy;
// - with restitution: the step's own error, g h v per bounce and that of a fast spin's rotation by h omega (measured
//   over 16 times 40 scenes: up to 4e-3 at 16 steps per frame, 1e-4 at 64);
// - with restitution and friction together Newton's law of restitution itself can gain energy (Kane and Levinson 1985):
//   see the bound there.
#include "random_scenes.h"

#include <gtest/gtest.h>

namespace tumble::soak_test {
using namespace tumble::testing;

namespace {

struct Findings {
    double growth = 0.0;       // largest in a frame, of the scale
    double sunk = 0.0;         // m, lowest point below the ground at the end, per body size
    double penetration = 0.0;  // m
};

Findings soak(const SceneDescription& scene, double seconds) {
    World world(scene);
    const Measurement start = world.measure();
    EXPECT_EQ(start.max_penetration, 0.0) << "the scene starts with overlaps";
    const double scale = energy_scale(scene, world);
    double before = start.kinetic + start.potential;
    Findings f;
    for (int frame = 0; frame < int(seconds * scene.output.fps); ++frame) {
        world.advance_frame();
        const Measurement m = world.measure();
        EXPECT_TRUE(std::isfinite(m.kinetic + m.potential));
        f.growth = std::max(f.growth, (m.kinetic + m.potential - before) / scale);
        f.penetration = std::max(f.penetration, m.max_penetration);
        before = m.kinetic + m.potential;
    }
    const Snapshot end = world.snapshot();
    for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
        EXPECT_TRUE(end.bodies[i].origin.allFinite() && end.bodies[i].orientation.coeffs().allFinite());
        if (scene.bodies[i].type == BodyType::dynamic)
            f.sunk = std::max(f.sunk, -lowest_point(scene.bodies[i], end.bodies[i]));
    }
    return f;
}

void soak_many(std::uint64_t seed, int scenes, const SceneKind& kind, double growth, double sunk) {
    double most_growth = 0.0, most_sunk = 0.0;
    for (int i = 0; i < trials(scenes); ++i) {
        Random random(seed + std::uint64_t(i));
        SceneKind k = kind;
        k.bodies = 4 + (7 * i) % 24;
        const Findings f = soak(random_scene(random, k), 0.5);
        EXPECT_LT(f.growth, growth) << "scene " << i;
        EXPECT_LT(f.sunk, sunk) << "scene " << i;
        most_growth = std::max(most_growth, f.growth);
        most_sunk = std::max(most_sunk, f.sunk);
    }
    ::testing::Test::RecordProperty("growth", std::to_string(most_growth));
    ::testing::Test::RecordProperty("sunk", std::to_string(most_sunk));
}

}  // namespace

// The smallest bodies are 0.4 m across: 5 % of that is 0.02 m.
constexpr double five_percent = 0.02;

TEST(Soak, InelasticWithFriction) {
    SceneKind kind;
    kind.restitution_high = 0.0;
    soak_many(1000, 40, kind, 1e-4, five_percent);
}

TEST(Soak, AnyRestitutionWithoutFriction) {
    SceneKind kind;
    kind.friction_high = 0.0;
    soak_many(2000, 40, kind, 5e-3, five_percent);
}

TEST(Soak, ElasticWithoutFriction) {
    SceneKind kind;
    kind.friction_high = 0.0;
    kind.restitution_low = 1.0;
    kind.heaviest = 4.0;  // heavy bodies spin light ones up to half a radian per step
    kind.steps_per_frame = 32;
    soak_many(3000, 20, kind, 5e-3, five_percent);
}

TEST(Soak, AnyRestitutionAndFriction) { soak_many(4000, 40, {}, 5e-2, five_percent); }

// Large steps and fast bodies: coarse, but nothing tunnels through the ground or explodes.
TEST(Soak, CoarseStepsAndFastBodies) {
    SceneKind kind;
    kind.steps_per_frame = 2;
    kind.speed = 12.0;
    kind.spin = 20.0;
    kind.restitution_high = 0.4;
    kind.friction_high = 0.0;
    soak_many(5000, 20, kind, 0.2, 0.1);
}

// A kinematic press descends on bodies on the ground, stays, and rises again: no squeezed body is thrown faster than
// the press could throw it.
TEST(Soak, SqueezedBodiesAreNotShotAway) {
    for (const double e : {0.0, 0.3, 0.5, 1.0})
        for (const double friction : {0.0, 0.5})
            for (const bool ball : {false, true}) {
                SceneDescription scene = ground_scene(e, friction);
                BodyDescription& body =
                    ball ? add_sphere(scene, 0.5, {0.0, 0.5, 0.0}) : add_box(scene, {1, 1, 1}, {0.0, 0.5, 0.0});
                body.restitution = e;
                body.friction = friction;
                BodyDescription& press = add_box(scene, {2.0, 0.5, 2.0}, {0.0, 2.0, 0.0});
                press.type = BodyType::kinematic;
                press.mass.reset();
                press.restitution = e;
                press.friction = friction;
                press.interpolation = Interpolation::linear;
                press.keyframes = {{0.0, Vec3(0, 1.35, 0), Quat::Identity()},
                                   {0.15, Vec3(0, 1.2, 0), Quat::Identity()},
                                   {0.3, Vec3(0, 1.2, 0), Quat::Identity()},
                                   {0.5, Vec3(0, 2.0, 0), Quat::Identity()}};
                World world(scene);
                double fastest = 0.0;
                for (int step = 0; step < 16 * 60; ++step) {
                    world.step();
                    fastest = std::max(fastest, world.snapshot().bodies[1].velocity.norm());
                }
                EXPECT_LT(fastest, 10.0) << "e " << e << " friction " << friction << (ball ? " ball" : " box");
            }
}

// Bodies that overlap at the start separate at the speed of the position correction, not explosively.
TEST(Soak, OverlapsAtTheStartDissolve) {
    Random random(6000);
    for (int trial = 0; trial < trials(10); ++trial) {
        SceneDescription scene = ground_scene(0.0, 0.5);
        for (int i = 0; i < 8; ++i) {
            const Vec3 at(random(-0.2, 0.2), 0.6 + 0.25 * i, random(-0.2, 0.2));
            BodyDescription& body = i % 3 == 0   ? add_sphere(scene, 0.3, at)
                                    : i % 3 == 1 ? add_box(scene, {0.5, 0.6, 0.4}, at)
                                                 : add_body(scene, MeshShape{random_mesh(random, 20, 0.35)}, at);
            body.mass = 1.0;
            body.restitution = 0.0;
            body.friction = 0.5;
            body.rotation = random.turn();
        }
        World world(scene);
        EXPECT_GT(world.measure().max_penetration, 0.02);
        double fastest = 0.0;
        for (int frame = 0; frame < 120; ++frame) {
            world.advance_frame();
            for (const BodyState& b : world.snapshot().bodies) fastest = std::max(fastest, b.velocity.norm());
        }
        EXPECT_LT(fastest, 9.0) << trial;  // falling from the heap's top: 6.3 m/s
        EXPECT_LT(world.measure().max_penetration, 2e-3) << trial;
    }
}

}  // namespace tumble::soak_test
