// Contact under bad and hard input: overlaps at the start, exact coincidences, extreme shapes and sizes, internal
// edges, belts.
#include "core/deterministic_math.h"
#include "sim/contact/model/settings.h"
#include "sim/random_shapes.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::contact_hard_input_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

void set_friction(SceneDescription& scene, double friction) {
    for (BodyDescription& body : scene.bodies) {
        body.friction = friction;
        body.restitution = 0.0;
    }
}

bool finite(const Snapshot& s) {
    for (const BodyState& b : s.bodies)
        if (!(b.origin.allFinite() && b.orientation.coeffs().allFinite() && b.velocity.allFinite() &&
              b.angular_velocity.allFinite()))
            return false;
    return true;
}

/// The fastest motion of a center in the next steps, m/s, position correction included.
struct Watch {
    double fastest = 0.0;
    void follow(World& world, double h, int steps) {
        Snapshot before = world.snapshot();
        for (int k = 0; k < steps; ++k) {
            world.step();
            const Snapshot now = world.snapshot();
            ASSERT_TRUE(finite(now)) << k;
            for (std::size_t i = 0; i < now.bodies.size(); ++i)
                fastest =
                    std::max(fastest, (now.bodies[i].center_of_mass - before.bodies[i].center_of_mass).norm() / h);
            before = now;
        }
    }
};

}  // namespace

// Two boxes or balls that overlap by half in free space: pushed apart no faster than correction_limit radii per second,
// left with no speed, and no overlap.
TEST(ContactHardInput, OverlapsDissolveSlowly) {
    for (const bool boxes : {false, true})
        for (const double depth : {0.1, 0.5, 0.9})
            for (const int steps : {1, 4, 16}) {
                SceneDescription scene = empty_scene(steps);
                for (const double at : {0.0, 1.0 - depth})
                    boxes ? add_box(scene, {1.0, 1.0, 1.0}, {at, 0.01 * at, 0.0})
                          : add_sphere(scene, 0.5, {at, 0.0, 0.0});
                set_friction(scene, 0.3);
                World world(scene);
                Watch watch;
                watch.follow(world, scene.step(), 120 * steps);
                const double radius = boxes ? std::sqrt(0.75) : 0.5;
                EXPECT_LE(watch.fastest, 1.01 * tuning::correction_limit * radius)
                    << boxes << " " << depth << " " << steps;
                EXPECT_LE(world.measure().max_penetration, 1e-3) << boxes << " " << depth << " " << steps;
                EXPECT_LE(world.measure().kinetic, 1e-6) << boxes << " " << depth << " " << steps;
            }
}

// A crowd that starts as a heap: boxes placed in too small a volume. Many pushes add up in it: no box moves faster than
// a few limits (measured: 24 m/s, 5.5 limits), and all are separated in the end.
TEST(ContactHardInput, ACrowdDissolves) {
    Random random(3);
    SceneDescription scene = ground_scene(0.0, 0.5, 4);
    for (int i = 0; i < 30; ++i)
        add_box(scene, {1.0, 1.0, 1.0}, {random(-1.2, 1.2), random(0.6, 2.6), random(-1.2, 1.2)}).rotation =
            random.turn();
    set_friction(scene, 0.5);
    World world(scene);
    Watch watch;
    watch.follow(world, scene.step(), 240 * 5);
    EXPECT_LE(watch.fastest, 8.0 * tuning::correction_limit * std::sqrt(0.75));
    EXPECT_LE(world.measure().max_penetration, 2e-3);
    for (const BodyState& b : world.snapshot().bodies) EXPECT_LE(b.center_of_mass.norm(), 15.0);
}

