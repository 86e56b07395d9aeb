// Impacts of joined bodies: closed forms, conservation laws, and the loads of the joints.
#include "sim/impact_scenes.h"

#include "sim/joints/joint.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace tumble::joint_impact_test {
namespace {

using namespace testing;

/// An impact of bodies that joints hold; all joints are in one island.
struct JoinedScene : ImpactScene {
    std::vector<Joint> joints;
    std::vector<JointImpulse> blows;

    Joint& join(JointType type, std::uint32_t a, std::uint32_t b, const Vec3& point, const Vec3& axis = Vec3::UnitZ()) {
        Joint& joint = joints.emplace_back();
        joint.a = a;
        joint.b = b;
        joint.size = 0.5;
        JointDescription description;
        description.type = type;
        for (JointAxis& turn : description.turn)
            turn.motion = type == JointType::ball ? JointAxis::Motion::free : JointAxis::Motion::locked;
        if (type == JointType::hinge) description.turn[0].motion = JointAxis::Motion::free;
        joint.describe(description);
        const Quat frame = Quat::FromTwoVectors(Vec3::UnitX(), axis);
        const auto side = [&](std::uint32_t body, Vec3& anchor, Quat& to_body) {
            const Quat turn = body == Joint::world ? Quat::Identity() : bodies[body].orientation;
            anchor = turn.conjugate() * (body == Joint::world ? point : Vec3(point - bodies[body].position));
            to_body = turn.conjugate() * frame;
        };
        side(a, joint.anchor_a, joint.frame_a);
        side(b, joint.anchor_b, joint.frame_b);
        return joint;
    }

    int resolve(ImpactLaw law, bool complete = true) {
        make_contacts(manifolds, bodies, contacts);
        Island island;
        for (std::uint32_t i = 0; i < bodies.size(); ++i)
            if (bodies[i].dynamic()) island.bodies.push_back(i);
        for (std::uint32_t i = 0; i < contacts.size(); ++i) island.contacts.push_back(i);
        for (Joint& joint : joints) island.joints.push_back(&joint);
        const ImpactSettings settings{.law = law, .friction = friction > 0.0, .complete = complete};
        const int passes = resolve_impacts(island, contacts, bodies, settings, nullptr, &blows);
        for (const Contact& c : contacts) add_impact(c, bodies[c.a], bodies[c.b]);
        for (const JointImpulse& blow : blows) apply_joint_impulse(blow, bodies);
        for (Body& b : bodies)
            if (b.dynamic()) b.derive();
        return passes;
    }

