// Bodies in water against closed forms of naval architecture.
#include "scene/load.h"
#include "sim/checkpoint/checkpoint_reader.h"
#include "sim/checkpoint/checkpoint_writer.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tumble::water_test {
using namespace tumble::testing;

namespace {

constexpr double pi = std::numbers::pi, g = 9.81;

/// A pool without drag and added mass, where a frame lasts `frame` s.
SceneDescription pool(IntegratorKind integrator, double frame, int steps_per_frame = 16) {
    SceneDescription scene = empty_scene(steps_per_frame);
    scene.simulation.gravity = {0.0, -g, 0.0};
    scene.simulation.integrator = integrator;
    scene.simulation.sleep = false;
    scene.output.fps = 1.0 / frame;
    scene.water = WaterDescription{};
    scene.water->drag = 0.0;
    scene.water->added_mass = false;
    return scene;
}

void frames(World& world, int count) {
    for (int n = 0; n < count; ++n) world.advance_frame();
}

BodyState state(const World& world, std::size_t body = 0) { return world.snapshot().bodies[body]; }

double total(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential + m.elastic;
}

TEST(Water, ABoxHeavesInItsPeriod) {  // W1
    const double period = 1.553892569154785818;
    for (const auto& [integrator, tolerance] : {std::pair(IntegratorKind::runge_kutta_4, 1e-9),
                                                {IntegratorKind::exact, 1e-12},
                                                {IntegratorKind::splitting, 1e-4},
                                                {IntegratorKind::symplectic_euler, 1e-2}}) {
        SceneDescription scene = pool(integrator, period / 8.0, 64);
        float_body(scene, BoxShape{{1.0, 1.0, 1.0}}, 600.0, -0.1 + 0.05);
        World world(scene);
        frames(world, 4);
        EXPECT_NEAR(state(world).center_of_mass.y(), -0.15, tolerance * 0.05);
        frames(world, 4);
        EXPECT_NEAR(state(world).center_of_mass.y(), -0.05, tolerance * 0.05);
        EXPECT_NEAR(state(world).velocity.y(), 0.0, tolerance);
    }
}

TEST(Water, BallsFloatAtTheirDraftsAndHeaveInTheirPeriods) {  // W2
    struct Case {
        double density, draft, period;
    };
    for (const auto& [density, draft, period] : {Case{0.25, 0.3263518223330696511, 0.8733335676327499},
                                                 {0.4, 0.4329310771477317638, 1.0453757720677849},
                                                 {0.5, 0.5, 1.1582031381206313},
                                                 {0.9, 0.8041998943409082825, 1.9579541943986984}}) {
        SceneDescription scene = pool(IntegratorKind::exact, period);
        float_body(scene, SphereShape{0.5}, 1000.0 * density, 0.5 - draft);
        const double lifted = 1e-5;
        float_body(scene, SphereShape{0.5}, 1000.0 * density, 0.5 - draft + lifted).position.x() = 3.0;
        World world(scene);
        frames(world, 1);
        EXPECT_NEAR(state(world).center_of_mass.y(), 0.5 - draft, 1e-13);
        const double speed = 2.0 * pi / period * lifted;
        EXPECT_NEAR(state(world, 1).velocity.y(), 0.0, 1e-4 * speed);
        EXPECT_NEAR(state(world, 1).center_of_mass.y(), 0.5 - draft + lifted, 1e-8 * lifted + 1e-13);
    }
}

TEST(Water, ABallThatIsLetGoHasItsExactPeriod) {  // W3
    SceneDescription scene = pool(IntegratorKind::exact, 1.2143743491353508);
    float_body(scene, SphereShape{0.5}, 500.0, 0.3);
    World world(scene);
    frames(world, 1);
    EXPECT_NEAR(state(world).center_of_mass.y(), 0.3, 1e-12);
    EXPECT_NEAR(state(world).velocity.y(), 0.0, 1e-11);
}

TEST(Water, ACuboidRollsInItsPeriod) {  // W4
    struct Case {
        double breadth, height, density, period;
    };
    for (const auto& [b, h, s, period] : {Case{1.5, 1.0, 0.5, 2.952850200990749}, {2.0, 0.5, 0.6, 1.187270741028457}}) {
        SceneDescription scene = pool(IntegratorKind::exact, period);
        BodyDescription& body = float_body(scene, BoxShape{{b, h, 4.0}}, 1000.0 * s, h * (0.5 - s));
        const double angle = 1e-5;
        body.rotation = turn({0.0, 0.0, 1.0}, angle);
        World world(scene);
        frames(world, 1);
        EXPECT_NEAR(2.0 * state(world).orientation.z(), angle, 1e-7 * angle);
        EXPECT_NEAR(state(world).angular_velocity.z(), 0.0, 1e-6 * angle);
    }
}

/// Cosine of the angle between the vertical and the nearest axis of the body.
double nearest_axis(const World& world) {
    return state(world).orientation.toRotationMatrix().row(1).cwiseAbs().maxCoeff();
}

SceneDescription tipped(const Vec3& size, double seconds) {
    SceneDescription scene = pool(IntegratorKind::runge_kutta_4, seconds, int(seconds * 60.0));
    scene.water->drag = 1.0;
    scene.water->viscosity = 300.0;
    float_body(scene, BoxShape{size}, 500.0, 0.0).rotation = turn({0.3, 0.0, 1.0}, 0.1 * pi / 180.0);
    return scene;
}

TEST(Water, ABoxOfHalfDensityIsUprightIfItIsBroadEnough) {
    const double limit = 1.2247448713915890;
    World broad(tipped({1.03 * limit, 1.0, 4.0}, 60.0)), narrow(tipped({0.97 * limit, 1.0, 4.0}, 60.0));
    frames(broad, 1);
    frames(narrow, 1);
    EXPECT_GT(nearest_axis(broad), 1.0 - 1e-5);
    EXPECT_LT(nearest_axis(narrow), std::cos(0.1));
}

TEST(Water, ABarEndsEdgeUpAndACubeCornerUp) {  // W5
    World bar(tipped({1.0, 1.0, 4.0}, 120.0)), cube(tipped({1.0, 1.0, 1.0}, 120.0));
    frames(bar, 1);
    frames(cube, 1);
    const auto up = [](const World& world) -> Vec3 {
        return state(world).orientation.toRotationMatrix().row(1).transpose().cwiseAbs();
    };
    EXPECT_LT((up(bar) - Vec3(std::sqrt(0.5), std::sqrt(0.5), 0.0)).norm(), 1e-6);
    EXPECT_LT((up(cube) - Vec3::Constant(std::sqrt(1.0 / 3.0))).norm(), 1e-6);
}

TEST(Water, ABallSinksByTheLawOfDrag) {  // W6
    struct Case {
        bool added;
        double speed, depth;
    };
    for (const auto& [added, speed, depth] :
         {Case{false, 2.2865833522044439, 1.5902845416}, {true, 2.1956260697644816, 1.4260947903}}) {
        SceneDescription scene = pool(IntegratorKind::exact, 1.0, 60);
        scene.water->drag = 0.47;
        scene.water->added_mass = added;
        float_body(scene, SphereShape{0.1}, 2000.0, -1.0);
        World world(scene);
        frames(world, 1);
        EXPECT_NEAR(state(world).velocity.y(), -speed, 1e-11);
        EXPECT_NEAR(state(world).center_of_mass.y(), -1.0 - depth, 1e-9);
        frames(world, 9);
        EXPECT_NEAR(state(world).velocity.y(), -2.3592281464090137, 1e-11);
    }
}

TEST(Water, ASparFollowsLongWaves) {  // W10
    const double omega = 2.0 * pi / 3.0, amplitude = 1e-3;
    SceneDescription scene = pool(IntegratorKind::runge_kutta_4, 3.0, 600);
    scene.water->waves.push_back({2.0 * amplitude, 2.0 * pi * g / (omega * omega), {1.0, 0.0, 0.0}, 0.0});
    // A stick of 1 m, which floats upright by its given center of mass, with the motion of the long run.
    const double heave = 1.0299183063485421 * amplitude;
    BodyDescription& spar = float_body(scene, BoxShape{{0.02, 1.0, 0.02}}, 500.0, heave);
    spar.center_of_mass = Vec3(0.0, -0.3, 0.0);
    World world(scene);
    double highest = -1.0, lowest = 1.0;
    for (int n = 0; n < 3; ++n) {
        frames(world, 1);
        const double y = state(world).origin.y();
        highest = std::max(highest, y);
        lowest = std::min(lowest, y);
    }
    EXPECT_NEAR(highest, heave, 2e-3 * heave);
    EXPECT_NEAR(lowest, heave, 2e-3 * heave);
}

TEST(Water, KeepsTheEnergyOfABallForAHundredPeriods) {  // W11
    for (const auto& [integrator, drift] : {std::pair(IntegratorKind::runge_kutta_4, 1e-10),
                                            {IntegratorKind::symplectic_euler, 1e-2},
                                            {IntegratorKind::splitting, 1e-5}}) {
        SceneDescription scene = pool(integrator, 16.0 / 960.0);
        float_body(scene, SphereShape{0.5}, 500.0, 0.3);
        World world(scene);
        const double start = total(world), scale = 500.0 * pi / 6.0 * g * 0.3;
        double worst = 0.0;
        for (int n = 0; n < 7286; ++n) {
            frames(world, 1);
            worst = std::max(worst, std::abs(total(world) - start) / scale);
        }
        EXPECT_LT(worst, drift);
    }
}

TEST(Water, ABodyWhollyUnderAcceleratesByItsDensity) {  // W12
    for (const double density : {100.0, 900.0, 2500.0})
        for (const bool added : {false, true}) {
            SceneDescription scene = pool(IntegratorKind::runge_kutta_4, 0.01, 1);
            scene.water->added_mass = added;
            float_body(scene, SphereShape{0.2}, density, -3.0);
            World world(scene);
            frames(world, 1);
            const double expected = g * (1000.0 - density) / (density + (added ? 500.0 : 0.0));
            EXPECT_NEAR(state(world).velocity.y(), 0.01 * expected, 1e-13 * std::abs(expected));
        }
}

TEST(Water, BodiesOnTheBottomCarryWhatBuoyancyLeaves) {
    SceneDescription scene = pool(IntegratorKind::symplectic_euler, 1.0 / 60.0);
    scene.water->level = 10.0;
    scene.water->added_mass = true;
    scene.water->drag = 1.0;
    add_body(scene, PlaneShape{}, Vec3::Zero()).type = BodyType::fixed;
    float_body(scene, BoxShape{{1.0, 1.0, 1.0}}, 3000.0, 0.5);
    World world(scene);
    world.record_contacts();
    frames(world, 10);
    double load = 0.0;
    for (const ContactRecord& contact : world.contact_records().contacts) load += contact.normal_force;
    EXPECT_NEAR(load, 2000.0 * g, 1e-6 * 2000.0 * g);
}

TEST(Water, TheBooksCloseWithDragAddedMassAndImpacts) {
    for (const IntegratorKind integrator : {IntegratorKind::symplectic_euler, IntegratorKind::runge_kutta_4}) {
        SceneDescription scene = pool(integrator, 1.0 / 60.0);
        scene.water->drag = 0.8;
        scene.water->added_mass = true;
        scene.water->level = 1.0;
        add_body(scene, PlaneShape{}, Vec3::Zero()).type = BodyType::fixed;
        float_body(scene, BoxShape{{0.5, 0.3, 0.4}}, 400.0, 1.8).rotation = turn({1.0, 0.3, 0.2}, 0.7);
        float_body(scene, SphereShape{0.2}, 2500.0, 1.5).position.x() = 2.0;
        World world(scene);
        world.record_energy();
        const double start = total(world);
        for (int n = 0; n < 180; ++n) {
            frames(world, 1);
            const EnergyLedger& e = world.contact_records().energy;
            EXPECT_NEAR(total(world) + e.impact_loss + e.friction_loss + e.water_loss - e.work, start, 0.02 * start)
                << n;
            EXPECT_NEAR(e.work, 0.0, 1e-9 * start);
        }
        EXPECT_GT(world.contact_records().energy.water_loss, 100.0);
    }
}

TEST(Water, ACurrentCarriesAndADragNeverPushes) {
    SceneDescription scene = pool(IntegratorKind::symplectic_euler, 0.1);
    scene.water->drag = 1.0;
    scene.water->added_mass = true;
    scene.water->current = {1.0, 0.0, 0.0};
    float_body(scene, BoxShape{{0.4, 0.4, 0.4}}, 1000.0, -2.0);
    World world(scene);
    double last = 0.0;
    for (int n = 0; n < 100; ++n) {
        frames(world, 1);
        const double speed = state(world).velocity.x();
        EXPECT_GE(speed, last);
        EXPECT_LT(speed, 1.0);
        last = speed;
    }
    EXPECT_GT(last, 0.85);
}

TEST(Water, LightBodiesAndThinPlatesStayTame) {
    for (const IntegratorKind integrator : {IntegratorKind::explicit_euler, IntegratorKind::symplectic_euler,
                                            IntegratorKind::splitting, IntegratorKind::runge_kutta_4}) {
        SceneDescription scene = pool(integrator, 1.0 / 60.0);
        scene.water->drag = 1.0;
        scene.water->added_mass = true;
        float_body(scene, BoxShape{{0.5, 2e-5, 0.5}}, 500.0, 5e-6);                     // draft 10 um
        float_body(scene, BoxShape{{0.5, 2e-3, 0.5}}, 500.0, 0.01).position.x() = 2.0;  // draft 1 mm
        float_body(scene, SphereShape{0.2}, 1.0, -2.0).position.x() = 4.0;              // a thousandth of water
        float_body(scene, SphereShape{0.2}, 1e6, 1.0).position.x() = 6.0;               // a thousandfold
        World world(scene);
        frames(world, 300);
        for (std::size_t i = 0; i < 2; ++i)
            EXPECT_NEAR(state(world, i).center_of_mass.y(), 0.0, i == 0 ? 2e-5 : 2e-3) << i;
        EXPECT_NEAR(state(world, 2).center_of_mass.y(), 0.2, 0.02);
        EXPECT_LT(state(world, 3).center_of_mass.y(), -50.0);
    }
}

TEST(Water, AFloatingBodyFallsAsleepOnStillWaterOnly) {
    for (const bool waves : {false, true}) {
        SceneDescription scene = pool(IntegratorKind::symplectic_euler, 1.0 / 60.0);
        scene.simulation.sleep = true;
        scene.water->drag = 1.0;
        scene.water->added_mass = true;
        if (waves) scene.water->waves.push_back({1e-3, 2.0});
        float_body(scene, BoxShape{{0.6, 0.2, 0.5}}, 500.0, 0.01);
        World world(scene);
        frames(world, 60 * 60);
        EXPECT_EQ(state(world).asleep, !waves);
        EXPECT_NEAR(state(world).center_of_mass.y(), 0.0, 1e-3);
    }
}

TEST(Water, ExactImpactsAndStepsAgree) {
    SceneDescription scene = pool(IntegratorKind::exact, 0.1);
    scene.water->drag = 0.5;
    scene.water->added_mass = true;
    float_body(scene, SphereShape{0.2}, 600.0, 0.5);
    World stepped(scene);
    scene.simulation.impacts = ImpactMode::exact;
    World exact(scene);
    frames(stepped, 20);
    frames(exact, 20);
    EXPECT_LT((state(stepped).center_of_mass - state(exact).center_of_mass).norm(), 1e-9);
}

TEST(Water, EveryNumberOfThreadsGivesTheSameBytes) {
    SceneDescription scene = pool(IntegratorKind::symplectic_euler, 1.0 / 60.0);
    scene.water->drag = 1.0;
    scene.water->added_mass = true;
    scene.water->waves.push_back({0.1, 3.0});
    for (int n = 0; n < 60; ++n)
        float_body(scene, BoxShape{{0.3, 0.2, 0.25}}, 300.0 + 10.0 * n, 0.1 * n).position.x() = 0.05 * n;
    World one(scene, 1), eight(scene, 8);
    frames(one, 60);
    frames(eight, 60);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        EXPECT_EQ(state(one, i).center_of_mass, state(eight, i).center_of_mass);
        EXPECT_EQ(state(one, i).orientation.coeffs(), state(eight, i).orientation.coeffs());
    }
}

