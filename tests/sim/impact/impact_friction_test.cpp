// Coulomb friction within an impact: closed forms for a ball, no gain of energy for other shapes.
#include "sim/impact_scenes.h"

#include <gtest/gtest.h>

namespace tumble::impact_friction_test {
using namespace tumble::testing;

namespace {

constexpr ImpactLaw laws[] = {ImpactLaw::propagating, ImpactLaw::simultaneous};

ImpactScene falling_ball(double e, double mu, const Vec3& velocity, const Vec3& spin) {
    ImpactScene s;
    s.restitution = e;
    s.friction = mu;
    s.add_floor();
    s.set_spin(s.add_ball(2.0, Vec3(0, 0.5, 0), velocity), spin);
    s.touch(0, 1, Vec3::UnitY(), {Vec3::Zero()});
    return s;
}

}  // namespace

// A solid ball: an impulse J across gives the contact point 7/2 J/m. It slides through the impact when mu (1+e) v_n is
// below 2/7 of the slip, otherwise it leaves rolling: Delta v_t = min of the two, against the slip.
TEST(BallWithSpin, SlidesOrSticks) {
    Random random(151);
    int slid = 0, stuck = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const double e = random(0.0, 1.0), mu = random(0.0, 0.5);
        const Vec3 velocity(random(-3, 3), random(-3, -0.1), random(-3, 3)), spin = random.vector(6.0);
        ImpactScene s = falling_ball(e, mu, velocity, spin);
        s.resolve(laws[trial % 2]);
        Vec3 slip = velocity + spin.cross(Vec3(0, -0.5, 0));
        slip.y() = 0.0;
        const double limit = mu * (1.0 + e) * -velocity.y(), full = slip.norm() * 2.0 / 7.0;
        (limit < full ? slid : stuck)++;
        const Vec3 change = -std::min(limit, full) * slip.normalized();
        const Vec3 expected = Vec3(velocity.x(), -e * velocity.y(), velocity.z()) + change;
        EXPECT_LT((s.bodies[1].velocity - expected).norm(), 1e-13);
        const Vec3 turned = spin + Vec3(0, -0.5, 0).cross(2.0 * change) / (0.4 * 2.0 * 0.25);
        EXPECT_LT((s.bodies[1].angular_velocity - turned).norm(), 1e-12);
        EXPECT_LE(s.contacts[0].impact_friction.norm(), mu * s.contacts[0].impact * (1.0 + 1e-15));
        EXPECT_EQ(s.contacts[0].impact_friction.y(), 0.0);
    }
    EXPECT_GT(slid, 100);
    EXPECT_GT(stuck, 100);
}

// Friction only brings the slip to zero; it does not reverse it as in a superball.
TEST(BallWithSpin, IsNotASuperball) {
    ImpactScene s = falling_ball(1.0, 10.0, Vec3(2, -3, 0), Vec3::Zero());
    s.resolve(ImpactLaw::propagating);
    EXPECT_NEAR(s.bodies[1].velocity.x(), 2.0 * 5.0 / 7.0, 1e-14);
    const Vec3 point = s.bodies[1].point_velocity(Vec3(0, -0.5, 0));
    EXPECT_NEAR(point.x(), 0.0, 1e-14);
    EXPECT_NEAR(point.y(), 3.0, 1e-14);
}

// Two balls with friction between them keep the sum of momenta.
TEST(TwoBalls, KeepMomentum) {
    Random random(152);
    for (int trial = 0; trial < 200; ++trial) {
        ImpactScene s;
        s.restitution = random(0, 1);
        s.friction = random(0, 1);
        s.add_ball(random(0.5, 5), Vec3::Zero(), random.vector(1.0) + Vec3(2, 0, 0));
        s.add_ball(random(0.5, 5), Vec3::UnitX(), random.vector(1.0));
        s.set_spin(0, random.vector(5.0));
        s.touch_balls(0, 1);
        const Totals before = totals(s.bodies);
        s.resolve(laws[trial % 2]);
        const Totals after = totals(s.bodies);
        EXPECT_LT((after.momentum - before.momentum).norm(), 1e-14 * 20);
        EXPECT_LT((after.angular - before.angular).norm(), 1e-14 * 20);
        EXPECT_LT(after.kinetic, before.kinetic * (1.0 + 1e-15));
    }
}

