// Exact impacts against closed forms: bouncing balls and boxes, rows of balls, the energy of a crowd.
#include "exact_scenes.h"
#include "sim/random_shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace tumble::exact_impact_test {
using namespace tumble::testing;

namespace {

// SimBenchmark "bouncing" (Kang and Hwangbo 2018): 49 spheres released with their centers at 5 m; the mean over the
// steps of (E - E0)^2, sampled before each step.
double bouncing_metric(const SceneDescription& scene, double duration) {
    World world(scene);
    const auto energy_now = [&] {
        double sum = 0.0;
        for (const BodyState& b : world.snapshot().bodies)
            sum += 10.0 * (0.5 * b.velocity.squaredNorm() + gravity * b.center_of_mass.y());
        return sum;
    };
    const double start = energy_now();
    const auto steps = std::int64_t(std::llround(duration / scene.step()));
    double sum = 0.0;
    for (std::int64_t i = 0; i < steps; ++i) {
        const double error = energy_now() - start;
        sum += error * error;
        world.step();
    }
    return sum / double(steps);
}

SceneDescription bouncing(int side, double rate) {
    SceneDescription scene = ground_scene(1.0, 0.0);
    set_step(scene, rate);
    for (int i = 0; i < side * side; ++i)
        add_sphere(scene, 0.1, {2.0 * (i % side), 5.0, 2.0 * (i / side)}, 10.0).restitution = 1.0;
    return scene;
}

}  // namespace

// ODE's published column, to every digit printed. In steps of 0.1 and 0.01 s its spheres sink into the ground by more
// than a radius; these stop at the ground and lose and gain less energy. All spheres move alike: 49 have 49^2 times the
// metric of one.
TEST(SimBenchmarkBouncing, SteppedIsThePublishedColumn) {
    const auto printed = [](double metric) { return fmt::format("{:.6g}", metric); };
    EXPECT_LT(bouncing_metric(bouncing(7, 10.0), 20.0), 2.03326e+06);
    EXPECT_LT(bouncing_metric(bouncing(7, 100.0), 20.0), 18808.3);
    EXPECT_EQ(printed(49.0 * 49.0 * bouncing_metric(bouncing(1, 1000.0), 20.0)), "185.027");
#ifdef NDEBUG
    EXPECT_EQ(printed(49.0 * 49.0 * bouncing_metric(bouncing(1, 10000.0), 20.0)), "1.85055");
#endif
}

TEST(SimBenchmarkBouncing, ExactHasNoErrorAtAnyStep) {
    for (const double rate : {0.5, 10.0, 60.0, 100.0, 333.0, 1000.0}) {
        SceneDescription scene = bouncing(7, rate);
        make_exact(scene);
        EXPECT_LE(bouncing_metric(scene, 20.0), 1e-14) << rate;
    }
}

// SimBenchmark "elastic 666": 216 spheres of 10 kg in a grid that fall on the ground, e = 1. After a second the motion
// depends on the last digit of the start; the energy does not.
TEST(SimBenchmarkElastic666, EnergyIsKept) {
    SceneDescription scene = ground_scene(1.0, 0.0);
    set_step(scene, 60.0);
    Random random(666);
    for (int i = 0; i < 216; ++i) {
        const Vec3 at(0.21 * (i % 6) + random(0.0, 0.001), 1.101 + 0.21 * (i / 36) + random(0.0, 0.001),
                      0.21 * (i / 6 % 6) + random(0.0, 0.001));
        add_sphere(scene, 0.1, at, 10.0).restitution = 1.0;
    }
    make_exact(scene);
    EXPECT_LE(bouncing_metric(scene, trials(1000) / 100.0), 1e-10);
}

TEST(FlatBox, FollowsTheParabolasWithoutSpin) {
    for (const double rate : {7.0, 60.0, 1000.0}) {
        SceneDescription scene = ground_scene(1.0, 0.0);
        set_step(scene, rate);
        BodyDescription& box = add_box(scene, {1.0, 0.6, 0.8}, {0.0, 1.3, 0.0});
        box.restitution = 1.0;
        make_exact(scene);
        World world(scene);
        for (int frame = 1; frame <= int(10.0 * rate); ++frame) {
            world.advance_frame();
            const BodyState b = world.snapshot().bodies[1];
            ASSERT_NEAR(b.center_of_mass.y() - 0.3, bouncing_clearance(1.0, 1.0, frame / rate), 1e-9)
                << rate << " " << frame;
            ASSERT_LE(b.angular_velocity.norm(), 1e-12) << rate << " " << frame;
            ASSERT_LE(std::hypot(b.center_of_mass.x(), b.center_of_mass.z()), 1e-12);
        }
    }
}

