// Bad and hard input for impacts: extreme speeds, spins, masses, shapes, places and scales. In every case the state
// stays finite, the run ends, nothing passes through the ground, and momentum is kept where nothing external acts.
#include "exact_scenes.h"
#include "sim/ccd/trajectory.h"
#include "sim/random_shapes.h"
#include "support/bodies.h"
#include "support/meshes.h"

#include <gtest/gtest.h>

namespace tumble::hard_input_test {
using namespace tumble::testing;

namespace {

void set_mode(SceneDescription& scene, bool exact) {
    if (exact) make_exact(scene);
}

void expect_finite(const World& world, const std::string& what) {
    for (const BodyState& b : world.snapshot().bodies)
        ASSERT_TRUE(b.origin.allFinite() && b.orientation.coeffs().allFinite() && b.velocity.allFinite() &&
                    b.angular_velocity.allFinite())
            << what;
}

// Two boxes or balls on a line with offset, alone in space.
struct Encounter {
    double mass = 1.0, other_mass = 1.0, speed = 1.0, offset = 0.0, gap = 0.5, spin = 0.0, restitution = 1.0,
           size = 0.5;
    bool boxes = true, exact = true;
    Vec3 at = Vec3::Zero();
    Vec3 shape = Vec3(1.0, 1.0, 1.0);
};

// Returns the largest overlap that occurred, in sizes.
double meet(const Encounter& e, double energy_tolerance, double momentum_tolerance) {
    SceneDescription scene = empty_scene(4);
    set_step(scene, std::max(1.0, 10.0 * e.speed / e.size));
    for (const int k : {0, 1}) {
        const Vec3 at = e.at + (k ? Vec3(e.size + e.gap, e.offset, 0.1 * e.offset) : Vec3(Vec3::Zero()));
        BodyDescription& body = e.boxes ? add_box(scene, e.size * e.shape, at) : add_sphere(scene, 0.5 * e.size, at);
        body.mass = k ? e.other_mass : e.mass;
        body.velocity = Vec3(k ? -0.5 * e.speed : 0.5 * e.speed, 0.0, 0.0);
        body.angular_velocity = (k ? -1.0 : 1.0) * e.spin * Vec3(0.3, 0.8, 0.5);
        body.restitution = e.restitution;
    }
    set_mode(scene, e.exact);
    World world(scene);
    const Measurement start = world.measure();
    const double momentum = std::max(e.mass, e.other_mass) * e.speed,
                 angular = start.angular_momentum.norm() + momentum * (e.size + e.at.norm());
    double overlap = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        expect_finite(world, "encounter");
        overlap = std::max(overlap, world.measure().max_penetration / e.size);
        const Measurement m = world.measure();
        EXPECT_LE((m.momentum - start.momentum).norm(), momentum_tolerance * momentum);
        // Bodies that stay together for a while are stepped, and the position correction removes the overlap that
        // rotation in a step of 1/20 s makes. It moves the centers, and with them x cross P (measured 1.3e-6 of the
        // scale).
        const double angular_tolerance = e.restitution > 0.0 ? std::max(1e-5, momentum_tolerance) : 0.05;
        EXPECT_LE((m.angular_momentum - start.angular_momentum).norm(), angular_tolerance * angular);
        EXPECT_LE(m.kinetic, start.kinetic * (1.0 + energy_tolerance));
        EXPECT_GE(m.kinetic, e.restitution == 1.0 ? start.kinetic * (1.0 - energy_tolerance) : 0.0);
    }
    return overlap;
}

}  // namespace

TEST(HardInput, SpeedsOfANanometerAndAMillionMetersPerSecond) {
    for (const bool boxes : {false, true})
        for (const double speed : {1e-9, 1e-6, 1e-3, 1e3, 1e6})
            for (const double offset : {0.0, 0.2, 0.4})
                for (const double e : {0.0, 0.5, 1.0}) {
                    Encounter c;
                    c.boxes = boxes;
                    c.speed = speed;
                    c.offset = offset;
                    c.restitution = e;
                    EXPECT_LE(meet(c, 1e-12, 1e-12), e > 0.0 ? 1e-11 : 0.06)
                        << boxes << " " << speed << " " << offset << " " << e;
                }
}

// Passing at exactly the distance of a touch, a little more or less; starting from a touch and along it.
TEST(HardInput, GrazingEncounters) {
    for (const bool boxes : {false, true})
        for (const double speed : {1.0, 100.0})
            for (const double miss : {0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6})
                for (const double gap : {0.5, 0.0, -0.3}) {
                    Encounter c;
                    c.boxes = boxes;
                    c.speed = speed;
                    c.offset = c.size * (1.0 + miss) / std::sqrt(boxes ? 1.0 : 1.01);
                    c.gap = gap;
                    c.restitution = 0.5;
                    EXPECT_LE(meet(c, 1e-12, 1e-12), 2.0 * std::max(0.0, -miss) + 1e-11)
                        << boxes << " " << speed << " " << miss << " " << gap;
                }
}