TEST(Water, AResumedRunGivesTheSameBytes) {
    SceneDescription scene = pool(IntegratorKind::symplectic_euler, 1.0 / 60.0);
    scene.water->drag = 1.0;
    scene.water->added_mass = true;
    for (int n = 0; n < 8; ++n)
        float_body(scene, BoxShape{{0.3, 0.2, 0.25}}, 300.0 + 50.0 * n, 0.2 * n).position.x() = 0.05 * n;
    World whole(scene), first(scene), second(scene);
    for (World* world : {&whole, &first, &second}) world->record_contacts();
    frames(whole, 60);
    frames(first, 30);
    CheckpointWriter writer;
    first.save(writer);
    CheckpointReader reader(writer.bytes());
    second.restore(reader);
    frames(second, 30);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        EXPECT_EQ(state(whole, i).center_of_mass, state(second, i).center_of_mass);
    EXPECT_EQ(whole.contact_records().energy.water_loss, second.contact_records().energy.water_loss);
}

TEST(Water, AnEelSwimsHeadFirst) {
    const SceneDescription scene = load_scene(TUMBLE_SOURCE_DIR "/assets/scenes/eel.toml");
    World world(scene);
    const auto place = [&] {
        Vec3 sum = Vec3::Zero();
        double mass = 0.0;
        for (const BodyState& body : world.snapshot().bodies) {
            sum += body.mass * body.center_of_mass;
            mass += body.mass;
        }
        return Vec3(sum / mass);
    };
    frames(world, 120);
    const Vec3 early = place();
    frames(world, 240);
    const Vec3 swum = place() - early;
    EXPECT_GT(swum.x(), 0.4);  // the head is at +x
    EXPECT_LT(std::abs(swum.z()), 0.3 * swum.x());
}