// The same box twice: all directions are equal, one is chosen.
TEST(ContactHardInput, ABoxExactlyInsideAnother) {
    for (const double small : {1.0, 0.5, 0.01})
        for (const int steps : {1, 16}) {
            SceneDescription scene = empty_scene(steps);
            add_box(scene, {1.0, 1.0, 1.0}, Vec3::Zero());
            add_box(scene, small * Vec3(1.0, 1.0, 1.0), Vec3::Zero());
            set_friction(scene, 0.3);
            World world(scene);
            Watch watch;
            watch.follow(world, scene.step(), 840 * steps);
            EXPECT_LE(watch.fastest, 1.01 * tuning::correction_limit * std::sqrt(0.75)) << small << " " << steps;
            EXPECT_LE(world.measure().max_penetration, 1e-3 * small) << small << " " << steps;
            EXPECT_LE(world.measure().momentum.norm(), 1e-9) << small << " " << steps;
        }
}

// A floor of tiles with coplanar faces: boxes rest on the joint of two, on the corner of four and flush with edges.
TEST(ContactHardInput, TilesOfOneFloor) {
    SceneDescription scene = empty_scene(4);
    scene.simulation.gravity = Vec3(0.0, -g, 0.0);
    for (int i = 0; i < 7; ++i)
        for (int k = 0; k < 3; ++k)
            add_box(scene, {1.0, 1.0, 1.0}, {double(i), -0.5, double(k) - 1.0}).type = BodyType::fixed;
    for (const Vec3& at : {Vec3(4.5, 0.3, -0.5), Vec3(0.5, 0.3, 0.0), Vec3(2.2, 0.3, 0.2), Vec3(2.8, 0.3, 0.2)})
        add_box(scene, {0.6, 0.6, 0.6}, at);
    set_friction(scene, 0.2);
    World world(scene);
    run(world, scene, 3.0);
    const Snapshot s = world.snapshot();
    for (std::size_t i = 21; i < s.bodies.size(); ++i)
        EXPECT_LE((s.bodies[i].center_of_mass - scene.bodies[i].position).norm(), 1e-5) << i;
}

// The same floor under boxes that slide, fast and slow, straight and diagonally, over joints: they stop after
// v^2 / (2 mu g) and keep their direction.
TEST(ContactHardInput, SlidingOverTiles) {
    for (const double speed : {3.0, 1.0, 0.3, 0.05})
        for (const double aside : {0.0, 0.2}) {
            SceneDescription scene = empty_scene(4);
            scene.simulation.gravity = Vec3(0.0, -g, 0.0);
            const double mu = 0.1, way = speed * speed / (2.0 * mu * g);
            for (int i = -1; i < 8; ++i)
                for (int k = -2; k < 4; ++k)
                    add_box(scene, {1.0, 1.0, 1.0}, {double(i), -0.5, double(k)}).type = BodyType::fixed;
            const Vec3 direction = Vec3(1.0, 0.0, aside).normalized();
            const Vec3 start(0.2 - 0.3 * way, 0.3,
                             0.2 - 0.1 * way);  // its front reaches a joint at 0.3 of the displacement
            add_box(scene, {0.6, 0.6, 0.6}, start).velocity = speed * direction;
            set_friction(scene, mu);
            World world(scene);
            run(world, scene, 1.2 * speed / (mu * g) + 0.1);
            const BodyState box = world.snapshot().bodies.back();
            const double step_way = speed * scene.step();  // friction begins and ends with a step
            EXPECT_NEAR((box.center_of_mass - start).dot(direction), way, step_way + 1e-3 * way)
                << speed << " " << aside;
            EXPECT_LE((box.center_of_mass - start).cross(direction).norm(), 1e-3 * way) << speed << " " << aside;
        }
}