    Vec3 momentum() const {
        Vec3 sum = Vec3::Zero();
        for (const Body& b : bodies) sum += b.momentum;
        return sum;
    }
    Vec3 angular_momentum() const {
        Vec3 sum = Vec3::Zero();
        for (const Body& b : bodies) sum += b.angular_momentum + b.position.cross(b.momentum);
        return sum;
    }
    /// Fastest rate, m/s, at which the anchors of a joint part.
    double parting() const {
        double most = 0.0;
        for (const Joint& joint : joints) {
            const auto at = [&](std::uint32_t body, const Vec3& anchor) -> Vec3 {
                if (body == Joint::world) return Vec3::Zero();
                return bodies[body].point_velocity(bodies[body].rotation * anchor);
            };
            most = std::max(most, (at(joint.b, joint.anchor_b) - at(joint.a, joint.anchor_a)).norm());
        }
        return most;
    }
};

constexpr ImpactLaw both_laws[] = {ImpactLaw::propagating, ImpactLaw::simultaneous};

// n free rods of 1 m and 1 kg in a row with hinges, at rest; a ball strikes across the end of the first: velocities and
// impulses in the hinges over the impulse of the ball.
TEST(JointImpact, StruckRods) {
    const std::vector<std::vector<std::pair<double, double>>> after = {
        {{5.0 / 4, -9.0 / 2}, {-1.0 / 4, 3.0 / 2}},
        {{19.0 / 15, -22.0 / 5}, {-1.0 / 3, 6.0 / 5}, {1.0 / 15, -2.0 / 5}},
        {{71.0 / 56, -123.0 / 28}, {-19.0 / 56, 33.0 / 28}, {5.0 / 56, -9.0 / 28}, {-1.0 / 56, 3.0 / 28}}};
    const std::vector<std::vector<double>> hinges = {
        {-1.0 / 4}, {-4.0 / 15, 1.0 / 15}, {-15.0 / 56, 1.0 / 14, -1.0 / 56}};
    for (const ImpactLaw law : both_laws)
        for (std::size_t n = 2; n <= 4; ++n) {
            JoinedScene s;
            for (std::size_t i = 0; i < n; ++i)
                s.add(BodyType::dynamic, 1.0, Vec3(1e-3, 1.0 / 12.0, 1.0 / 12.0), Vec3(double(i), 0, 0), Vec3::Zero());
            const std::uint32_t ball = s.add_ball(0.7, {-0.5, -0.5, 0.0}, {0.0, 2.0, 0.0});
            s.touch(0, ball, -Vec3::UnitY(), {{-0.5, 0.0, 0.0}});
            for (std::size_t i = 0; i + 1 < n; ++i)
                s.join(JointType::hinge, std::uint32_t(i), std::uint32_t(i + 1), {double(i) + 0.5, 0.0, 0.0});
            const double energy = s.kinetic();
            s.resolve(law);
            const double j = s.contacts[0].impact;
            EXPECT_GT(j, 0.5);
            for (std::size_t i = 0; i < n; ++i) {
                EXPECT_NEAR(s.bodies[i].velocity.y() / j, after[n - 2][i].first, 1e-13);
                EXPECT_NEAR(s.bodies[i].angular_velocity.z() / j, after[n - 2][i].second, 1e-13);
                if (i + 1 < n) {
                    EXPECT_NEAR(s.blows[i].force.y() / j, hinges[n - 2][i], 1e-13);
                }
            }
            EXPECT_NEAR(s.kinetic(), energy, 1e-15);
        }
}

// A box of 1 m on a hinge, struck across at a distance from the hinge: its impulse is j (m l r / I_O - 1), with l from
// the hinge to the center of mass; nothing at the center of percussion.
TEST(JointImpact, CenterOfPercussion) {
    const double inertia = 1.01 / 12.0, about_hinge = inertia + 0.25, percussion = about_hinge / 0.5;
    for (const double r : {percussion, 0.3, 0.9}) {
        JoinedScene s;
        const std::uint32_t box = s.add_box(1.0, {0.1, 1.0, 0.1}, {0.0, -0.5, 0.0}, Vec3::Zero());
        const std::uint32_t ball = s.add_ball(0.4, {-0.55, -r, 0.0}, {3.0, 0.0, 0.0});
        s.touch(box, ball, -Vec3::UnitX(), {{-0.05, -r, 0.0}});
        s.join(JointType::hinge, Joint::world, box, Vec3::Zero());
        s.resolve(ImpactLaw::propagating);
        const double j = s.contacts[0].impact, expected = j * (0.5 * r / about_hinge - 1.0);
        EXPECT_NEAR(j, 6.0 / (1.0 / 0.4 + r * r / about_hinge), 1e-14);
        EXPECT_NEAR(s.blows[0].force.x(), expected, 1e-14);
        EXPECT_LT(Vec3(s.blows[0].force - Vec3(expected, 0, 0)).norm() + s.blows[0].torque.norm(), 1e-14);
        EXPECT_NEAR(s.bodies[box].angular_velocity.z(), j * r / about_hinge, 1e-14);
    }
}

// A ball as heavy as the door at the struck point: the door takes its speed, returns it at its limit, and the ball
// leaves with e times its speed.
TEST(JointImpact, ADoorAtItsLimit) {
    for (const double e : {1.0, 0.5, 0.0}) {
        JoinedScene s;
        const std::uint32_t door = s.add_box(1.0, {1.0, 2.0, 0.04}, {0.5, 0.0, 0.0}, Vec3::Zero());
        const double inertia = s.bodies[door].inertia_body(1, 1) + 0.25, arm = 0.8;
        const std::uint32_t ball = s.add_ball(inertia / (arm * arm), {arm, 0.0, 0.52}, {0.0, 0.0, -1.5});
        s.touch(door, ball, Vec3::UnitZ(), {{arm, 0.0, 0.02}});
        JointAxis& turn = s.join(JointType::hinge, Joint::world, door, Vec3::Zero(), Vec3::UnitY()).description.turn[0];
        turn.motion = JointAxis::Motion::limited;
        turn.lower = -1.0;
        turn.upper = 0.0;
        turn.restitution = e;
        const double energy = s.kinetic();
        s.resolve(ImpactLaw::propagating);
        EXPECT_NEAR(s.bodies[ball].velocity.z(), 1.5 * e, 1e-14);
        EXPECT_NEAR(s.bodies[door].angular_velocity.y(), 0.0, 1e-14);
        EXPECT_NEAR(s.kinetic(), e * e * energy, 1e-14);
        EXPECT_NEAR(s.blows[0].lost, -s.blows[0].work_a - s.blows[0].work_b, 1e-14);
    }
}

/// A tree of bodies with ball joints and hinges and one loop, struck at many points by balls.
JoinedScene tangle(std::uint32_t seed, double restitution, bool anchored) {
    std::mt19937 random(seed);
    const auto number = [&] { return double(random()) / 4294967296.0 * 2.0 - 1.0; };
    const auto vector = [&] { return Vec3(number(), number(), number()); };
    JoinedScene s;
    s.restitution = restitution;
    for (std::uint32_t i = 0; i < 7; ++i) {
        const Vec3 place = 2.0 * vector();
        s.add(BodyType::dynamic, std::exp(2.0 * number()), (Vec3::Constant(1.2) + vector()), place, Vec3::Zero());
        Body& body = s.bodies.back();
        body.orientation = from_rotation_vector(vector());
        body.rotation = body.orientation.toRotationMatrix();
        body.derive();
        if (i > 0)
            s.join(i % 2 ? JointType::ball : JointType::hinge, std::uint32_t(random() % i), i, 2.0 * vector(),
                   vector().normalized());
    }
    s.join(JointType::ball, 6, 0, 2.0 * vector());
    if (anchored) s.join(JointType::ball, Joint::world, 2, vector());
    for (std::uint32_t i = 0; i < 5; ++i) {
        const std::uint32_t link = std::uint32_t(random() % 7);
        const Vec3 at = s.bodies[link].position + vector(), normal = vector().normalized();
        const std::uint32_t ball =
            s.add_ball(std::exp(number()), at + 0.5 * normal, -(1.0 + number()) * normal + 0.3 * vector());
        s.touch(link, ball, normal, {at});
    }
    return s;
}

TEST(JointImpact, KeepsEnergyAndMomentaToRounding) {
    for (const ImpactLaw law : both_laws)
        for (std::uint32_t seed = 1; seed <= 40; ++seed)
            for (const bool anchored : {false, true}) {
                JoinedScene s = tangle(seed, 1.0, anchored);
                const double energy = s.kinetic();
                const Vec3 momentum = s.momentum(), turn = s.angular_momentum();
                s.resolve(law);
                EXPECT_GT(s.bodies[3].velocity.norm(), 1e-6);
                EXPECT_NEAR(s.kinetic(), energy, 2e-14 * energy) << seed;
                EXPECT_LT(s.parting(), 1e-12) << seed;
                EXPECT_LT(s.approach(), 1e-12) << seed;
                if (anchored) continue;
                EXPECT_LT((s.momentum() - momentum).norm(), 2e-14) << seed;
                EXPECT_LT((s.angular_momentum() - turn).norm(), 5e-14) << seed;
            }
}

TEST(JointImpact, GainsNoEnergyWithFrictionAndRestitution) {
    for (const ImpactLaw law : both_laws)
        for (std::uint32_t seed = 1; seed <= 40; ++seed) {
            JoinedScene s = tangle(seed, 0.6, seed % 2 == 0);
            s.friction = 0.7;
            for (Body& body : s.bodies) body.friction = 0.7;
            const double energy = s.kinetic();
            s.resolve(law);
            EXPECT_LE(s.kinetic(), energy * (1.0 + 1e-13)) << seed;
            EXPECT_LT(s.parting(), 1e-12) << seed;
            EXPECT_LT(s.approach(), 1e-9) << seed;
            double work = 0.0;
            for (const JointImpulse& blow : s.blows) work += std::abs(blow.work_a + blow.work_b);
            EXPECT_LT(work, 1e-12) << seed;
        }
}

// A long chain, struck at its end: as four rods in a row, because the blow dies out by 2 - sqrt(3) from hinge to hinge.
TEST(JointImpact, ALongChain) {
    const std::size_t n = 1000;
    JoinedScene s;
    for (std::size_t i = 0; i < n; ++i)
        s.add(BodyType::dynamic, 1.0, Vec3(1e-3, 1.0 / 12.0, 1.0 / 12.0), Vec3(double(i), 0, 0), Vec3::Zero());
    const std::uint32_t ball = s.add_ball(1.0, {-0.5, -0.5, 0.0}, {0.0, 1.0, 0.0});
    s.touch(0, ball, -Vec3::UnitY(), {{-0.5, 0.0, 0.0}});
    for (std::size_t i = 0; i + 1 < n; ++i)
        s.join(JointType::ball, std::uint32_t(i), std::uint32_t(i + 1), {double(i) + 0.5, 0.0, 0.0});
    s.resolve(ImpactLaw::propagating);
    const double j = s.contacts[0].impact, share = -(2.0 - std::sqrt(3.0));
    EXPECT_NEAR(s.blows[0].force.y() / j, share, 1e-12);
    EXPECT_NEAR(s.blows[1].force.y() / s.blows[0].force.y(), share, 1e-12);
    EXPECT_NEAR(s.bodies[0].velocity.y() / j, 1.0 - share, 1e-12);
    EXPECT_LT(s.parting(), 1e-12);
}

}  // namespace
}  // namespace tumble::joint_impact_test
