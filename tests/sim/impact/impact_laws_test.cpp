// Results of each impact law for many simultaneous contacts, against closed forms and conservation.
#include "sim/impact/settings.h"
#include "sim/impact_scenes.h"

#include <gtest/gtest.h>

namespace tumble::impact_laws_test {
using namespace tumble::testing;

namespace {

constexpr ImpactLaw laws[] = {ImpactLaw::propagating, ImpactLaw::simultaneous};

void expect_speeds(const ImpactScene& s, int axis, const std::vector<double>& speeds, double tolerance = 1e-12) {
    for (std::size_t i = 0; i < speeds.size(); ++i) EXPECT_NEAR(s.bodies[i].velocity[axis], speeds[i], tolerance) << i;
}

}  // namespace

// A real cradle: as many balls leave as arrive.
TEST(Cradle, PropagatingTransmitsTheImpulse) {
    for (const int count : {3, 5})
        for (const int striking : {1, 2}) {
            ImpactScene s = cradle(count, striking, 1.0);
            s.resolve(ImpactLaw::propagating);
            std::vector<double> expected(std::size_t(count), 0.0);
            for (int i = 0; i < striking; ++i) expected[std::size_t(count - 1 - i)] = 1.0;
            expect_speeds(s, 0, expected);
        }
}

// Newton for all contacts at once: the hit contact parts with e, all others stay closed; so the balls on either side of
// it move as two bodies. n balls, k arriving: u = k/n for both sides together, plus and minus the shares of e.
TEST(Cradle, SimultaneousMovesAsTwoBodies) {
    for (const double e : {1.0, 0.5, 0.1})
        for (const int count : {3, 5})
            for (const int striking : {1, 2}) {
                ImpactScene s = cradle(count, striking, e);
                s.resolve(ImpactLaw::simultaneous);
                const double mean = double(striking) / count, rest = count - striking;
                std::vector<double> expected(std::size_t(count), mean + e * striking / count);
                for (int i = 0; i < striking; ++i) expected[std::size_t(i)] = mean - e * rest / count;
                expect_speeds(s, 0, expected);
            }
}

TEST(Cradle, LongRowsLoseNothing) {
    ImpactScene s = cradle(250, 1, 1.0);
    s.resolve(ImpactLaw::propagating);
    std::vector<double> expected(250, 0.0);
    expected.back() = 1.0;
    expect_speeds(s, 0, expected);
    for (const ImpactLaw law : laws) {
        ImpactScene t = cradle(120, 3, 1.0);
        t.resolve(law);
        EXPECT_NEAR(t.kinetic(), 1.5, 1e-13);
        EXPECT_LT(t.approach(), 1e-13);
    }
}

// Binary collisions of three equal balls with e = 1/2: (1 0 0) -> (1/4 3/4 0) -> (1/4 3/16 9/16) -> (13/64 15/64 9/16).
TEST(Cradle, InelasticRowCollidesInTurn) {
    ImpactScene s = cradle(3, 1, 0.5);
    s.resolve(ImpactLaw::propagating);
    expect_speeds(s, 0, {13.0 / 64.0, 15.0 / 64.0, 9.0 / 16.0});
}

// Bernoulli 1734: one ball onto two touching ones, centers at 60 degrees. With j along each line of centers, symmetric:
// ball: 1 - sqrt(3) j, each other: j; stopped at j = (sqrt(3)/2) / (5/2), and 1 + e times that. Under both laws alike.
TEST(Bernoulli, ThreeBalls) {
    for (const ImpactLaw law : laws)
        for (const double e : {1.0, 0.6}) {
            ImpactScene s;
            s.restitution = e;
            const double h = std::sqrt(0.75);
            s.add_ball(1.0, Vec3::Zero(), Vec3::UnitX());
            s.add_ball(1.0, Vec3(h, 0.5, 0), Vec3::Zero());
            s.add_ball(1.0, Vec3(h, -0.5, 0), Vec3::Zero());
            s.touch_balls(0, 1);
            s.touch_balls(0, 2);
            s.touch_balls(1, 2);
            s.resolve(law);
            const double j = (1.0 + e) * h / 2.5;
            expect_speeds(s, 0, {1.0 - 2.0 * h * j, h * j, h * j});
            expect_speeds(s, 1, {0.0, 0.5 * j, -0.5 * j});
        }
}

// One ball on two that stand on the floor: they cannot move down, so they move sideways.
TEST(Bernoulli, OnTheFloor) {
    for (const ImpactLaw law : laws) {
        ImpactScene s;
        const auto floor = s.add_floor();
        s.add_ball(1.0, Vec3(0, 0.5 + std::sqrt(0.75), 0), Vec3(0, -1, 0));
        s.add_ball(1.0, Vec3(0.5, 0.5, 0), Vec3::Zero());
        s.add_ball(1.0, Vec3(-0.5, 0.5, 0), Vec3::Zero());
        s.touch_balls(1, 2);
        s.touch_balls(1, 3);
        s.touch_balls(2, 3);
        s.touch(floor, 2, Vec3::UnitY(), {Vec3(0.5, 0, 0)});
        s.touch(floor, 3, Vec3::UnitY(), {Vec3(-0.5, 0, 0)});
        s.resolve(law);
        EXPECT_NEAR(s.kinetic(), 0.5, 1e-14);
        EXPECT_LT(s.approach(), 1e-14);
        EXPECT_NEAR(s.bodies[2].velocity.x(), -s.bodies[3].velocity.x(), 1e-14);
        EXPECT_NEAR(s.bodies[2].velocity.y(), s.bodies[3].velocity.y(), 1e-14);
        EXPECT_NEAR(s.bodies[1].velocity.x(), 0.0, 1e-14);
        EXPECT_GT(s.bodies[2].velocity.x(), 0.1);
        if (law == ImpactLaw::simultaneous) {  // j at the two upper contacts, the floor holds: 5/2 j = 2 sqrt(3)/2, ...
            const double j = 2.0 * std::sqrt(0.75) / (2.0 * 0.75 + 0.25);
            EXPECT_NEAR(s.bodies[1].velocity.y(), -1.0 + 2.0 * std::sqrt(0.75) * j, 1e-13);
            EXPECT_NEAR(s.bodies[2].velocity.x(), 0.5 * j, 1e-13);
            EXPECT_NEAR(s.bodies[2].velocity.y(), 0.0, 1e-13);
        }
    }
}

TEST(FlatBox, LandsWithoutSpin) {
    for (const ImpactLaw law : laws)
        for (const double e : {1.0, 0.5, 0.0}) {
            ImpactScene s;
            s.restitution = e;
            s.add_floor();
            s.add_box(2.0, {1.0, 0.2, 0.6}, {0, 0.1, 0}, {0.3, -2.0, 0.1});
            s.touch_flat(0, 1, 0.0, 0.5, 0.3);
            s.resolve(law);
            EXPECT_LT((s.bodies[1].velocity - Vec3(0.3, 2.0 * e, 0.1)).norm(), 1e-14);
            EXPECT_LT(s.spin(), 1e-14);
            for (const Contact& c : s.contacts) EXPECT_NEAR(c.impact, (1.0 + e), 1e-14);  // a quarter each
        }
}

// All falling together: under Newton each contact separates at e times its approach, so only the floor's counts.
TEST(Column, OfThree) {
    for (const ImpactLaw law : laws) {
        ImpactScene s;
        const auto floor = s.add_floor();
        for (int i = 0; i < 3; ++i) s.add_ball(1.0, Vec3(0, i + 0.5, 0), Vec3(0, -1, 0));
        s.touch(floor, 1, Vec3::UnitY(), {Vec3::Zero()});
        s.touch_balls(1, 2);
        s.touch_balls(2, 3);
        s.resolve(law);
        expect_speeds(s, 1, {0.0, 1.0, 1.0, 1.0});
    }
}

// A light ball on a heavy one, dropped: propagating, 3 - 4 m / (m + M); simultaneous, both leave with the floor's e.
TEST(Column, LightOnHeavy) {
    for (const double heavy : {1e2, 1e8}) {
        for (const ImpactLaw law : laws) {
            ImpactScene s;
            const auto floor = s.add_floor();
            s.add_ball(heavy, Vec3(0, 0.5, 0), Vec3(0, -1, 0));
            s.add_ball(1.0, Vec3(0, 1.5, 0), Vec3(0, -1, 0));
            s.touch(floor, 1, Vec3::UnitY(), {Vec3::Zero()});
            s.touch_balls(1, 2);
            s.resolve(law);
            const double m = 1.0 / (1.0 + heavy);
            if (law == ImpactLaw::propagating)
                expect_speeds(s, 1, {0.0, 1.0 - 4.0 * m, 3.0 - 4.0 * m});
            else
                expect_speeds(s, 1, {0.0, 1.0, 1.0});
            EXPECT_NEAR(s.kinetic(), 0.5 * (1.0 + heavy), 1e-14 * heavy);
        }
    }
}

// A heavy ball onto a light one on the floor: the number of collisions shows the digits of pi (Galperin 2003, "Playing
// pool with pi"). In mass-weighted velocities each pair of them rotates the plane by 2 theta, theta = atan(sqrt(m/M)).
TEST(Column, HeavyOnLight) {
    const int collisions[] = {3, 31, 314, 3141, 31415};
    double heavy = 1.0;
    for (const int expected : collisions) {
        ImpactScene s;
        const auto floor = s.add_floor();
        s.add_ball(1.0, Vec3(0, 0.5, 0), Vec3::Zero());
        s.add_ball(heavy, Vec3(0, 1.5, 0), Vec3(0, -1, 0));
        s.touch(floor, 1, Vec3::UnitY(), {Vec3::Zero()});
        s.touch_balls(1, 2);
        EXPECT_EQ(s.resolve(ImpactLaw::propagating), expected);
        const double theta = std::atan(std::sqrt(1.0 / heavy));
        EXPECT_NEAR(s.bodies[2].velocity.y(), -std::cos(2.0 * ((expected + 1) / 2) * theta), 1e-11);
        EXPECT_NEAR(s.kinetic() / (0.5 * heavy), 1.0, 1e-12);
        heavy *= 100.0;
    }
}

TEST(Large, RackKeepsItsMirrorImage) {
    for (const ImpactLaw law : laws)
        for (const double e : {1.0, 0.9, 0.5}) {
            ImpactScene s = billiard_rack(e);
            s.resolve(law);
            const auto at = [&](int row, int k) { return s.bodies[std::size_t(1 + row * (row + 1) / 2 + k)].velocity; };
            Vec3 sum = s.bodies[0].velocity;
            for (int row = 0; row < 5; ++row)
                for (int k = 0; k <= row; ++k) {
                    EXPECT_NEAR(at(row, k).x(), -at(row, row - k).x(), 1e-12);
                    EXPECT_NEAR(at(row, k).y(), at(row, row - k).y(), 1e-12);
                    sum += at(row, k);
                }
            EXPECT_LT((sum - Vec3::UnitY()).norm(), 1e-14);
            EXPECT_LE(s.kinetic(), 0.5 * (1.0 + 1e-14));
            EXPECT_NEAR(s.kinetic(), e == 1.0 ? 0.5 : s.kinetic(), 5e-15);
            EXPECT_LT(s.approach(), 1e-12);
        }
}

// Bodies that fall as one rise as one.
TEST(Large, WallsAndStacksRiseAsTheyFell) {
    for (const ImpactLaw law : laws) {
        for (ImpactScene s : {box_stack(12, 1.0), ball_wall(7, 1.0)}) {
            const double before = s.kinetic();
            s.resolve(law);
            for (const Body& b : s.bodies) EXPECT_LT((b.velocity - Vec3(0, b.dynamic() ? 1.0 : 0.0, 0)).norm(), 1e-12);
            EXPECT_LT(s.spin(), 1e-12);
            EXPECT_NEAR(s.kinetic() / before, 1.0, 2e-14);
        }
    }
    for (ImpactScene s : {box_stack(12, 0.5), ball_wall(7, 0.5)}) {
        s.resolve(ImpactLaw::simultaneous);
        for (const Body& b : s.bodies) EXPECT_LT((b.velocity - Vec3(0, b.dynamic() ? 0.5 : 0.0, 0)).norm(), 1e-12);
    }
}

// Without restitution both laws are the same projection.
TEST(Inelastic, IsTheProjection) {
    Random random(141);
    for (int trial = 0; trial < 100; ++trial) {
        ImpactScene s = random_impact(random, 1.0, 0.0, 0.0), t = s;
        s.resolve(ImpactLaw::propagating);
        t.resolve(ImpactLaw::simultaneous);
        double work = 0.0;  // sum of j v_rel+: zero, because a contact with j > 0 stays closed
        for (const Contact& c : s.contacts) work += c.impact * relative_velocity(c, s.bodies[c.a], s.bodies[c.b]);
        EXPECT_NEAR(work, 0.0, 1e-12);
        EXPECT_LT(s.approach(), 1e-12);
        for (std::size_t i = 0; i < s.bodies.size(); ++i) EXPECT_EQ(s.bodies[i].velocity, t.bodies[i].velocity);
    }
}

// Masses of 1 : 1e6, dependent contacts, some clusters jammed.
TEST(Random, ElasticImpactsKeepTheirEnergy) {
    Random random(142);
    for (const ImpactLaw law : laws) {
        int jammed = 0;
        for (int trial = 0; trial < 1500; ++trial) {
            ImpactScene s = random_impact(random, 3.0, 1.0, 1.0);
            const double before = s.kinetic();
            const Totals start = totals(s.bodies);
            s.resolve(law);
            const double ratio = s.kinetic() / before;
            ASSERT_TRUE(std::isfinite(ratio));
            EXPECT_LT(ratio, 1.0 + 5e-15) << trial;
            if (ratio < 1.0 - 5e-15) ++jammed;
            EXPECT_LT(s.approach(), 1e-9) << trial;
            for (const Contact& c : s.contacts) EXPECT_GE(c.impact, 0.0);
            if (!s.bodies[0].dynamic()) continue;
            const Totals end = totals(s.bodies);
            double size = 0.0;
            for (const Body& b : s.bodies) size += b.mass;
            EXPECT_LT((end.momentum - start.momentum).norm(), 1e-13 * size);
            EXPECT_LT((end.angular - start.angular).norm(), 1e-13 * size);
        }
        EXPECT_LT(jammed, 150) << "law " << int(law);
        RecordProperty(law == ImpactLaw::propagating ? "jammed_propagating" : "jammed_simultaneous", jammed);
    }
}

TEST(Random, NoEnergyIsGainedForAnyRestitutions) {
    Random random(143);
    for (const ImpactLaw law : laws)
        for (int trial = 0; trial < 1500; ++trial) {
            ImpactScene s = random_impact(random, trial % 2 ? 3.0 : 0.5, 0.0, 1.0);
            const double before = s.kinetic();
            // The simultaneous law leaves nothing approaching by itself.
            s.resolve(law, law == ImpactLaw::propagating);
            EXPECT_LT(s.kinetic() / before, 1.0 + 5e-15) << trial;
            EXPECT_LT(s.approach(), 1e-9) << trial;
        }
}

// A ball leaves one wall of an acute corner and hits the other, which throws it back at the first: Newton's law for
// both together needs more energy than available.
TEST(Restitution, InAnAcuteCornerGainsNothing) {
    for (const ImpactLaw law : laws)
        for (const double second : {0.0, 1.0})
            for (const double turn : {1.8, 2.2, 2.8}) {
                ImpactScene s;
                const Vec3 towards(std::cos(turn), 0.0, -std::sin(turn));
                s.restitution = 0.0;
                s.add_ball(1.0, Vec3::Zero(), Vec3::UnitX());
                s.restitution = 1.0;
                s.add_floor();
                s.restitution = second;
                s.add_floor();
                s.touch(1, 0, Vec3(-1, 0, 0), {Vec3(0.5, 0, 0)});
                s.touch(2, 0, -towards, {0.5 * towards});
                EXPECT_GE(s.resolve(law, law == ImpactLaw::propagating), 1);
                EXPECT_LT(s.kinetic(), 0.5 * (1.0 + 2e-15)) << turn;
                if (law == ImpactLaw::simultaneous || second == 1.0) {
                    EXPECT_NEAR(s.kinetic(), 0.5, 2e-15);
                }
                EXPECT_LT(s.approach(), 1e-13) << turn;
            }
}

// Passes of more contacts than are projected exactly: the reflection keeps the energy all the same.
TEST(Large, SweepsKeepTheEnergy) {
    Random random(145);
    ImpactScene s = cradle(180, 0, 1.0);
    for (Body& b : s.bodies) {
        b.momentum.x() = random(-1.0, 1.0) - 0.01 * b.position.x();
        b.derive();
    }
    const double before = s.kinetic();
    make_contacts(s.manifolds, s.bodies, s.contacts);
    const Island island = islands_of(s.contacts, s.bodies).front();
    ImpactSystem cluster(island, s.contacts, s.bodies);
    std::size_t approaching = 0;
    for (std::size_t i = 0; i < cluster.size(); ++i) approaching += cluster.approaching(i);
    ASSERT_GT(approaching, tuning::pass_contacts);
    s.resolve(ImpactLaw::propagating);
    EXPECT_NEAR(s.kinetic() / before, 1.0, 1e-13);
    EXPECT_LT(s.approach(), 1e-12);
}

// A needle, inertias 1 : 1e-6, and a plate, hit anywhere on their surface, in any orientation.
TEST(Random, NeedlesAndPlates) {
    Random random(144);
    for (const ImpactLaw law : laws)
        for (int trial = 0; trial < 500; ++trial) {
            ImpactScene s;
            s.add_floor();
            const Vec3 size(1.0, trial % 2 ? 1e-3 : 1.0, 1e-3);
            const auto body = s.add_box(1.0, size, {0, 0.5, 0}, {random(-1, 1), -1.0, random(-1, 1)});
            Body& b = s.bodies[body];
            b.orientation = random.turn();
            b.rotation = b.orientation.toRotationMatrix();
            s.set_spin(body, random.vector(1.0));
            std::vector<Vec3> points;
            for (int i = 0; i < 2; ++i)
                points.push_back(b.position + b.rotation * size.cwiseProduct(random.vector(0.5)));
            s.touch(0, body, Vec3::UnitY(), points);
            const double before = s.kinetic();
            s.resolve(law);
            EXPECT_NEAR(s.kinetic() / before, 1.0, 1e-12) << trial;
            EXPECT_LT(s.approach(), 1e-9) << trial;
        }
}

// In the frame of a moving wall the impact is the same.
TEST(Kinematic, WallThatMoves) {
    for (const ImpactLaw law : laws)
        for (const double e : {1.0, 0.4}) {
            ImpactScene s;
            s.restitution = e;
            const auto wall = s.add(BodyType::kinematic, 0.0, Vec3::Zero(), Vec3::Zero(), Vec3(0, 3, 0));
            s.add_ball(2.0, Vec3(0, 0.5, 0), Vec3(100, -1, 0));
            s.touch(wall, 1, Vec3::UnitY(), {Vec3::Zero()});
            s.resolve(law);
            EXPECT_LT((s.bodies[1].velocity - Vec3(100, 3.0 + 4.0 * e, 0)).norm(), 1e-14);
            EXPECT_EQ(s.bodies[0].velocity, Vec3(0, 3, 0));
        }
}

// A wall pushes a light ball that touches a heavy one: both move along.
TEST(Kinematic, PushesTheHeavyThroughTheLight) {
    for (const ImpactLaw law : laws) {
        ImpactScene s;
        s.restitution = 0.0;
        const auto wall = s.add(BodyType::kinematic, 0.0, Vec3::Zero(), Vec3::Zero(), Vec3(0, 3, 0));
        s.add_ball(1.0, Vec3(0, 0.5, 0), Vec3::Zero());
        s.add_ball(1e6, Vec3(0, 1.5, 0), Vec3::Zero());
        s.touch(wall, 1, Vec3::UnitY(), {Vec3::Zero()});
        s.touch_balls(1, 2);
        s.resolve(law);
        expect_speeds(s, 1, {3.0, 3.0, 3.0}, 1e-9);
    }
}

TEST(Extremes, SpeedsAndTouching) {
    for (const ImpactLaw law : laws)
        for (const double speed : {1e-9, 1.0, 1e6}) {
            ImpactScene s = cradle(3, 1, 1.0);
            s.bodies[0].momentum *= speed;
            s.bodies[0].derive();
            s.resolve(law);
            EXPECT_NEAR(s.kinetic() / (0.5 * speed * speed), 1.0, 1e-14);
            EXPECT_GT(s.bodies[2].velocity.x(), 0.6 * speed);
        }
    ImpactScene still = cradle(3, 0, 1.0);
    EXPECT_EQ(still.resolve(ImpactLaw::propagating), 0);
    EXPECT_EQ(still.kinetic(), 0.0);
}

}  // namespace tumble::impact_laws_test