// Beams that lie crosswise, and beams whose upper edges are exactly parallel: on edge in a groove of two others.
TEST(ContactHardInput, ParallelAndCrossingEdges) {
    SceneDescription scene = ground_scene(0.0, 0.6, 4);
    for (int level = 0; level < 6; ++level)
        for (const double side : {-1.0, 1.0}) {
            BodyDescription& beam =
                add_box(scene, {3.0, 0.2, 0.2},
                        level % 2 ? Vec3(side, 0.1 + 0.2 * level, 0.0) : Vec3(0.0, 0.1 + 0.2 * level, side));
            if (level % 2) beam.rotation = turn(Vec3::UnitY(), 0.5 * pi);
        }
    // Two lie beside each other with a gap of a quarter; a third stands on its edge in the gap.
    for (const double side : {-1.0, 1.0}) add_box(scene, {2.0, 0.5, 0.5}, {10.0, 0.25, side * 0.375});
    add_box(scene, {2.0, 0.3, 0.3}, {10.0, 0.5 - 0.125 + 0.15 * std::sqrt(2.0), 0.0}).rotation =
        turn(Vec3::UnitX(), 0.25 * pi);
    set_friction(scene, 0.6);
    World world(scene);
    run(world, scene, 5.0);
    const Snapshot s = world.snapshot();
    for (std::size_t i = 1; i < s.bodies.size(); ++i)
        EXPECT_LE((s.bodies[i].center_of_mass - scene.bodies[i].position).norm(), 1e-3) << i;
    EXPECT_LE(world.measure().max_penetration, 1e-3);
}

// Needles and plates of 1 : 1000, on the floor, on each other, and standing on end.
TEST(ContactHardInput, NeedlesAndPlatesLieStill) {
    SceneDescription scene = ground_scene(0.0, 0.6, 4);
    add_box(scene, {1.0, 1e-3, 1e-3}, {0.0, 0.5e-3, 0.0});
    add_box(scene, {1.0, 1e-3, 1.0}, {3.0, 0.5e-3, 0.0});
    add_box(scene, {1.0, 1e-3, 1.0}, {3.0, 1.5e-3, 0.0});
    add_box(scene, {1.0, 1e-3, 1e-3}, {3.0, 2.5e-3, 0.1});
    add_box(scene, {0.02, 1.0, 0.02}, {6.0, 0.5, 0.0});
    set_friction(scene, 0.6);
    World world(scene);
    run(world, scene, 5.0);
    const Snapshot s = world.snapshot();
    for (std::size_t i = 1; i < s.bodies.size(); ++i)
        EXPECT_LE((s.bodies[i].center_of_mass - scene.bodies[i].position).norm(), 2e-6) << i;
}

// They fall in a heap, 1 : 50 thin: finite, above the floor, at rest in the end. (Needles of 1 : 1000, whose moments
// are 1 : 1e6, gain energy in contact: the pose's step is of first order, and its error turns L into spin.)
TEST(ContactHardInput, NeedlesAndPlatesFallInAHeap) {
    Random random(8);
    SceneDescription scene = ground_scene(0.0, 0.6, 4);
    for (int i = 0; i < 16; ++i) {
        const double thin = i % 4 < 2 ? 0.02 : 0.05;
        BodyDescription& body =
            add_box(scene, i % 2 ? Vec3(1.0, thin, thin) : Vec3(0.8, thin, 0.8), {0.1 * i, 0.6 + 0.3 * i, 0.0}, 0.1);
        body.rotation = random.turn();
    }
    set_friction(scene, 0.6);
    World world(scene);
    const double start = world.measure().kinetic + world.measure().potential;
    for (int second = 0; second < 8; ++second) {
        run(world, scene, 1.0);
        ASSERT_TRUE(finite(world.snapshot()));
        EXPECT_LE(world.measure().kinetic + world.measure().potential, start);
    }
    for (const BodyState& b : world.snapshot().bodies) EXPECT_GE(b.center_of_mass.y(), -1e-3);
    EXPECT_LE(world.measure().kinetic, 1e-3);
}

// 1 m on 100 m; and 100 m, 1 m and 1 mm beside each other, 1e15 in mass. Each rests within a hundred-thousandth of its
// size.
TEST(ContactHardInput, AMillimeterAndAHundredMeters) {
    SceneDescription scene = ground_scene(0.0, 0.5, 4);
    const double sizes[] = {100.0, 1.0, 100.0, 1.0, 0.001};
    const Vec3 places[] = {
        {0.0, 50.0, 0.0}, {0.0, 100.5, 0.0}, {200.0, 50.0, 0.0}, {251.0, 0.5, 0.0}, {252.0, 0.5e-3, 0.0}};
    for (std::size_t k = 0; k < 5; ++k) add_box(scene, sizes[k] * Vec3(1.0, 1.0, 1.0), places[k]).mass.reset();
    set_friction(scene, 0.5);
    World world(scene);
    run(world, scene, 5.0);
    const Snapshot s = world.snapshot();
    for (std::size_t k = 0; k < 5; ++k)
        EXPECT_LE((s.bodies[k + 1].center_of_mass - places[k]).norm(), 1e-5 * sizes[k]) << k;
}

