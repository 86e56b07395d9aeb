// Impacts: eq. 20 on random pairs, bounces, rows of balls, boxes that land flat.
#include "sim/impact/impacts.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace tumble::impact_test {
using namespace tumble::testing;

namespace {

class Random {
public:
    double operator()(double low, double high) { return low + (high - low) * double(engine_() >> 11) * 0x1p-53; }
    Vec3 vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }

private:
    std::mt19937_64 engine_{7};
};

Body random_body(Random& random) {
    Body body;
    body.mass = random(0.1, 10.0);
    body.inverse_mass = 1.0 / body.mass;
    body.rotation = Quat(random(-1, 1), random(-1, 1), random(-1, 1), random(-1, 1)).normalized().toRotationMatrix();
    body.inertia_body = (body.mass * Vec3(random(0.5, 1.0), random(0.5, 1.0), random(0.5, 1.0))).asDiagonal();
    body.inverse_inertia_body = body.inertia_body.inverse();
    body.position = random.vector(3.0);
    body.momentum = random.vector(5.0);
    body.angular_momentum = random.vector(2.0);
    body.radius = 1.0;
    body.derive();
    return body;
}

double kinetic(const Body& b) {
    return 0.5 * (b.momentum.dot(b.velocity) + b.angular_momentum.dot(b.angular_velocity));
}

double largest_energy_error(World& world, int frames) {
    const Measurement start = world.measure();
    double worst = 0.0;
    for (int i = 0; i < frames; ++i) {
        world.advance_frame();
        const Measurement m = world.measure();
        worst = std::max(worst, std::abs(m.kinetic + m.potential - start.kinetic - start.potential));
    }
    return worst;
}

}  // namespace

// The impulse j of eq. 20, by either law. So v_rel+ = -e v_rel- (eq. 14), P and L are kept in sum, and the kinetic
// energy falls by (1 - e^2) v_rel^2 / 2k with k the bracket of eq. 20.
TEST(Impulse, RandomPairsObeyTheNotes) {
    Random random;
    for (int trial = 0; trial < 500; ++trial) {
        std::vector<Body> bodies{random_body(random), random_body(random)};
        Body &a = bodies[0], &b = bodies[1];
        a.restitution = random(0.0, 1.0);
        b.restitution = 0.0;
        Manifold m;
        m.a = 0;
        m.b = 1;
        m.normal = random.vector(1.0).normalized();
        m.count = 1;
        m.points[0].position = 0.5 * (a.position + b.position) + random.vector(0.5);
        std::vector<Contact> contacts;
        make_contacts({m}, bodies, contacts);
        const Contact& c = contacts[0];
        const double before = relative_velocity(c, a, b), energy = kinetic(a) + kinetic(b);
        const Vec3 momentum = a.momentum + b.momentum;
        const Vec3 angular =
            a.position.cross(a.momentum) + a.angular_momentum + b.position.cross(b.momentum) + b.angular_momentum;
        const auto turning = [&](const Body& body, const Vec3& arm) {
            return c.normal.dot((body.inverse_inertia * arm.cross(c.normal)).cross(arm));
        };
        const double k = a.inverse_mass + b.inverse_mass + turning(a, c.arm_a) + turning(b, c.arm_b);
        const double j = before < 0.0 ? -(1.0 + c.restitution) * before / k : 0.0;
        resolve_impacts({{0, 1}, {0}}, contacts, bodies,
                        {.law = trial % 2 ? ImpactLaw::propagating : ImpactLaw::simultaneous});
        EXPECT_NEAR(c.impact, j, 1e-12 * (1.0 + j));
        add_impulse(c, c.impact * c.normal, a, b);
        a.derive();
        b.derive();
        EXPECT_LT((a.momentum + b.momentum - momentum).norm(), 1e-13);
        const Vec3 after =
            a.position.cross(a.momentum) + a.angular_momentum + b.position.cross(b.momentum) + b.angular_momentum;
        EXPECT_LT((after - angular).norm(), 1e-12);
        if (!(before < 0.0)) continue;
        EXPECT_NEAR(relative_velocity(c, a, b), -c.restitution * before, 1e-12 * (1.0 - before));
        const double loss = 0.5 * (1.0 - c.restitution * c.restitution) * before * before / k;
        EXPECT_NEAR(kinetic(a) + kinetic(b), energy - loss, 1e-11 * energy);
    }
}

