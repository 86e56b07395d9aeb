// Bounces without end, and hundreds of contacts at once: bodies come to rest where they should, in bounded time.
#include "exact_scenes.h"
#include "sim/random_shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace tumble::zeno_test {
using namespace tumble::testing;

namespace {

double lowest_corner(const Vec3& size, const BodyState& s) {
    const Vec3 up = s.orientation.conjugate() * Vec3::UnitY();
    return s.origin.y() - 0.5 * up.cwiseAbs().dot(size);
}

}  // namespace

// Boxes dropped in any orientation rattle down onto a face: at rest, on the ground, without any rise of energy.
TEST(Zeno, TiltedBoxesComeToRestOnAFace) {
    Random random(17);
    const Vec3 size(1.0, 0.6, 0.8);
    for (const double e : {0.3, 0.5, 0.8, 0.9}) {
        for (int trial = 0; trial < trials(5); ++trial) {
            SceneDescription scene = ground_scene(e, 0.4);
            BodyDescription& box = add_box(scene, size, {0.0, 1.3, 0.0});
            box.restitution = e;
            box.friction = 0.4;
            box.rotation = random.turn();
            box.angular_velocity = random.vector(2.0);
            make_exact(scene);
            World world(scene);
            const double start = energy(world);
            double before = start, rise = 0.0, sunk = 0.0;
            const int seconds = e > 0.85 ? 25 : 15;
            for (int frame = 0; frame < 60 * seconds; ++frame) {
                world.advance_frame();
                const double now = energy(world);
                rise = std::max(rise, (now - before) / start);
                before = now;
                sunk = std::max(sunk, -lowest_corner(size, world.snapshot().bodies[1]));
            }
            // The position correction of the resting solver, after a sequence of impacts that ends on an edge: in one
            // of 50 more than 1e-4.
            EXPECT_LE(rise, 5e-4) << e << " " << trial;
            EXPECT_LE(sunk, 2e-3) << e << " " << trial;  // in contact, and rotating within a step
            const BodyState s = world.snapshot().bodies[1];
            EXPECT_LE(s.velocity.norm() + s.angular_velocity.norm(), 1e-3) << e << " " << trial;
            EXPECT_NEAR(lowest_corner(size, s), 0.0, 2e-5) << e << " " << trial;
            const Vec3 up = s.orientation.conjugate() * Vec3::UnitY();
            EXPECT_GT(up.cwiseAbs().maxCoeff(), 1.0 - 1e-8) << e << " " << trial << ": " << up.transpose();
        }
    }
}

// A box that falls flat bounces like a ball, and rests at the same time.
TEST(Zeno, FlatBoxRestsWhenABallDoes) {
    for (const double e : {0.3, 0.5, 0.8, 0.9}) {
        const double rest = time_of_rest(1.0, e);
        for (const double offset : {-1e-5, 1e-5}) {
            SceneDescription scene = ground_scene(e, 0.3);
            set_step(scene, 100.0 / (rest + offset));
            BodyDescription& box = add_box(scene, {1.0, 0.6, 0.8}, {0.0, 1.3, 0.0});
            box.restitution = e;
            box.friction = 0.3;
            make_exact(scene);
            World world(scene);
            for (int i = 0; i < 100; ++i) world.step();
            const double speed = world.snapshot().bodies[1].velocity.norm();
            if (offset < 0.0) {
                EXPECT_GT(speed, 1e-6) << e;
            } else {
                EXPECT_LE(speed, 1e-6) << e;  // the resting solver's tolerance
            }
            EXPECT_NEAR(world.snapshot().bodies[1].center_of_mass.y(), 0.3, 1e-9) << e;
        }
    }
}

// A hundred balls in one layer land at once, each independently; then they lie.
TEST(ManyContacts, LayerOfBallsFallsFlat) {
    SceneDescription scene = ground_scene(0.5, 0.3);
    const int side = trials(16);
    for (int i = 0; i < side * side; ++i) {
        BodyDescription& ball = add_sphere(scene, 0.5, {double(i % side), 1.0, double(i / side)});
        ball.restitution = 0.5;
        ball.friction = 0.3;
    }
    make_exact(scene);
    World world(scene);
    for (int frame = 1; frame <= 90; ++frame) {
        world.advance_frame();
        for (const BodyState& b : world.snapshot().bodies) {
            if (&b == &world.snapshot().bodies[0]) continue;
            ASSERT_TRUE(b.center_of_mass.allFinite());
        }
        const double expected = 0.5 + bouncing_clearance(0.5, 0.5, frame / 60.0);
        for (std::size_t i = 1; i < scene.bodies.size(); i += 37)
            ASSERT_NEAR(world.snapshot().bodies[i].center_of_mass.y(), expected, 1e-6) << frame << " " << i;
    }
    EXPECT_LE(world.measure().max_penetration, 1e-5);
}

