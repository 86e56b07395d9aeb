// Bodies of several shapes in motion: like the single shape that they add up to, and in ways that no convex body can
// move.
#include "exact_scenes.h"
#include "scene/load.h"
#include "sim/random_shapes.h"
#include "support/compounds.h"

#include <gtest/gtest.h>

namespace tumble::compound_test {
using namespace tumble::testing;

namespace {

BodyDescription& add_compound(SceneDescription& scene, const CompoundShape& shape, const Vec3& position,
                              double friction = 0.5) {
    BodyDescription& body = add_body(scene, shape, position);
    body.restitution = 0.0;
    body.friction = friction;
    return body;
}

// The largest difference of position and orientation of body `i` between two worlds over this number of frames.
double difference(const SceneDescription& a, const SceneDescription& b, std::size_t i, int frames) {
    World first(a), second(b);
    double most = 0.0;
    for (int n = 0; n < frames; ++n) {
        first.advance_frame();
        second.advance_frame();
        const auto x = first.snapshot().bodies[i], y = second.snapshot().bodies[i];
        most = std::max({most, (x.center_of_mass - y.center_of_mass).norm(),
                         (x.orientation.coeffs() - y.orientation.coeffs()).norm()});
    }
    return most;
}

}  // namespace

TEST(Compound, ABoxOfEightBoxesFliesLikeTheBox) {
    const Vec3 size(0.7, 1.1, 0.3);
    for (const auto integrator : {IntegratorKind::symplectic_euler, IntegratorKind::exact}) {
        SceneDescription whole = empty_scene(), parts = empty_scene();
        for (auto* scene : {&whole, &parts}) {
            scene->simulation.integrator = integrator;
            Shape shape = BoxShape{size};
            if (scene == &parts) shape = box_of_eight(size);
            BodyDescription& body = add_body(*scene, shape, {1.0, 2.0, 3.0});
            body.velocity = {1.0, 2.0, -0.5};
            body.angular_velocity = {3.0, 0.2, 1.0};
        }
        EXPECT_LT(difference(whole, parts, 0, 120), 1e-12);
    }
}

TEST(Compound, ABoxOfEightBoxesBouncesAndRestsLikeTheBox) {
    const Vec3 size(0.8, 0.4, 0.6);
    for (const auto impacts : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription whole = ground_scene(0.5, 0.5), parts = ground_scene(0.5, 0.5);
        for (auto* scene : {&whole, &parts}) {
            scene->simulation.impacts = impacts;
            if (impacts == ImpactMode::exact) scene->simulation.integrator = IntegratorKind::exact;
            Shape shape = BoxShape{size};
            if (scene == &parts) shape = box_of_eight(size);
            BodyDescription& body = add_body(*scene, shape, {0.0, 1.0, 0.0});
            body.restitution = 0.5;
            body.friction = 0.5;
        }
        // More points share the same load: equal up to the error of the contact solver.
        EXPECT_LT(difference(whole, parts, 1, 150), 1e-6) << int(impacts);
        World world(parts);
        run(world, parts, 3.0);
        EXPECT_NEAR(world.snapshot().bodies[1].origin.y(), 0.2, 1e-4);
    }
}

TEST(Compound, ATableStandsOnFourLegsAndCarriesABox) {
    SceneDescription scene = ground_scene(0.0, 0.6);
    add_compound(scene, table(), {0.0, 0.05, 0.0});
    add_box(scene, {0.4, 0.4, 0.4}, {0.5, 1.2, 0.2}, 20.0).friction = 0.6;
    add_box(scene, {0.3, 0.3, 0.3}, {0.0, 0.15, 0.0}, 5.0);  // between the legs, inside of a hull
    World world(scene);
    run(world, scene, 3.0);
    const Snapshot s = world.snapshot();
    EXPECT_NEAR(s.bodies[1].origin.y(), 0.0, 1e-3);
    EXPECT_LT(s.bodies[1].orientation.vec().norm(), 1e-2);
    EXPECT_NEAR(s.bodies[2].origin.y(), 1.1, 2e-3);
    EXPECT_LT((s.bodies[3].origin - Vec3(0.0, 0.15, 0.0)).norm(), 1e-3);
    const Measurement m = world.measure();
    EXPECT_LT(m.max_penetration, 1e-3);
    EXPECT_LT(m.kinetic, 1e-6);
}

// Two wheels on an axle, rolling without slip: nothing drives them, nothing brakes them. On a slope of one in a hundred
// they gain g sin / (1 + I/(m r^2)) per second.
TEST(Compound, WheelsRollUniformly) {
    const double r = 0.1, angle = std::atan(0.01), axle = 0.02, wheel = 4.0 / 3.0 * M_PI * r * r * r,
                 rod = axle * axle * 0.6;
    const double inertia = (2.0 * 0.4 * wheel * r * r + rod * axle * axle / 6.0) / ((2.0 * wheel + rod) * r * r);
    for (const double slope : {0.0, angle}) {
        SceneDescription scene = ground_scene(0.0, 0.5);
        scene.simulation.gravity = {9.81 * std::sin(slope), -9.81 * std::cos(slope), 0.0};
        BodyDescription& wheels =
            add_compound(scene,
                         compound_of({part(SphereShape{r}, {0.0, 0.0, 0.3}), part(SphereShape{r}, {0.0, 0.0, -0.3}),
                                      part(BoxShape{Vec3(axle, axle, 0.6)}, Vec3::Zero())}),
                         {0.0, r, 0.0});
        wheels.velocity = {0.003, 0.0, 0.0};
        wheels.angular_velocity = {0.0, 0.0, -0.03};
        World world(scene);
        for (int second = 1; second <= 4; ++second) {
            run(world, scene, 1.0);
            const double expected = 0.003 + 9.81 * std::sin(slope) / (1.0 + inertia) * second;
            EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), expected, 1e-7)
                << "after " << second << " s on a slope of " << slope;
        }
    }
}