// A box that lands flat and slides: the first round takes mu (1+e) v_n off its speed (or all of it), without rotation
// about the vertical; later rounds handle the tipping by friction's torque.
TEST(FlatBox, IsSlowedStraight) {
    ImpactScene s;
    s.restitution = 0.0;
    s.friction = 0.2;
    s.add_floor();
    s.add_box(2.0, {2.0, 0.02, 2.0}, {0, 0.01, 0}, {3.0, -1.0, 0.0});
    s.touch_flat(0, 1, 0.0, 1.0, 1.0);
    s.resolve(ImpactLaw::propagating);
    EXPECT_NEAR(s.bodies[1].velocity.x(), 3.0 - 0.2, 0.01);
    EXPECT_NEAR(s.bodies[1].velocity.z(), 0.0, 1e-12);
    EXPECT_NEAR(s.bodies[1].angular_velocity.y(), 0.0, 1e-12);
    EXPECT_LT(s.approach(), 1e-12);
}

// Newton's restitution with Coulomb's friction may gain energy where the slip reverses within the impact (Kane and
// Levinson's pendulum): a rod that meets the floor at an angle.
TEST(Rod, GainsNothing) {
    Random random(153);
    for (int trial = 0; trial < 3000; ++trial) {
        ImpactScene s;
        s.restitution = random(0.3, 1.0);
        s.friction = random(0.0, 2.0);
        s.add_floor();
        const double angle = random(0.05, 1.5), half = 0.5;
        const Vec3 arm(-half * std::cos(angle), -half * std::sin(angle), 0.0);
        s.set_spin(s.add(BodyType::dynamic, 1.0, Vec3(1e-4, 1.0, 1.0) / 12.0, -arm,
                         Vec3(random(-5, 5), random(-3, 0), random(-1, 1))),
                   random.vector(8.0));
        s.touch(0, 1, Vec3::UnitY(), {Vec3::Zero()});
        const double before = s.kinetic();
        s.resolve(laws[trial % 2]);
        EXPECT_LT(s.kinetic(), before * (1.0 + 4e-15)) << trial;
        EXPECT_LT(s.approach(), 1e-11) << trial;
        const Contact& c = s.contacts[0];
        EXPECT_LE(c.impact_friction.norm(), c.friction * c.impact * (1.0 + 1e-14));
        EXPECT_LT(std::abs(c.impact_friction.y()), 1e-14);
    }
}

TEST(Random, ClustersGainNothing) {
    Random random(154);
    for (int trial = 0; trial < 400; ++trial) {
        ImpactScene s = random_impact(random, trial % 3 ? 0.5 : 3.0, 0.0, 1.0, random(0.0, 1.5));
        const double before = s.kinetic();
        const Totals start = totals(s.bodies);
        s.resolve(laws[trial % 2]);
        EXPECT_LT(s.kinetic(), before * (1.0 + 5e-15)) << trial;
        EXPECT_LT(s.approach(), 1e-9) << trial;
        for (const Contact& c : s.contacts) {
            EXPECT_GE(c.impact, 0.0);
            EXPECT_LE(c.impact_friction.norm(), c.friction * c.impact * (1.0 + 1e-12));
        }
        if (!s.bodies[0].dynamic()) continue;
        double size = 0.0;
        for (const Body& b : s.bodies) size += b.mass;
        EXPECT_LT((totals(s.bodies).momentum - start.momentum).norm(), 1e-13 * size);
    }
}

// A moving belt carries the ball along.
TEST(Kinematic, BeltCarriesTheBallAlong) {
    ImpactScene s;
    s.restitution = 0.0;
    s.friction = 5.0;
    const auto belt = s.add(BodyType::kinematic, 0.0, Vec3::Zero(), Vec3::Zero(), Vec3(2, 0, 0));
    s.add_ball(1.0, Vec3(0, 0.5, 0), Vec3(0, -1, 0));
    s.touch(belt, 1, Vec3::UnitY(), {Vec3::Zero()});
    s.resolve(ImpactLaw::propagating);
    EXPECT_NEAR(s.bodies[1].velocity.x(), 2.0 * 2.0 / 7.0, 1e-14);
    EXPECT_NEAR(s.bodies[1].point_velocity(Vec3(0, -0.5, 0)).x(), 2.0, 1e-14);
}

}  // namespace tumble::impact_friction_test