// Boxes in any orientation bounce a hundred times: the energy stays within 1e-10 m g h, horizontal momentum stays zero.
TEST(TiltedBox, EnergyIsKeptOverAHundredImpacts) {
    Random random(3);
    const Vec3 sizes[] = {{1.0, 1.0, 1.0}, {1.0, 0.6, 0.2}, {0.1, 0.1, 2.0}, {1.0, 1.0, 0.02}};
    for (int trial = 0; trial < trials(20); ++trial) {
        SceneDescription scene = ground_scene(1.0, 0.0);
        scene.simulation.steps_per_frame = 1;
        BodyDescription& box = add_box(scene, sizes[trial % 4], {0.0, 2.5, 0.0});
        box.restitution = 1.0;
        box.rotation = trial == 0 ? turn({0.0, 0.0, 1.0}, 0.5) : random.turn();
        if (trial > 8) box.angular_velocity = random.vector(3.0);
        make_exact(scene);
        World world(scene);
        const double start = energy(world), h = 1.0 / 60.0;
        double speed = 0.0;
        int impacts = 0;
        for (int frame = 0; frame < 60 * 200 && impacts < 100; ++frame) {
            world.advance_frame();
            const double now = world.snapshot().bodies[1].velocity.y();
            impacts += std::abs(now - (speed - gravity * h)) > 1e-9;  // frames with at least one impact
            speed = now;
            ASSERT_NEAR(energy(world), start, 1e-10 * gravity * 2.5) << trial << ", frame " << frame;
        }
        EXPECT_EQ(impacts, 100) << trial;
        const Vec3 p = world.measure().momentum;
        EXPECT_LE(std::hypot(p.x(), p.z()), 1e-12);
        EXPECT_LE(world.measure().max_penetration, 1e-11);
    }
}

// h = 5 m, e = 0.8: the hops shrink without limit, and end after t0 (1 + e) / (1 - e) = 9.086738 s. Each trial ends its
// n-th step just before or just after.
TEST(SettlingBall, RestsAtItsTimeAtAnyStep) {
    const double rest = time_of_rest(5.0, 0.8);
    EXPECT_NEAR(rest, 9.086738, 5e-7);
    for (const int steps : {1, 7, 273, 545, 2181, 8723}) {  // of 9 s to 1/960 s
        for (const double offset : {-1e-6, 1e-6}) {
            SceneDescription scene = ground_scene(0.8, 0.0);
            set_step(scene, steps / (rest + offset));
            add_sphere(scene, 0.1, {0.0, 5.1, 0.0}).restitution = 0.8;
            make_exact(scene);
            World world(scene);
            for (int i = 0; i < steps; ++i) world.step();
            const BodyState ball = world.snapshot().bodies[1];
            if (offset < 0.0) {
                EXPECT_GT(ball.velocity.norm(), 1e-7) << steps;
            } else {
                EXPECT_LE(ball.velocity.norm(), 1e-8) << steps;
            }
            EXPECT_NEAR(ball.center_of_mass.y(), 0.1, 1e-11);
        }
    }
}

TEST(SettlingBall, HeightIsTheClosedFormAtAnyStep) {
    for (const double rate : {30.0, 60.0, 240.0, 960.0}) {
        SceneDescription scene = ground_scene(0.8, 0.0);
        set_step(scene, rate);
        add_sphere(scene, 0.1, {0.0, 5.1, 0.0}).restitution = 0.8;
        make_exact(scene);
        World world(scene);
        for (int frame = 1; frame <= int(12.0 * rate); ++frame) {
            world.advance_frame();
            const double height = world.snapshot().bodies[1].center_of_mass.y() - 0.1;
            ASSERT_NEAR(height, bouncing_clearance(5.0, 0.8, frame / rate), 1e-10) << rate << " " << frame;
        }
        EXPECT_LE(world.snapshot().bodies[1].velocity.norm(), 1e-12);
    }
}