TEST(Water, WavesDoNotTurnABall) {
    SceneDescription scene = pool(IntegratorKind::runge_kutta_4, 1.0 / 60.0);
    scene.water->drag = 1.0;
    scene.water->added_mass = true;
    scene.water->waves.push_back({0.3, 4.0, {0.6, 0.0, 0.8}});
    float_body(scene, SphereShape{0.2}, 1.0, 0.3);
    float_body(scene, SphereShape{0.2}, 500.0, 0.3).position.x() = 2.0;
    World world(scene);
    frames(world, 180);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(state(world, i).angular_velocity.norm(), 1e-9) << i;
}

TEST(Water, APaddleWheelDrivesItsBoat) {
    const SceneDescription harbor = load_scene(TUMBLE_SOURCE_DIR "/assets/scenes/harbor.toml");
    for (const double turns : {1.0, -1.0}) {
        SceneDescription scene = harbor;
        scene.water->waves.clear();
        scene.bodies.clear();
        for (const BodyDescription& body : harbor.bodies)
            if (body.name == "steamer" || body.name == "wheel") scene.bodies.push_back(body);
        scene.cords.clear();
        ASSERT_EQ(scene.joints.size(), 1u);
        JointDescription& axle = scene.joints[0];
        axle.first = 0;
        axle.second = 1;
        ASSERT_TRUE(axle.turn[0].motor.has_value());
        axle.turn[0].motor->speed = turns * axle.turn[0].motor->speed.value();
        const double start = scene.bodies[0].position.x();
        World world(scene);
        frames(world, 240);
        EXPECT_GT(turns * (state(world).center_of_mass.x() - start), 0.5);
    }
}