// SimBenchmark "bouncing" (see ../shared/pitfalls.md): from 5 m, e = 1. The stepped bounce retraces its own fall, so
// the energy error never accumulates: it stays that of one step, g h v.
TEST(Bounce, ElasticBallRetracesItsFall) {
    SceneDescription scene = ground_scene(1.0, 0.0);
    add_sphere(scene, 0.1, {0.0, 5.0, 0.0}, 10.0).restitution = 1.0;
    World world(scene);
    const double one_step = 10.0 * 9.81 * scene.step() * std::sqrt(2.0 * 9.81 * 4.9);
    EXPECT_LT(largest_energy_error(world, 1200), one_step);
}

// From a ceiling, too, it leaves at its bounce speed: gravity, which would accelerate it, would act too early there as
// well.
TEST(Bounce, ElasticBallRetracesItsPathFromTheCeiling) {
    SceneDescription scene = ground_scene(1.0, 0.0);
    BodyDescription& ceiling = add_body(scene, PlaneShape{-Vec3::UnitY(), -2.0}, Vec3::Zero());
    ceiling.type = BodyType::fixed;
    ceiling.restitution = 1.0;
    BodyDescription& ball = add_sphere(scene, 0.1, {0.0, 1.0, 0.0}, 10.0);
    ball.restitution = 1.0;
    ball.velocity = Vec3(0.3, 8.0, 0.0);
    World world(scene);
    const double one_step = 10.0 * 9.81 * scene.step() * std::sqrt(64.0 + 2.0 * 9.81 * 0.9);
    EXPECT_LT(largest_energy_error(world, 1200), one_step);
}

// Height after a bounce: e^2 times the drop (from the lowest point of the ball), within the resolution of a step.
TEST(Bounce, HeightsFollowRestitution) {
    for (const double e : {0.3, 0.5, 0.8}) {
        SceneDescription scene = ground_scene(e, 0.0, 64);
        add_sphere(scene, 0.2, {0.0, 2.2, 0.0}).restitution = 0.1;  // the pair uses the larger restitution
        World world(scene);
        double top = 0.0;
        bool rising = false;
        for (int step = 0; step < 64 * 90; ++step) {
            world.step();
            const BodyState b = world.snapshot().bodies[1];
            if (b.velocity.y() > 0.1) rising = true;
            if (rising && b.velocity.y() <= 0.0) {
                top = b.center_of_mass.y() - 0.2;
                break;
            }
        }
        EXPECT_NEAR(top, e * e * 2.0, 0.01) << e;
    }
}

TEST(Bounce, FixedAndKinematicBodiesAreWalls) {
    for (const auto type : {BodyType::fixed, BodyType::kinematic}) {
        SceneDescription scene = empty_scene(16);
        BodyDescription& wall = add_box(scene, {1.0, 4.0, 4.0}, {2.0, 0.0, 0.0});
        wall.type = type;
        wall.mass.reset();
        BodyDescription& ball = add_sphere(scene, 0.25, Vec3::Zero());
        ball.velocity = Vec3(3.0, 1.0, 0.0);
        ball.restitution = 0.5;
        World world(scene);
        run(world, scene, 1.0);
        EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), -1.5, 1e-12);
        EXPECT_NEAR(world.snapshot().bodies[1].velocity.y(), 1.0, 1e-12);
        EXPECT_EQ(world.snapshot().bodies[0].center_of_mass, Vec3(2.0, 0.0, 0.0));
    }
}

// A row of touching balls, e = 1: the impulse is transmitted (a real cradle), momentum and energy kept.
TEST(Row, CradleTransmitsTheImpulse) {
    for (const int incoming : {1, 2}) {
        SceneDescription scene = empty_scene(16);
        for (int i = 0; i < 5; ++i) {
            BodyDescription& ball = add_sphere(scene, 0.5, Vec3(i < incoming ? i - 1.0 : double(i), 0.0, 0.0));
            ball.restitution = 1.0;
            if (i < incoming) ball.velocity = Vec3(2.0, 0.0, 0.0);
        }
        World world(scene);
        run(world, scene, 2.0);
        const Snapshot s = world.snapshot();
        for (int i = 0; i < 5; ++i)
            EXPECT_NEAR(s.bodies[std::size_t(i)].velocity.x(), i >= 5 - incoming ? 2.0 : 0.0, 1e-12)
                << incoming << " " << i;
    }
}