TEST(HardInput, TouchingAndOverlappingStarts) {
    for (const bool exact : {true, false})
        for (const bool boxes : {false, true})
            for (const double gap : {0.0, -1e-15, -1e-12, -1e-9, -1e-6, -1e-3, -0.1, -0.4})
                for (const double speed : {1.0, 1e-9, -1.0}) {
                    Encounter c;
                    c.exact = exact;
                    c.boxes = boxes;
                    c.gap = gap;
                    c.speed = std::abs(speed);
                    c.restitution = 0.5;
                    const double overlap = meet(c, 1e-9, 1e-9);
                    EXPECT_LE(overlap, 1.01 * std::abs(gap) / c.size + (exact ? 1e-9 : 0.2))
                        << exact << " " << boxes << " " << gap << " " << speed;
                }
}

// Without motion nothing ever happens.
TEST(HardInput, TouchingAtRestInFreeSpace) {
    for (const bool exact : {true, false}) {
        SceneDescription scene = empty_scene(4);
        for (int i = 0; i < 27; ++i) {
            const Vec3 at(i % 3, i / 3 % 3, i / 9);
            (i % 2 ? add_box(scene, {1.0, 1.0, 1.0}, at) : add_sphere(scene, 0.5, at)).restitution = 0.7;
        }
        set_mode(scene, exact);
        World world(scene);
        run(world, scene, 1.0);
        EXPECT_LE(world.measure().kinetic, 1e-24) << exact;
        for (std::size_t i = 0; i < 27; ++i)
            EXPECT_LE((world.snapshot().bodies[i].center_of_mass - scene.bodies[i].position).norm(), 1e-12) << exact;
    }
}

TEST(HardInput, MassesOfOneToAHundredMillion) {
    for (const bool boxes : {false, true})
        for (const double ratio : {1e-8, 1e8})
            for (const double offset : {0.0, 0.2})
                for (const double e : {0.0, 0.5, 1.0}) {
                    Encounter c;
                    c.boxes = boxes;
                    c.other_mass = ratio;
                    c.offset = offset;
                    c.restitution = e;
                    EXPECT_LE(meet(c, 1e-9, 1e-12), 1e-10) << boxes << " " << ratio << " " << offset << " " << e;
                }
}

// A light ball between an approaching heavy one and a wall: some 15,000 impacts of the light one in exact arithmetic.
TEST(HardInput, LightBallBetweenAHeavyOneAndAWall) {
    for (const double ratio : {1e2, 1e4, 1e6}) {
        SceneDescription scene = empty_scene(1);
        add_fixed_box(scene, {1.0, 10.0, 10.0}, {-0.5, 0.0, 0.0}, 1.0);
        add_sphere(scene, 0.5, {2.0, 0.0, 0.0}, 1.0).restitution = 1.0;
        BodyDescription& heavy = add_sphere(scene, 0.5, {4.0, 0.0, 0.0}, ratio);
        heavy.restitution = 1.0;
        heavy.velocity = Vec3(-1.0, 0.0, 0.0);
        make_exact(scene);
        World world(scene);
        const double start = energy(world);
        run(world, scene, 8.0);
        EXPECT_NEAR(energy(world) / start, 1.0, 1e-10) << ratio;
        // The two leave together: after the last impact the light one is no faster than the heavy one.
        EXPECT_GT(world.snapshot().bodies[2].velocity.x(), 0.9) << ratio;
        EXPECT_LE(world.snapshot().bodies[1].velocity.x(), world.snapshot().bodies[2].velocity.x() + 1e-9) << ratio;
        EXPECT_GT(world.snapshot().bodies[1].center_of_mass.x(), 0.5) << ratio;
    }
}

// Principal moments of 1 : 1e-6.
TEST(HardInput, NeedlesAndPlates) {
    for (const Vec3& shape : {Vec3(1.0, 1e-3, 1e-3), Vec3(1.0, 1.0, 1e-3), Vec3(1e-3, 1.0, 1e-3)})
        for (const double spin : {0.0, 5.0, 300.0})
            for (const double offset : {0.0, 0.2})
                for (const double e : {0.3, 1.0}) {
                    Encounter c;
                    c.shape = shape;
                    c.spin = spin;
                    c.offset = offset;
                    c.restitution = e;
                    EXPECT_LE(meet(c, 1e-9, 1e-11), e == 1.0 ? 1e-9 : 5e-3)
                        << shape.transpose() << " " << spin << " " << offset << " " << e;
                }
}