// A board breaks on a rock above the water; its pieces float as boards of their own.
TEST(Water, PiecesFloatByTheirOwnVolumes) {
    const SceneDescription scene = parse_scene(
        "format = 1\n[simulation]\nduration = 10\n[water]\nviscosity = 60\n"
        "[materials.board]\ndensity = 500\nstrength = 1e5\nstiffness = 1e9\ntoughness = 1\nrestitution = 0\n"
        "[[body]]\nname = \"rock\"\ntype = \"fixed\"\nshape = { type = \"box\", size = [0.1, 1, 1] }\n"
        "[[body]]\nname = \"board\"\nmaterial = \"board\"\nshape = { type = \"box\", size = [2, 0.1, 0.4] }\n"
        "fracture = { cells = 6, pattern = \"slabs\", seed = 3 }\nposition = [0, 2, 0]\n",
        "board.toml");
    World world(scene);
    frames(world, 600);
    std::size_t pieces = 0;
    const Snapshot snapshot = world.snapshot();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!scene.bodies[i].piece_of || snapshot.bodies[i].absent) continue;
        ++pieces;
        EXPECT_GT(snapshot.bodies[i].center_of_mass.y(), -0.1) << i;
        EXPECT_LT(snapshot.bodies[i].center_of_mass.y(), 0.1) << i;
    }
    EXPECT_GE(pieces, 2u);
}

}  // namespace
}  // namespace tumble::water_test
