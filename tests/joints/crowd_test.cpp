// Crowds of figures, which are solved in sweeps: the decision, closed joints, sleep, threads and checkpoints; and
// random trees, which stay finite.
#include "sim/checkpoint/archive.h"
#include "sim/joints/joint_way.h"
#include "sim/random_shapes.h"
#include "swept_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace tumble::crowd_test {
using namespace tumble::testing;

namespace {

void add_figure(SceneDescription& scene, const Vec3& place, const Quat& q) {
    const SceneDescription figure = figure_scene(4);
    const std::size_t first = scene.bodies.size();
    for (BodyDescription body : figure.bodies) {
        body.position = place + q * body.position;
        body.rotation = q;
        body.friction = 0.5;
        body.restitution = 0.0;
        scene.bodies.push_back(body);
    }
    for (JointDescription joint : figure.joints) {
        *joint.first += first;
        *joint.second += first;
        joint.name += fmt::format(" of {}", first);
        scene.joints.push_back(joint);
    }
}

/// Figures of five bodies fall on a floor, apart or in a heap. Joints of one axis have friction; in a heap all have, or
/// a limb that hangs free would swing for long.
SceneDescription crowd(int figures, bool heap = false) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = 4;
    for (int k = 0; k < figures; ++k) {
        const Vec3 apart(2.0 * (k % 4), 0.6, 2.0 * (k / 4)), above(0.2 * (k % 2), 0.9 + 0.9 * k, 0.3 * (k % 3));
        add_figure(scene, heap ? above : apart, turn(Vec3(1.0, 0.3 * k, -0.5).normalized(), (heap ? 0.82 : 0.7) * k));
    }
    for (JointDescription& joint : scene.joints)
        if (joint.type == JointType::hinge || heap) joint.turn[0].friction = 0.05;
    add_floor(scene);
    return scene;
}

SceneDescription solved_directly(SceneDescription scene) {
    scene.simulation.contact_solver = ContactSolverChoice::direct;
    return scene;
}

std::vector<Vec3> places_after(SceneDescription scene, int frames) {
    World world(scene);
    for (int frame = 0; frame < frames; ++frame) world.advance_frame();
    std::vector<Vec3> places;
    for (const BodyState& body : world.snapshot().bodies) places.push_back(body.center_of_mass);
    return places;
}

bool all_rest(const World& world) {
    const Snapshot s = world.snapshot();
    return std::all_of(s.bodies.begin(), s.bodies.end(),
                       [](const BodyState& body) { return body.mass == 0.0 || body.asleep; });
}

}  // namespace

TEST(FigureCrowd, IsSweptFromFortyEightBodiesAndForAWhileAfter) {
    FigureCrowd crowd;
    const auto swept = [&](std::size_t bodies) {
        crowd.count(bodies);
        return crowd.swept();
    };
    EXPECT_FALSE(swept(47));
    EXPECT_TRUE(swept(48));
    EXPECT_TRUE(swept(36));
    for (int step = 1; step < 30; ++step) EXPECT_TRUE(swept(35)) << step;
    EXPECT_FALSE(swept(35));
    EXPECT_FALSE(swept(47));
}

// The bodies of figures, and from how many on they are swept.
TEST(FigureCrowd, CountsTreesThatSweepsKnow) {
    const auto report = [](int figures, auto&& change) {
        SceneDescription scene = crowd(figures);
        change(scene);
        const JointReport of = World(scene).joint_report();
        return std::pair(of.figures, of.crowd);
    };
    const auto all = [&](auto&& change) { return report(10, change).first; };
    EXPECT_EQ(report(10, [](SceneDescription&) {}), std::pair(std::size_t(50), std::size_t(48)));
    EXPECT_EQ(report(9, [](SceneDescription&) {}), std::pair(std::size_t(45), std::size_t(0)));
    EXPECT_EQ(all([](SceneDescription& s) { s.joints[0].turn[0].spring = JointSpring{.stiffness = 1.0}; }), 45u);
    EXPECT_EQ(all([](SceneDescription& s) { s.joints[1].break_force = 1e6; }), 45u);
    EXPECT_EQ(all([](SceneDescription& s) { s.bodies[0].integrator = IntegratorKind::exact; }), 45u);
    EXPECT_EQ(all([](SceneDescription& s) { s.bodies[0].mass = 17.0 * *s.bodies[1].mass; }), 45u);
    EXPECT_EQ(all([](SceneDescription& s) { add_joint(s, JointType::ball, std::nullopt, 0, s.bodies[0].position); }),
              45u);
    EXPECT_EQ(all([](SceneDescription& s) { add_joint(s, JointType::ball, 1, 2, s.bodies[0].position); }), 45u);
    EXPECT_EQ(all([](SceneDescription& s) { add_joint(s, JointType::ball, 0, 5, s.bodies[0].position); }), 50u);
    EXPECT_EQ(all([](SceneDescription& s) { s.simulation.contact_solver = ContactSolverChoice::direct; }), 0u);
    EXPECT_EQ(all([](SceneDescription& s) { s.simulation.impacts = ImpactMode::exact; }), 0u);
    // Chains are no figures.
    SceneDescription chain = free_chain_scene(65);
    EXPECT_EQ(World(chain).joint_report().figures, 0u);
    EXPECT_EQ(World(free_chain_scene(64)).joint_report().figures, 64u);
}