// Precondition of the search for impacts: |omega| and |omega|^2 + |alpha| never exceed their bounds, and those are at
// most ten times too large, also for needles.
TEST(HardInput, BoundsOfFreeRotation) {
    Random random(31);
    for (int trial = 0; trial < trials(300); ++trial) {
        const Vec3 size(std::pow(10.0, random(-3.0, 0.0)), std::pow(10.0, random(-3.0, 0.0)), 1.0);
        const Body body = free_box(size, 1.0, Vec3::Zero(), Vec3::Zero(), random.turn(), random.vector(10.0));
        const Trajectory path = Trajectory::flight(body, Vec3::Zero());
        double spin = 0.0, turning = 0.0;
        for (int k = 0; k < 400; ++k) {
            const double t = 0.005 * k;
            const Motion m = path.at(t);
            const Mat3 inverse_inertia = m.rotation * body.inverse_inertia_body * m.rotation.transpose();
            const Vec3 omega = inverse_inertia * body.angular_momentum,
                       alpha = -(inverse_inertia * omega.cross(body.angular_momentum));
            spin = std::max(spin, omega.norm());
            turning = std::max(turning, omega.squaredNorm() + alpha.norm());
        }
        EXPECT_LE(spin, path.spin_bound() * (1.0 + 1e-9)) << size.transpose();
        EXPECT_LE(turning, path.turning_bound() * (1.0 + 1e-9)) << size.transpose();
        EXPECT_GE(spin, 0.1 * path.spin_bound()) << size.transpose();
        EXPECT_GE(turning, 0.05 * path.turning_bound()) << size.transpose();
    }
}

TEST(HardInput, SpinsOfTenThousandRadiansPerSecond) {
    for (const double e : {0.0, 0.5, 1.0})
        for (const double offset : {0.0, 0.1, 0.3}) {
            Encounter c;
            c.spin = 1e4;
            c.offset = offset;
            c.restitution = e;
            EXPECT_LE(meet(c, 1e-9, 1e-9), 1e-9) << e << " " << offset;
        }
}

// Far from the origin a place is known only to 1e-11 m, which limits the accuracy of the impacts.
TEST(HardInput, AHundredKilometersFromTheOrigin) {
    for (const bool exact : {true, false})
        for (const bool boxes : {false, true})
            for (const double e : {0.5, 1.0}) {
                Encounter c;
                c.exact = exact;
                c.boxes = boxes;
                c.at = Vec3(1e5, -1e5, 1e5);
                c.offset = 0.2;
                c.restitution = e;
                EXPECT_LE(meet(c, exact ? 1e-9 : 0.05, 1e-9), exact ? 1e-9 : 0.2) << exact << " " << boxes << " " << e;
            }
}

// The same scene in millimeters and kilometers, times in proportion: the same numbers.
TEST(HardInput, ScenesOfAnyScale) {
    Snapshot ends[3];
    const double scales[] = {1.0, 1e-3, 1e3};
    for (int k = 0; k < 3; ++k) {
        const double s = scales[k];
        SceneDescription scene = ground_scene(0.8, 0.0);
        scene.simulation.steps_per_frame = 1;
        scene.simulation.gravity = Vec3(0.0, -gravity * s, 0.0);
        for (int i = 0; i < 4; ++i) {
            BodyDescription& body = i % 2 ? add_sphere(scene, 0.3 * s, {1.0 * s * i, 1.5 * s, 0.0})
                                          : add_box(scene, Vec3(0.5, 0.4, 0.3) * s, {1.0 * s * i, 1.5 * s, 0.0});
            body.mass = s * s * s;
            body.restitution = 0.8;
            body.rotation = turn({1.0, 0.5, 0.3 * i}, 0.7);
            body.velocity = Vec3(0.5 * s * (1 - i), 0.0, 0.0);
        }
        make_exact(scene);
        World world(scene);
        run(world, scene, 1.2);
        ends[k] = world.snapshot();
        EXPECT_LE(world.measure().max_penetration, 1e-11 * s);
    }
    for (int k = 1; k < 3; ++k)
        for (std::size_t i = 1; i < ends[0].bodies.size(); ++i) {
            EXPECT_LE((ends[k].bodies[i].center_of_mass / scales[k] - ends[0].bodies[i].center_of_mass).norm(), 1e-9)
                << scales[k] << " " << i;
            EXPECT_LE((ends[k].bodies[i].velocity / scales[k] - ends[0].bodies[i].velocity).norm(), 1e-8)
                << scales[k] << " " << i;
        }
}

}  // namespace tumble::hard_input_test