// A hoop of 24 convex parts, loaded from its file, on a peg that protrudes from the wall.
TEST(Compound, AHoopHangsOnAPeg) {
    const SceneDescription scene = parse_scene(R"(
        format = 1
        [[body]]
        type = "fixed"
        shape = { type = "box", size = [0.1, 0.1, 2.0] }
        friction = 0.5
        [[body]]
        shape = { type = "mesh", file = "../meshes/hoop.obj", parts = "objects" }
        position = [0.0, -0.25, 0.0]
        rotation = { axis = [1, 0, 0], angle = 90 }
        velocity = [0.3, 0.0, 0.0]
        friction = 0.5
        restitution = 0.0
    )",
                                               TUMBLE_SOURCE_DIR "/assets/scenes/test.toml");
    World world(scene);
    run(world, scene, 4.0);
    const BodyState hoop = world.snapshot().bodies[1];
    // The tube is a ring of radius 0.5 with a thickness of at least 0.14 cos(22.5 degrees) to each side.
    EXPECT_LT((hoop.origin - Vec3(0.0, -0.32, 0.0)).norm(), 0.05);
}

TEST(Compound, HookedLinksDoNotFallApart) {
    for (const auto impacts : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene;
        scene.simulation.impacts = impacts;
        if (impacts == ImpactMode::exact) scene.simulation.integrator = IntegratorKind::exact;
        add_compound(scene, square_link(1.0, 0.2), Vec3::Zero()).type = BodyType::fixed;
        // Each lies in the plane perpendicular to the one above, and reaches through it.
        add_compound(scene, square_link(1.0, 0.2), {0.0, -0.55, 0.0}).rotation = turn(Vec3::UnitY(), 0.5 * M_PI);
        add_compound(scene, square_link(1.0, 0.2), {0.0, -1.1, 0.0}).angular_velocity = {0.0, 0.5, 0.0};
        World world(scene);
        run(world, scene, 2.5);
        const Snapshot s = world.snapshot();
        EXPECT_NEAR(s.bodies[1].origin.y(), -0.6, 0.02) << int(impacts);
        EXPECT_NEAR(s.bodies[2].origin.y(), -1.2, 0.04) << int(impacts);
    }
}