TEST(FigureCrowd, GoesByTheDirectSolverBelow) {
    const auto solved_alike = [](int figures, int frames) {
        return places_after(crowd(figures), frames) == places_after(solved_directly(crowd(figures)), frames);
    };
    EXPECT_TRUE(solved_alike(9, 60));
    EXPECT_FALSE(solved_alike(10, 60));
    EXPECT_TRUE(solved_alike(10, 2));  // in flight nothing is swept
}

TEST(FigureCrowd, AHeapHasClosedJointsAndFallsAsleep) {
    World world(crowd(10, true));
    double energy = total_energy(world);
    for (int frame = 0; frame < 900 && !all_rest(world); ++frame) {
        world.advance_frame();
        EXPECT_LT(largest_gap(world), 1e-5) << frame;
        EXPECT_LT(total_energy(world), energy + 0.1) << frame;
        energy = std::min(energy, total_energy(world));
    }
    EXPECT_TRUE(all_rest(world));
}

TEST(FigureCrowd, HasTheSameBytesForAnyThreads) {
    World one(crowd(40), 1), three(crowd(40), 3);
    for (int frame = 0; frame < 60; ++frame) {
        one.advance_frame();
        three.advance_frame();
    }
    const Snapshot a = one.snapshot(), b = three.snapshot();
    for (std::size_t i = 0; i < a.bodies.size(); ++i) {
        EXPECT_EQ(a.bodies[i].momentum, b.bodies[i].momentum) << i;
        EXPECT_EQ(a.bodies[i].center_of_mass, b.bodies[i].center_of_mass) << i;
        EXPECT_EQ(a.bodies[i].orientation.coeffs(), b.bodies[i].orientation.coeffs()) << i;
    }
}

// Between the two numbers the way depends on the steps before.
TEST(FigureCrowd, GoesOnFromACheckpoint) {
    SceneDescription scene = crowd(10);
    for (std::size_t i = 45; i < 50; ++i) scene.bodies[i].velocity.y() = 6.0;  // one leaves the floor's reach
    for (std::size_t i = 45; i < 50; ++i) scene.bodies[i].position.y() -= 0.1;
    for (const int frames : {20, 40, 60}) {
        World whole(scene);
        for (int frame = 0; frame < frames; ++frame) whole.advance_frame();
        CheckpointWriter writer;
        whole.save(writer);
        World resumed(scene);
        CheckpointReader reader(writer.bytes());
        resumed.restore(reader);
        for (int frame = 0; frame < 20; ++frame) {
            whole.advance_frame();
            resumed.advance_frame();
        }
        const Snapshot a = whole.snapshot(), b = resumed.snapshot();
        for (std::size_t i = 0; i < a.bodies.size(); ++i) {
            EXPECT_EQ(a.bodies[i].momentum, b.bodies[i].momentum) << frames << ' ' << i;
            EXPECT_EQ(a.bodies[i].center_of_mass, b.bodies[i].center_of_mass) << frames << ' ' << i;
        }
    }
}

// Carriers move after the joints are closed: their pose at the end of the step counts.
TEST(Projection, FollowsACarrier) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 4;
    BodyDescription& hand = add_box(scene, {0.1, 0.1, 0.1}, {0.0, 2.0, 0.0});
    hand.type = BodyType::kinematic;
    hand.velocity = {1.0, 0.5, 0.0};
    hand.angular_velocity = {0.0, 2.0, 3.0};
    for (int i = 0; i < 3; ++i) {
        add_box(scene, {0.1, 0.3, 0.1}, {0.05, 1.8 - 0.3 * i, 0.0});
        add_joint(scene, i == 0 ? JointType::universal : JointType::ball, std::size_t(i), std::size_t(i + 1),
                  {0.05, 1.95 - 0.3 * i, 0.0}, Vec3::UnitX());
    }
    World world(scene);
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        EXPECT_LT(largest_gap(world), 1e-5) << frame;
    }
}