// A wide box on a bed of balls, rotated about the vertical: every ball gets the same impulse, at e = 0, 1 and in
// between. Balls that hit the ground under it at one time do so together, independent of any trembling of resting balls
// against the ground: the box stays level.
TEST(ManyContacts, FlatBoxOnABedOfBalls) {
    struct Bed {
        int side;
        double pitch, turn;
    };
    for (const Bed& bed : {Bed{4, 1.0, 0.0}, Bed{4, 1.37, 0.0}, Bed{5, 1.37, 0.3}, Bed{6, 0.8, 0.0}, Bed{8, 1.0, 0.0}})
        for (const double e : {0.0, 0.5, 0.8, 1.0}) {
            SCOPED_TRACE(fmt::format("{0} x {0} balls {1} m apart, e = {2}", bed.side, bed.pitch, e));
            SceneDescription scene = ground_scene(e, 0.0);
            const double middle = 0.5 * (bed.side - 1), width = bed.pitch * (bed.side - 1) + 2.0;
            for (int i = 0; i < bed.side * bed.side; ++i)
                add_sphere(scene, 0.4, {bed.pitch * (i % bed.side - middle), 0.4, bed.pitch * (i / bed.side - middle)})
                    .restitution = e;
            BodyDescription& box = add_box(scene, {width, 0.5, width}, {0.0, 1.55, 0.0}, 20.0);
            box.restitution = e;
            box.rotation = turn(Vec3::UnitY(), bed.turn);
            make_exact(scene);
            World world(scene);
            const std::size_t top = scene.bodies.size() - 1;
            const double start = energy(world);
            double before = start;
            for (int frame = 0; frame < 60; ++frame) {
                world.advance_frame();
                const double now = energy(world);
                ASSERT_LE(now, before + 1e-7 * start) << frame;
                before = now;
                const BodyState b = world.snapshot().bodies[top];
                ASSERT_TRUE(b.center_of_mass.allFinite());
                ASSERT_LE(b.angular_velocity.norm(), 1e-9) << frame;  // by symmetry
                ASSERT_LE(std::hypot(b.center_of_mass.x(), b.center_of_mass.z()), 1e-9) << frame;
                ASSERT_GT(b.center_of_mass.y(), 1.049) << frame;
            }
            EXPECT_LE(world.measure().max_penetration, 1e-6);
            if (e == 1.0) {
                EXPECT_NEAR(energy(world) / start, 1.0, 1e-9);
            }
        }
}

// A block of balls, 20 deep, thrown flat at a wall: all rows have impacts at once, row behind row.
TEST(ManyContacts, BlockOfTouchingBallsThrownAtAWall) {
    for (const double e : {0.0, 0.5, 1.0})
        for (const ImpactLaw law : {ImpactLaw::propagating, ImpactLaw::simultaneous}) {
            SceneDescription scene = empty_scene(4);
            scene.simulation.impact_law = law;
            add_fixed_box(scene, {1.0, 30.0, 30.0}, {-1.5, 0.0, 0.0}, e);
            const int side = trials(100) == 100 ? 6 : 3;
            for (int i = 0; i < side * side * side; ++i) {
                BodyDescription& ball =
                    add_sphere(scene, 0.5, {1.0 + i % side, double(i / side % side), double(i / side / side)});
                ball.velocity = Vec3(-2.0, 0.0, 0.0);
                ball.restitution = e;
            }
            make_exact(scene);
            World world(scene);
            const double start = energy(world);
            double before = start;
            for (int frame = 0; frame < 90; ++frame) {
                world.advance_frame();
                ASSERT_LE(energy(world), before + 1e-9 * start) << e << " " << frame;
                before = energy(world);
                ASSERT_LE(world.measure().max_penetration, 1e-6) << e << " " << frame;
            }
            const double back = e * e * start;  // every ball rebounds at e v: also row by row
            if (e != 0.5) {
                EXPECT_NEAR(energy(world), back, 1e-9 * start) << e << " law " << int(law);
            }
        }
}

}  // namespace tumble::zeno_test