// One ball between two touching ones (Bernoulli): symmetric, momentum and energy kept.
TEST(Row, BallOnTwoBallsIsSymmetric) {
    SceneDescription scene = empty_scene(16);
    for (const Vec3& at : {Vec3(-3.0, 0.0, 0.0), Vec3(0.0, 0.5, 0.0), Vec3(0.0, -0.5, 0.0)})
        add_sphere(scene, 0.5, at).restitution = 1.0;
    scene.bodies[0].velocity = Vec3(4.0, 0.0, 0.0);
    World world(scene);
    run(world, scene, 2.0);
    const Snapshot s = world.snapshot();
    EXPECT_NEAR(s.bodies[1].velocity.x(), s.bodies[2].velocity.x(), 1e-12);
    EXPECT_NEAR(s.bodies[1].velocity.y(), -s.bodies[2].velocity.y(), 1e-12);
    EXPECT_NEAR(s.bodies[0].velocity.y(), 0.0, 1e-12);
    const Measurement m = world.measure();
    EXPECT_NEAR(m.kinetic, 8.0, 1e-11);
    EXPECT_NEAR(m.momentum.x(), 4.0, 1e-12);
}

TEST(FlatBox, ElasticLandingGivesNoSpin) {
    SceneDescription scene = ground_scene(1.0, 0.0);
    add_box(scene, {1.0, 0.5, 0.8}, {0.0, 1.5, 0.0}).restitution = 1.0;
    World world(scene);
    EXPECT_LT(largest_energy_error(world, 600), 9.81 * scene.step() * std::sqrt(2.0 * 9.81 * 1.25));
    EXPECT_LT(world.snapshot().bodies[1].angular_velocity.norm(), 1e-9);
}

TEST(TiltedBox, ElasticBouncesNeitherGainNorLose) {
    SceneDescription scene = ground_scene(1.0, 0.0, 32);
    BodyDescription& box = add_box(scene, {1.0, 1.0, 1.0}, {0.0, 2.5, 0.0});
    box.restitution = 1.0;
    box.rotation = turn({1.0, 2.0, 3.0}, 0.7);
    World world(scene);
    EXPECT_LT(largest_energy_error(world, 600), 0.01 * 9.81 * 2.5);
}

// At one step per frame it is clamped in nearly every step with an impact, halfway through its rotation: with the
// orientation of free rotation there.
TEST(TiltedBox, WhirlingInARoomWithoutGravityKeepsItsEnergy) {
    SceneDescription scene = empty_scene(1);
    for (const Vec3& normal : {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(0.0, 0.0, 1.0)})
        for (const double sign : {-1.0, 1.0}) {
            BodyDescription& wall = add_body(scene, PlaneShape{sign * normal, -2.0}, Vec3::Zero());
            wall.type = BodyType::fixed;
            wall.restitution = 1.0;
        }
    BodyDescription& box = add_box(scene, {1.0, 0.3, 0.2}, Vec3::Zero());
    box.restitution = 1.0;
    box.velocity = Vec3(3.0, -4.0, 2.0);
    box.angular_velocity = Vec3(5.0, 9.0, 13.0);
    World world(scene);
    const double energy = world.measure().kinetic;
    EXPECT_LT(largest_energy_error(world, 1200), 5e-3 * energy);
}

// Corners with impacts while the box whirls: a step with a bounce rotates it as a free one does. Rotation by the
// tangent would add to its spin in every bounce.
TEST(TiltedBox, WhirlingElasticBouncesGainNothing) {
    Random random;
    for (int trial = 0; trial < 8; ++trial) {
        SceneDescription scene = ground_scene(1.0, 0.0);
        BodyDescription& box =
            add_box(scene, Vec3(random(0.2, 1.0), random(0.2, 1.0), random(0.2, 1.0)), {0.0, 2.0, 0.0});
        box.restitution = 1.0;
        box.rotation = turn(random.vector(1.0), 1.0);
        box.angular_velocity = random.vector(12.0);
        World world(scene);
        const Measurement start = world.measure();
        const double energy = start.kinetic + start.potential;
        double mean =
            0.0;  // over ten seconds: in each flight the energy falls and rises by symplectic Euler's g h v / 2
        for (int frame = 0; frame < 2400; ++frame) {
            world.advance_frame();
            const Measurement m = world.measure();
            if (frame >= 1800) mean += (m.kinetic + m.potential) / 600.0;
        }
        EXPECT_NEAR(mean, energy, 1e-3 * energy) << trial;
    }
}

}  // namespace tumble::impact_test