// Anchors that are more than a body apart come together over some steps, and stay together.
TEST(Projection, PullsAnchorsTogether) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 4;
    scene.simulation.gravity.setZero();
    add_box(scene, {0.2, 0.2, 0.2}, Vec3::Zero());
    add_box(scene, {0.2, 0.2, 0.2}, {0.6, 0.0, 0.0});
    add_joint(scene, JointType::ball, 0, 1, {0.1, 0.0, 0.0}).anchor_second = {-0.1, 0.0, 0.0};
    World world(scene);
    world.step();
    EXPECT_GT(largest_gap(world), 0.2);
    double last = largest_gap(world);
    for (int frame = 0; frame < 30; ++frame) {
        world.advance_frame();
        EXPECT_LE(largest_gap(world), std::max(last, 1e-5));
        last = largest_gap(world);
    }
    EXPECT_LT(last, 1e-5);
    const Snapshot s = world.snapshot();
    EXPECT_LT((s.bodies[0].center_of_mass + s.bodies[1].center_of_mass - Vec3(0.6, 0.0, 0.0)).norm(), 1e-6);
}

// A ball of 46 mm on a hinge 1.9 m away: its turns add 4,000 times to the compliance at the anchor.
TEST(RandomTrees, ASmallBallOnALongLeverStaysFinite) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 16;
    add_sphere(scene, 0.046, Vec3::Zero());
    add_joint(scene, JointType::hinge, std::nullopt, 0, {1.727, -0.655, -0.265}, {0.772685, -0.114073, 0.624455});
    World world(scene);
    const double start = total_energy(world);
    for (int frame = 0; frame < 60; ++frame) world.advance_frame();
    EXPECT_NEAR(total_energy(world), start, 1e-3 * 9.81 * 1.9);
    EXPECT_LT(largest_gap(world), 1e-5);
}

TEST(RandomTrees, StayFinite) {
    for (int trial = 0; trial < trials(100); ++trial) {
        Random random{std::uint64_t(trial)};
        SceneDescription scene = swept({});
        scene.simulation.steps_per_frame = 1 << random.below(3);
        const int bodies = 1 + random.below(8);
        for (int i = 0; i < bodies; ++i) {
            const auto length = [&] { return 0.1 * std::pow(10.0, random(0.0, 1.0)); };
            const Vec3 near = i == 0 ? Vec3(Vec3::Zero()) : scene.bodies.back().position;
            const Vec3 place = near + random.vector(0.4);
            BodyDescription& body = random.below(3) == 0 ? add_sphere(scene, 0.5 * length(), place)
                                                         : add_box(scene, {length(), length(), length()}, place);
            body.mass = std::exp(random(-6.0, 6.0));
            body.rotation = random.turn();
            body.restitution = 0.5 * random.below(2);
            if (random.below(3) > 0) continue;
            body.velocity = random.vector(4.0);
            body.angular_velocity = random.vector(10.0);
        }
        for (int i = 0; i < bodies; ++i) {
            constexpr JointType types[] = {JointType::hinge, JointType::ball, JointType::universal, JointType::fixed,
                                           JointType::slider};
            const JointType type = types[random.below(random.below(8) == 0 ? 5 : 4)];
            if (i == 0 && random.below(2) == 0) continue;
            const auto other = i == 0 ? std::optional<std::size_t>{} : std::size_t(i - 1);
            const Vec3 anchor = scene.bodies[std::size_t(i)].position + random.vector(random.below(8) == 0 ? 1.0 : 0.2);
            JointDescription& joint = add_joint(scene, type, other, std::size_t(i), anchor, random.direction());
            if (random.below(6) == 0) joint.anchor_second += random.vector(0.5);
            if (type == JointType::hinge && random.below(2) == 0)
                limit_turn(joint.turn[0], -random(0.01, 2.0), random(0.01, 2.0));
            if (type == JointType::ball && random.below(2) == 0) joint.swing = {random(0.1, 2.0), random(0.1, 2.0)};
            if (random.below(3) == 0) joint.turn[0].friction = std::exp(random(-4.0, 4.0));
        }
        add_floor(scene);
        scene.bodies.back().position.y() = -3.0;
        World world(scene);
        EXPECT_NO_THROW({
            for (int frame = 0; frame < 6; ++frame) world.advance_frame();
        }) << trial;
    }
}

}  // namespace tumble::crowd_test