TEST(Compound, HookedLBlocksHoldEachOther) {
    SceneDescription scene;
    // A fixed hook that points up, and one that hangs over its tip.
    const CompoundShape hook = compound_of({part(BoxShape{Vec3(0.8, 0.2, 0.3)}, Vec3::Zero()),
                                            part(BoxShape{Vec3(0.2, 0.4, 0.3)}, {0.3, 0.3, 0.0}),
                                            part(BoxShape{Vec3(0.2, 1.0, 0.3)}, {-0.3, -0.4, 0.0})});
    add_compound(scene, hook, Vec3::Zero(), 0.8).type = BodyType::fixed;
    const CompoundShape hanger = compound_of({part(BoxShape{Vec3(0.8, 0.2, 0.3)}, Vec3::Zero()),
                                              part(BoxShape{Vec3(0.2, 0.4, 0.3)}, {-0.3, -0.3, 0.0}),
                                              part(BoxShape{Vec3(0.2, 1.0, 0.3)}, {0.3, -0.6, 0.0})});
    add_compound(scene, hanger, {0.3, 0.61, 0.0}, 0.8);
    World world(scene);
    run(world, scene, 3.0);
    EXPECT_GT(world.snapshot().bodies[1].origin.y(), -0.2);
    EXPECT_LT(world.measure().max_penetration, 2e-3);
}

// A frictionless box over a floor of twelve boxes side by side: internal edges do not catch it.
TEST(Compound, InternalEdgesBetweenPartsAreSmooth) {
    std::vector<CompoundPart> parts;
    for (int i = 0; i < 12; ++i) parts.push_back(part(BoxShape{Vec3(0.5, 0.2, 2.0)}, {0.5 * i, -0.1, 0.0}));
    SceneDescription scene;
    add_compound(scene, compound_of(parts), Vec3::Zero(), 0.0).type = BodyType::fixed;
    add_box(scene, {0.4, 0.4, 0.4}, {0.0, 0.2, 0.0}).velocity = {2.2, 0.0, 0.0};
    World world(scene);
    run(world, scene, 2.0);
    const BodyState box = world.snapshot().bodies[1];
    EXPECT_NEAR(box.origin.x(), 4.4, 1e-3);
    EXPECT_NEAR(box.origin.y(), 0.2, 1e-4);
    EXPECT_LT(box.orientation.vec().norm(), 1e-3);
}

// Displacements per step far longer than a wall is thick: spinning links and dumbbells thrown at a wall with a frame
// rebound.
TEST(Compound, NothingTunnelsThroughAThinPart) {
    Random random(7);
    const CompoundShape wall = compound_of({part(BoxShape{Vec3(0.005, 40.0, 40.0)}, Vec3::Zero()),
                                            part(BoxShape{Vec3(0.1, 0.1, 40.0)}, {0.0, 20.0, 0.0})});
    const CompoundShape dumbbell =
        compound_of({part(SphereShape{0.05}, {-0.15, 0.0, 0.0}), part(SphereShape{0.05}, {0.15, 0.0, 0.0}),
                     part(BoxShape{Vec3(0.3, 0.02, 0.02)}, Vec3::Zero())});
    for (const bool exact : {false, true}) {
        for (int i = 0; i < 60; ++i) {
            SceneDescription scene = empty_scene(1);
            set_step(scene, i % 2 ? 60.0 : 240.0);
            if (exact) make_exact(scene);
            BodyDescription& plate = add_compound(scene, wall, Vec3::Zero(), 0.0);
            plate.type = BodyType::fixed;
            plate.restitution = 1.0;
            BodyDescription& thrown =
                add_compound(scene, i % 3 ? dumbbell : square_link(0.4, 0.05), {-random(0.4, 10.0), 0.1, -0.2}, 0.0);
            thrown.restitution = 1.0;
            thrown.mass = 1.0;
            thrown.velocity = {random(20.0, 500.0), 0.0, 0.0};
            thrown.rotation = random.turn();
            thrown.angular_velocity = random.vector(std::pow(10.0, random(0.0, 3.0)));
            World world(scene);
            for (int n = 0; n < 140 && world.snapshot().bodies[1].center_of_mass.x() > -12.0; ++n) {
                world.advance_frame();
                ASSERT_LT(world.snapshot().bodies[1].center_of_mass.x(), 0.0)
                    << "throw " << i << ", frame " << n << ", exact " << exact;
            }
            EXPECT_LT(world.measure().momentum.x(), 0.0) << "throw " << i << ", exact " << exact;
        }
    }
}