// Dust of 1e-24 kg and moons of 1e24 kg pile up as crates do: powers of two in mass change no digit in single
// precision.
TEST(ContactHardInput, DustAndMoons) {
    const auto heap = [](double mass) {
        SceneDescription scene = ground_scene(0.0, 0.5, 4);
        scene.simulation.contact_solver = ContactSolverChoice::soft;
        for (int k = 0; k < 12; ++k)
            add_box(scene, {0.5, 0.3, 0.4}, {0.1 * (k % 3), 0.16 + 0.31 * k, 0.07 * (k % 2)}, mass);
        set_friction(scene, 0.5);
        World world(scene);
        run(world, scene, 2.0);
        return world.snapshot();
    };
    const Snapshot crates = heap(1.0);
    for (const int power : {-80, 80}) {
        const Snapshot others = heap(std::ldexp(1.0, power));
        for (std::size_t i = 1; i < crates.bodies.size(); ++i)
            EXPECT_EQ(others.bodies[i].center_of_mass, crates.bodies[i].center_of_mass) << power << ' ' << i;
    }
}

// Boxes and balls resting on and sliding over the internal edges of a triangle mesh: no bumps, no deflection.
TEST(ContactHardInput, InternalEdgesOfAMesh) {
    for (const double friction : {0.0, 0.2})
        for (const int steps : {1, 16}) {
            SceneDescription scene = empty_scene(steps);
            scene.simulation.gravity = Vec3(0.0, -g, 0.0);
            add_body(scene, MeshShape{asset_of(grid_mesh(16, 8.0, 0.0))}, Vec3::Zero()).type = BodyType::fixed;
            const Vec3 velocity(2.5, 0.0, 0.7);
            add_box(scene, {0.7, 0.4, 0.9}, {-4.0, 0.2, 0.1}).velocity = velocity;    // over internal edges
            add_box(scene, {0.6, 0.6, 0.6}, {0.0, 0.3, -4.0});                        // on a vertex of six
            add_sphere(scene, 0.5, {1.0, 0.5, 5.0});                                  // on a vertex
            add_sphere(scene, 0.5, {-3.3, 0.5, 5.0}).velocity = Vec3(0.9, 0.0, 0.0);  // along an internal edge
            set_friction(scene, friction);
            World world(scene);
            run(world, scene, 1.0);
            const Snapshot s = world.snapshot();
            const double share = 1.0 - friction * g / velocity.norm();
            EXPECT_LE((s.bodies[1].velocity - share * velocity).norm(), 1e-4) << friction << " " << steps;
            EXPECT_NEAR(s.bodies[1].center_of_mass.y(), 0.2, 1e-5) << friction << " " << steps;
            EXPECT_LE((s.bodies[2].center_of_mass - Vec3(0.0, 0.3, -4.0)).norm(), 1e-6);
            EXPECT_LE((s.bodies[3].center_of_mass - Vec3(1.0, 0.5, 5.0)).norm(), 1e-6);
            EXPECT_NEAR(s.bodies[4].velocity.x(), friction > 0.0 ? 0.9 * 5.0 / 7.0 : 0.9, 1e-4)
                << friction << " " << steps;
            EXPECT_LE(std::abs(s.bodies[4].velocity.z()) + std::abs(s.bodies[4].velocity.y()), 1e-6);
        }
}