// The path up and down: h (1 + e^2) / (1 - e^2) = 22.77778 m. At 5000 frames per second no hop longer than 1e-7 m hides
// between two frames.
TEST(SettlingBall, PathIsTheClosedForm) {
    const double rate = 5000.0;
    SceneDescription scene = ground_scene(0.8, 0.0);
    set_step(scene, rate);
    add_sphere(scene, 0.1, {0.0, 5.1, 0.0}).restitution = 0.8;
    make_exact(scene);
    World world(scene);
    double path = 0.0, height = 5.0, speed = 0.0;
    for (int frame = 0; frame < int(9.5 * rate); ++frame) {
        world.step();
        const BodyState b = world.snapshot().bodies[1];
        const double to = b.center_of_mass.y() - 0.1, v = b.velocity.y();
        if (std::abs(v - speed + gravity / rate) < 1e-9)
            path += speed > 0.0 && v < 0.0 ? (speed * speed + v * v) / (2.0 * gravity) : std::abs(to - height);
        else
            path += std::pow(std::max(speed, 0.0), 2) / gravity + height + to +
                    std::pow(std::min(v, 0.0), 2) / gravity;  // down to the ground and up
        height = to;
        speed = v;
    }
    EXPECT_NEAR(path, 5.0 * 1.64 / 0.36, 1e-5);
}

// --- Rows of balls, e = 1, no gravity
// -----------------------------------------------------------------------------------

namespace {

// The velocities of balls of 1 kg and 0.5 m some time after the first has hit the others, in both modes.
void expect_outcome(const std::vector<Vec3>& places, double speed, ImpactLaw law, const std::vector<Vec3>& outcome) {
    for (const double rate : {3.0, 60.0, 960.0}) {
        SceneDescription scene = empty_scene(1);
        set_step(scene, rate);
        scene.simulation.impact_law = law;
        for (const Vec3& at : places) add_sphere(scene, 0.5, at).restitution = 1.0;
        scene.bodies[0].velocity = Vec3(speed, 0.0, 0.0);
        make_exact(scene);
        World world(scene);
        run(world, scene, 2.0);
        for (std::size_t i = 0; i < places.size(); ++i)
            EXPECT_LE((world.snapshot().bodies[i].velocity - speed * outcome[i]).norm(), 1e-12 * speed)
                << rate << ", ball " << i;
    }
}

std::vector<Vec3> row(int balls, double gap) {
    std::vector<Vec3> places;
    for (int i = 0; i < balls; ++i) places.emplace_back(i == 0 ? -gap : double(i), 0.0, 0.0);
    return places;
}
std::vector<Vec3> along_x(const std::vector<double>& speeds) {
    std::vector<Vec3> v;
    for (const double s : speeds) v.emplace_back(s, 0.0, 0.0);
    return v;
}

}  // namespace

TEST(Cradle, PropagatingTransmitsTheImpulse) {
    for (const double gap : {0.0, 0.3, 1.0}) {
        expect_outcome(row(3, gap), 3.0, ImpactLaw::propagating, along_x({0.0, 0.0, 1.0}));
        expect_outcome(row(5, gap), 3.0, ImpactLaw::propagating, along_x({0.0, 0.0, 0.0, 0.0, 1.0}));
    }
}

// Newton's law at all contacts at once: the others stay together and move off at 2 / n, the first keeps its distance.
TEST(Cradle, SimultaneousIsNewtonsLaw) {
    for (const double gap : {0.0, 0.3, 1.0}) {
        expect_outcome(row(3, gap), 3.0, ImpactLaw::simultaneous, along_x({-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0}));
        expect_outcome(row(5, gap), 3.0, ImpactLaw::simultaneous, along_x({-0.6, 0.4, 0.4, 0.4, 0.4}));
    }
}

// One ball on two that touch: v, at 30 degrees to each line of centers. With J = 2 v cos30 / (1 + 2 cos^2 30) for each,
// the first rebounds at v / 5 and the others part at 2 sqrt(3) / 5 v along their lines.
TEST(BernoullisThreeBalls, AreSymmetricUnderBothLaws) {
    const double c = 0.5 * std::sqrt(3.0), j = 2.0 * std::sqrt(3.0) / 5.0;
    const std::vector<Vec3> places{{-2.0 - c, 0.0, 0.0}, {0.0, 0.5, 0.0}, {0.0, -0.5, 0.0}};
    const std::vector<Vec3> outcome{{-0.2, 0.0, 0.0}, {j * c, 0.5 * j, 0.0}, {j * c, -0.5 * j, 0.0}};
    for (const ImpactLaw law : {ImpactLaw::propagating, ImpactLaw::simultaneous})
        for (const double speed : {1.0, 5.0, 1e-3}) {
            std::vector<Vec3> nearer = places;
            nearer[0].x() = -c - speed;  // one second away
            expect_outcome(nearer, speed, law, outcome);
        }
}

}  // namespace tumble::exact_impact_test