// A ball and a link fall on a thin table top with a leg.
TEST(Compound, AThinTopStopsFastFallingBodies) {
    for (const bool fixed : {true, false}) {
        SceneDescription scene = empty_scene(1);
        const CompoundShape gate = compound_of({part(BoxShape{Vec3(2.0, 0.02, 2.0)}, Vec3::Zero()),
                                                part(BoxShape{Vec3(0.02, 1.0, 0.02)}, {0.9, -0.5, 0.9})});
        BodyDescription& top = add_compound(scene, gate, Vec3::Zero());
        if (fixed)
            top.type = BodyType::fixed;
        else
            top.mass = 1e6;
        add_sphere(scene, 0.05, {0.1, 5.0, 0.1}).velocity = {0.0, -200.0, 0.0};
        BodyDescription& thrown = add_compound(scene, square_link(0.4, 0.05), {-0.4, 4.0, -0.4});
        thrown.velocity = {0.0, -150.0, 0.0};
        thrown.angular_velocity = {20.0, 5.0, 3.0};
        thrown.mass = 1.0;
        World world(scene);
        for (int n = 0; n < 30; ++n) {
            world.advance_frame();
            const Snapshot s = world.snapshot();
            for (const std::size_t i : {1u, 2u})
                ASSERT_GT(s.bodies[i].origin.y(), s.bodies[0].origin.y()) << "body " << i << " at frame " << n;
        }
    }
}

// Without losses the energy is constant, whichever part hits; and nothing overlaps.
TEST(Compound, ExactImpactsKeepTheEnergy) {
    SceneDescription scene = ground_scene(1.0, 0.0);
    make_exact(scene);
    const auto add = [&](const CompoundShape& shape, const Vec3& at, const Vec3& spin) {
        BodyDescription& body = add_compound(scene, shape, at, 0.0);
        body.restitution = 1.0;
        body.mass = 2.0;
        body.angular_velocity = spin;
    };
    add(table(), {0.0, 1.5, 0.0}, {1.0, 0.5, 2.0});
    add(compound_of({part(SphereShape{0.2}, {-0.4, 0.0, 0.0}), part(SphereShape{0.2}, {0.4, 0.0, 0.0}),
                     part(BoxShape{Vec3(0.8, 0.1, 0.1)}, Vec3::Zero())}),
        {0.2, 3.3, 0.1}, {3.0, 2.0, 1.0});
    World world(scene);
    const double before = energy(world);
    for (int n = 0; n < 90; ++n) {
        world.advance_frame();
        ASSERT_NEAR(energy(world), before, 1e-9 * before) << n;
        ASSERT_LT(world.measure().max_penetration, 1e-9) << n;
    }
}

TEST(Compound, FurnitureIsTheSameForAnyThreads) {
    SceneDescription scene = load_scene(TUMBLE_SOURCE_DIR "/assets/scenes/furniture.toml");
    World one(scene, 1), three(scene, 3);
    for (int n = 0; n < 30; ++n) {
        one.advance_frame();
        three.advance_frame();
    }
    const auto a = one.snapshot().bodies, b = three.snapshot().bodies;
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].origin, b[i].origin) << i;
        EXPECT_EQ(a[i].orientation.coeffs(), b[i].orientation.coeffs()) << i;
    }
}

}  // namespace tumble::compound_test