// A belt that starts at full speed: mu g until the box moves with it, then as one.
TEST(ContactHardInput, ABeltCarriesABoxAlong) {
    for (const int steps : {1, 4, 16}) {
        SceneDescription scene = empty_scene(steps);
        scene.simulation.gravity = Vec3(0.0, -g, 0.0);
        BodyDescription& belt = add_box(scene, {40.0, 1.0, 2.0}, {0.0, -0.5, 0.0});
        belt.type = BodyType::kinematic;
        belt.interpolation = Interpolation::linear;
        belt.keyframes = {{0.0, Vec3(0.0, -0.5, 0.0), Quat::Identity()},
                          {10.0, Vec3(20.0, -0.5, 0.0), Quat::Identity()}};
        add_box(scene, {0.5, 0.2, 0.5}, {0.0, 0.1, 0.0});
        set_friction(scene, 0.3);
        World world(scene);
        run(world, scene, 0.5);
        EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), 0.5 * 0.3 * g, 1e-5) << steps;
        run(world, scene, 0.5);
        const Snapshot soon = world.snapshot();
        EXPECT_NEAR(soon.bodies[1].velocity.x(), 2.0, 1e-6) << steps;
        run(world, scene, 3.0);
        const Snapshot late = world.snapshot();
        EXPECT_NEAR(late.bodies[1].center_of_mass.x() - soon.bodies[1].center_of_mass.x(), 6.0, 1e-6) << steps;
        EXPECT_NEAR(late.bodies[1].center_of_mass.y(), 0.1, 1e-6) << steps;
        EXPECT_LE(std::abs(late.bodies[1].center_of_mass.z()), 1e-6);
    }
}

// A turntable: within mu g / omega^2 of the axis boxes are carried round, farther out they slide off.
TEST(ContactHardInput, ATurntable) {
    SceneDescription scene = empty_scene(4);
    scene.simulation.gravity = Vec3(0.0, -g, 0.0);
    BodyDescription& table = add_box(scene, {10.0, 1.0, 10.0}, {0.0, -0.5, 0.0});
    table.type = BodyType::kinematic;
    table.interpolation = Interpolation::linear;
    const double omega = 1.5;  // mu g / omega^2 = 1.744 m
    for (int k = 0; k <= 12; ++k)
        table.keyframes.push_back({0.5 * k, Vec3(0.0, -0.5, 0.0), turn(Vec3::UnitY(), 0.5 * k * omega)});
    for (const double r : {1.6, 2.0}) {
        BodyDescription& box = add_box(scene, {0.3, 0.1, 0.3}, {r > 1.7 ? r : -r, 0.05, 0.0});
        box.velocity = Vec3(0.0, 0.0, r > 1.7 ? -omega * r : omega * r);
        box.angular_velocity = Vec3(0.0, omega, 0.0);
    }
    set_friction(scene, 0.4);
    World world(scene);
    run(world, scene, 4.0);
    EXPECT_NEAR(world.snapshot().bodies[1].center_of_mass.norm(), std::hypot(1.6, 0.05), 1e-4);
    EXPECT_GT(world.snapshot().bodies[2].center_of_mass.norm(), 3.0);
}

// Without gravity nothing presses: touching bodies stay, drifting ones drift.
TEST(ContactHardInput, NoGravity) {
    SceneDescription scene = empty_scene(4);
    add_body(scene, PlaneShape{}, Vec3::Zero()).type = BodyType::fixed;
    add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5, 0.0});
    add_box(scene, {1.0, 1.0, 1.0}, {0.0, 1.5, 0.0});
    add_box(scene, {1.0, 1.0, 1.0}, {5.0, 0.5, 0.0}).velocity = Vec3(0.5, 0.0, 0.1);
    set_friction(scene, 0.9);
    World world(scene);
    run(world, scene, 5.0);
    const Snapshot s = world.snapshot();
    EXPECT_LE((s.bodies[1].center_of_mass - Vec3(0.0, 0.5, 0.0)).norm(), 1e-12);
    EXPECT_LE((s.bodies[2].center_of_mass - Vec3(0.0, 1.5, 0.0)).norm(), 1e-12);
    EXPECT_LE((s.bodies[3].velocity - Vec3(0.5, 0.0, 0.1)).norm(), 1e-12);
}

// Gravity switched off, reversed and on again under a stack that has fallen asleep, by forces on every body (a scene's
// gravity is constant): the stack wakes each time, stays without a force, rises and falls as one, and rests again.
TEST(ContactHardInput, GravitySwitched) {
    SceneDescription scene = ground_scene(0.0, 0.5, 4);
    for (int i = 0; i < 5; ++i) add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5 + i, 0.0}).mass = 2.0;
    for (std::size_t i = 1; i <= 5; ++i) {
        scene.forces.push_back({i, Vec3::Zero(), Vec3(0.0, 2.0 * g, 0.0), false, 2.0, 3.0});   // off
        scene.forces.push_back({i, Vec3::Zero(), Vec3(0.0, 4.0 * g, 0.0), false, 3.0, 3.25});  // upside down
    }
    World world(scene);
    const auto heights = [&](double lifted, double tolerance) {
        const Snapshot s = world.snapshot();
        for (std::size_t i = 1; i <= 5; ++i)
            EXPECT_LE((s.bodies[i].center_of_mass - Vec3(0.0, i - 0.5 + lifted, 0.0)).norm(), tolerance)
                << i << " at " << s.time;
    };
    run(world, scene, 1.9);
    EXPECT_EQ(world.measure().kinetic, 0.0);
    run(world, scene, 1.0);
    heights(0.0, 1e-5);
    run(world, scene, 0.35);
    const double h = scene.step();
    heights(0.5 * g * 0.25 * 0.25, 2.0 * g * h * 0.25);  // symplectic Euler: g h t / 2
    run(world, scene, 3.0);
    heights(0.0, 1e-3);  // fell from 0.6 m, as a stack
    EXPECT_EQ(world.measure().kinetic, 0.0);
}

// A hundred thousand bodies, some of them touching: three steps, and each is at its expected place.
TEST(ContactHardInput, AHundredThousandBodies) {
    SceneDescription scene = ground_scene(0.0, 0.5, 1);
    scene.bodies.reserve(100001);
    const int count = trials(100000);
    for (int i = 0; i < count; ++i) {
        const Vec3 at(1.5 * (i % 300), i % 3 == 0 ? 0.5 : 3.0, 1.5 * (i / 300));
        i % 2 ? add_sphere(scene, 0.5, at) : add_box(scene, {1.0, 1.0, 1.0}, at);
    }
    World world(scene, 2);
    for (int k = 0; k < 3; ++k) world.step();
    const double h = 1.0 / 60.0, fall = g * h * h * 6.0;  // symplectic Euler: 1 + 2 + 3
    const Snapshot s = world.snapshot();
    for (std::size_t i = 1; i < s.bodies.size(); ++i) {
        const Vec3 at = scene.bodies[i].position - (scene.bodies[i].position.y() > 1.0 ? fall : 0.0) * Vec3::UnitY();
        ASSERT_LE((s.bodies[i].center_of_mass - at).norm(), 1e-6) << i;
    }
}

// Small bodies that overlap are pushed apart under load, too: a cube of 2 mm carries one of 4 mm, eight times as heavy,
// that starts a millimeter inside it. The position correction, 5 radii per second, is slow compared with gravity's gain
// per substep.
TEST(ContactHardInput, SmallBodiesDoNotSinkIntoEachOther) {
    for (const int steps : {1, 16}) {
        SceneDescription scene = ground_scene(0.0, 0.5, steps);
        scene.simulation.contact_solver = ContactSolverChoice::soft;
        add_box(scene, {2e-3, 2e-3, 2e-3}, {0.0, 1e-3, 0.0}, 8e-6);
        add_box(scene, {4e-3, 4e-3, 4e-3}, {0.0, 3e-3, 0.0}, 64e-6);
        set_friction(scene, 0.5);
        World world(scene);
        run(world, scene, 2.0);
        EXPECT_NEAR(world.snapshot().bodies[2].center_of_mass.y(), 4e-3, 1e-4) << steps;
        EXPECT_NEAR(world.snapshot().bodies[1].center_of_mass.y(), 1e-3, 1e-4) << steps;
    }
}

}  // namespace tumble::contact_hard_input_test
