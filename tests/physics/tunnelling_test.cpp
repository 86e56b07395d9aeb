// No body ever ends on the other side of a wall: any speed, thickness and step, in either mode of impacts.
#include "exact_scenes.h"
#include "sim/random_shapes.h"
#include "support/compounds.h"
#include "support/meshes.h"

#include <gtest/gtest.h>

namespace tumble::tunnelling_test {
using namespace tumble::testing;

namespace {

constexpr double rates[] = {30.0, 60.0, 113.0, 240.0, 480.0, 1000.0, 1920.0};

enum class Projectile { cube, sphere, hull };

BodyDescription& add_projectile(SceneDescription& scene, Projectile kind, const Vec3& at) {
    BodyDescription& body = kind == Projectile::cube     ? add_box(scene, {0.1, 0.1, 0.1}, at)
                            : kind == Projectile::sphere ? add_sphere(scene, 0.05, at)
                                                         : add_body(scene, MeshShape{icosahedron(0.05)}, at);
    body.mass = 1.0;
    return body;
}

// A wall in the plane x = 0, of the thickness given; 0: a mesh without thickness.
void add_wall(SceneDescription& scene, double thickness, double restitution) {
    if (thickness > 0.0) {
        add_fixed_box(scene, {thickness, 40.0, 40.0}, Vec3::Zero(), restitution);
        return;
    }
    TriangleMesh sheet = grid_mesh(3, 20.0, 0.0);
    for (Vec3& v : sheet.vertices) v = Vec3(-v.y(), v.x(), v.z());
    BodyDescription& wall = add_body(scene, MeshShape{asset_of(sheet)}, Vec3::Zero());
    wall.type = BodyType::fixed;
    wall.restitution = restitution;
}

// Shoots a body at the wall, and checks at every step.
struct Shot {
    Projectile kind = Projectile::cube;
    double thickness = 0.01, speed = 500.0, distance = 3.0, restitution = 1.0, rate = 60.0;
    Vec3 spin = Vec3::Zero();
    Quat rotation = Quat::Identity();
    bool exact = true;
};

void expect_on_this_side(const Shot& shot, double energy_bound) {
    SceneDescription scene = empty_scene(1);
    set_step(scene, shot.rate);
    add_wall(scene, shot.thickness, shot.restitution);
    BodyDescription& body = add_projectile(scene, shot.kind, {-shot.distance, 0.1, -0.2});
    body.velocity = Vec3(shot.speed, 0.0, 0.0);
    body.angular_velocity = shot.spin;
    body.rotation = shot.rotation;
    body.restitution = shot.restitution;
    if (shot.exact) make_exact(scene);
    World world(scene);
    const double start = energy(world);
    // Stepped, a rotated body has several impacts, one per step.
    const int frames = std::max(3, int(std::ceil((shot.distance / shot.speed + 0.02) * shot.rate)) + 12);
    for (int frame = 0; frame < frames; ++frame) {
        world.advance_frame();
        ASSERT_LT(world.snapshot().bodies[1].center_of_mass.x(), -0.03)
            << "kind " << int(shot.kind) << ", wall " << shot.thickness << " m, " << shot.speed << " m/s from "
            << shot.distance << " m, e " << shot.restitution << ", 1/" << shot.rate << " s, spin " << shot.spin.norm()
            << ", exact " << shot.exact;
    }
    if (shot.restitution == 1.0) {
        EXPECT_NEAR(energy(world) / start, 1.0, energy_bound);
        EXPECT_LT(world.measure().momentum.x(), 0.0);
    }
}

}  // namespace

// The cube of 0.1 m flies at 500 m/s (16 m in the coarsest step) and rebounds with its energy.
TEST(ThinWall, CubeAt500MetersPerSecondRebounds) {
    for (const bool exact : {true, false})
        for (const double thickness : {0.01, 0.001})
            for (const double rate : rates)
                expect_on_this_side({.thickness = thickness, .rate = rate, .exact = exact}, 1e-10);
}

TEST(ThinWall, FromAnyDistance) {
    for (const bool exact : {true, false})
        for (const double rate : {60.0, 480.0, 1920.0})
            for (int i = 0; i < trials(40); ++i)
                expect_on_this_side({.thickness = i % 2 ? 0.01 : 0.001,
                                     .distance = 0.06 + 0.0331 * i * i,
                                     .rate = rate,
                                     .exact = exact},
                                    1e-10);
}

// Spinning ones: up to 4000 rad/s, whole revolutions in a step.
TEST(ThinWall, SpinningBodiesOfEveryShape) {
    Random random(5);
    for (const bool exact : {true, false})
        for (const Projectile kind : {Projectile::cube, Projectile::sphere, Projectile::hull})
            for (const double thickness : {0.01, 0.001, 0.0})
                for (int i = 0; i < trials(20); ++i) {
                    const double spin = i % 4 == 0 ? 0.0 : std::pow(10.0, random(0.0, 3.4));
                    // Stepped, a spin rotates the body by whole revolutions per step: its energy is that of the step's
                    // pose.
                    expect_on_this_side({.kind = kind,
                                         .thickness = thickness,
                                         .speed = random(20.0, 1000.0),
                                         .distance = random(0.1, 20.0),
                                         .rate = rates[i % 7],
                                         .spin = random.vector(spin),
                                         .rotation = random.turn(),
                                         .exact = exact},
                                        exact ? 1e-10 : 0.1);
                }
}

// With partial or no restitution: the body stays on its side of the wall.
TEST(ThinWall, InelasticImpactsStayOnThisSide) {
    Random random(6);
    for (const bool exact : {true, false})
        for (const double e : {0.0, 0.5})
            for (const Projectile kind : {Projectile::cube, Projectile::sphere, Projectile::hull})
                for (int i = 0; i < trials(12); ++i)
                    expect_on_this_side({.kind = kind,
                                         .thickness = i % 3 * 0.005,
                                         .speed = random(20.0, 1000.0),
                                         .distance = random(0.1, 20.0),
                                         .restitution = e,
                                         .rate = rates[i % 7],
                                         .spin = random.vector(50.0),
                                         .rotation = random.turn(),
                                         .exact = exact},
                                        1.0);
}

// Two bodies that fly at each other do not change places, and a heavy one does not push a light one through the wall.
TEST(ThinWall, BodiesDoNotPassThroughEachOther) {
    for (const bool exact : {true, false})
        for (const double rate : rates)
            for (const double offset : {0.0, 0.01, 0.04}) {
                SceneDescription scene = empty_scene(1);
                set_step(scene, rate);
                for (const double side : {-1.0, 1.0}) {
                    BodyDescription& body = add_projectile(scene, offset > 0.0 ? Projectile::cube : Projectile::sphere,
                                                           {3.0 * side, offset * side, 0.0});
                    body.velocity = Vec3(-400.0 * side, 0.0, 0.0);
                    body.restitution = 1.0;
                }
                if (exact) make_exact(scene);
                World world(scene);
                for (int frame = 0; frame < std::max(3, int(0.02 * rate)); ++frame) {
                    world.advance_frame();
                    const Snapshot s = world.snapshot();
                    ASSERT_LT(s.bodies[0].center_of_mass.x(), s.bodies[1].center_of_mass.x())
                        << exact << " " << rate << " " << offset;
                }
                EXPECT_NEAR(world.measure().kinetic, 160000.0, exact ? 1e-5 : 200.0) << rate << " " << offset;
                EXPECT_LE(world.measure().momentum.norm(), 1e-9);
            }
}

// In a closed room of thin walls for a while, with displacements of many rooms per step.
TEST(ThinWall, NoBodyLeavesTheRoom) {
    Random random(9);
    for (const bool exact : {true, false}) {
        for (const double rate : {30.0, 240.0}) {
            SceneDescription scene = empty_scene(1);
            set_step(scene, rate);
            for (const double side : {-1.0, 1.0})
                for (int axis = 0; axis < 3; ++axis) {
                    Vec3 size(2.02, 2.02, 2.02), at = Vec3::Zero();
                    size[axis] = 0.01;
                    at[axis] = side * 1.005;
                    add_fixed_box(scene, size, at, 1.0);
                }
            for (int i = 0; i < 8; ++i) {
                const Vec3 at(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
                BodyDescription& body = add_projectile(scene, Projectile(i % 3), at);
                body.velocity = random.vector(300.0);
                body.angular_velocity = random.vector(20.0);
                body.restitution = 1.0;
            }
            if (exact) make_exact(scene);
            World world(scene);
            const double start = energy(world);
            for (int frame = 0; frame < trials(int(rate / 4.0)); ++frame) {
                world.advance_frame();
                for (std::size_t i = 6; i < scene.bodies.size(); ++i)
                    ASSERT_LT(world.snapshot().bodies[i].center_of_mass.cwiseAbs().maxCoeff(), 1.0)
                        << exact << ", 1/" << rate << " s, body " << i;
            }
            if (exact) {
                EXPECT_NEAR(energy(world) / start, 1.0, 1e-10);
            }
        }
    }
}

// Sliding on the ground, held by it, and yet stopped by the wall.
TEST(ThinWall, SlidingBodiesAreStopped) {
    for (const bool exact : {true, false})
        for (const double thickness : {0.01, 0.001})
            for (const double e : {0.0, 1.0})
                for (const double rate : rates) {
                    SceneDescription scene = ground_scene(0.0, 0.0, 1);
                    set_step(scene, rate);
                    add_fixed_box(scene, {thickness, 4.0, 4.0}, Vec3::Zero(), e);
                    BodyDescription& box = add_box(scene, {0.1, 0.1, 0.1}, {-2.0, 0.05, 0.0});
                    box.velocity = Vec3(100.0, 0.0, 0.0);
                    if (exact) make_exact(scene);
                    World world(scene);
                    const double start = energy(world);
                    for (int frame = 0; frame < std::max(4, int(0.04 * rate)); ++frame) {
                        world.advance_frame();
                        EXPECT_LE(energy(world), start * (1.0 + 1e-6));
                        ASSERT_LT(world.snapshot().bodies[2].center_of_mass.x(), -0.03)
                            << exact << " " << thickness << " e " << e << " 1/" << rate;
                    }
                    // A box slightly rotated by the ground hits the wall edge by edge: part of its speed becomes spin.
                    EXPECT_LE(world.snapshot().bodies[2].velocity.x(), -20.0 * e + 0.1)
                        << exact << " " << thickness << " e " << e << " 1/" << rate;
                }
}

// Landing in the middle of a step, at full speed along the ground, right before the wall.
TEST(ThinWall, LandingBodiesAreStopped) {
    for (const bool exact : {true, false})
        for (const double e : {0.0, 1.0})
            for (const double rate : rates)
                for (int i = 0; i < trials(8); ++i) {
                    SceneDescription scene = ground_scene(0.0, 0.0, 1);
                    set_step(scene, rate);
                    add_fixed_box(scene, {0.01, 4.0, 4.0}, Vec3::Zero(), e);
                    BodyDescription& body = add_projectile(scene, Projectile(i % 3), {-0.3 - 0.31 * i, 0.07, 0.0});
                    body.restitution = 0.0;
                    body.velocity = Vec3(100.0, -3.0, 0.0);
                    if (exact) make_exact(scene);
                    World world(scene);
                    for (int frame = 0; frame < std::max(4, int(0.04 * rate)); ++frame) {
                        world.advance_frame();
                        ASSERT_LT(world.snapshot().bodies[2].center_of_mass.x(), -0.03)
                            << exact << " e " << e << " 1/" << rate << " " << i;
                        ASSERT_GT(world.snapshot().bodies[2].center_of_mass.y(), 0.01)
                            << exact << " e " << e << " 1/" << rate << " " << i;
                    }
                }
}

// Thin bodies that land fast on a plane do not end a step under it, and bounce as they do from a box.
TEST(ThinWall, APlaneStopsThinBodiesAsABoxDoes) {
    for (const double rate : {60.0, 240.0, 960.0})
        for (const Vec3& size : {Vec3(0.2, 0.06, 0.1), Vec3(0.09, 0.0005, 0.06)}) {
            BodyState end[2];
            for (const bool plane : {true, false}) {
                SceneDescription scene = plane ? ground_scene(0.5, 0.0, 1) : empty_scene(1);
                if (!plane) add_fixed_box(scene, {40.0, 2.0, 40.0}, {0.0, -1.0, 0.0}, 0.5);
                scene.simulation.gravity = Vec3::Zero();
                set_step(scene, rate);
                BodyDescription& body = add_box(scene, size, {0.0, 0.5, 0.0});
                body.restitution = 0.5;
                body.velocity = {0.0, -12.0, 0.0};
                body.rotation = turn(Vec3::UnitX(), 0.07);
                World world(scene);
                for (int k = 0; k < int(0.06 * rate) + 6; ++k) {
                    world.step();
                    EXPECT_GT(world.snapshot().bodies[1].center_of_mass.y(), 0.0)
                        << rate << ' ' << size.y() << ' ' << plane;
                }
                end[plane ? 0 : 1] = world.snapshot().bodies[1];
            }
            EXPECT_LT((end[0].velocity - end[1].velocity).norm(), 1e-6 * 12.0) << rate << ' ' << size.y();
            EXPECT_LT((end[0].angular_velocity - end[1].angular_velocity).norm(),
                      1e-6 * end[1].angular_velocity.norm() + 1e-9)
                << rate << ' ' << size.y();
        }
}

// A ball that rolls over a plane by more than its size per step touches it throughout, and is not clamped by it.
TEST(ThinWall, AFastBallRollsOnOverAPlane) {
    for (const bool exact : {false, true})
        for (const double speed : {1.0, 4.0, 25.0, 300.0})
            for (const double friction : {0.0, 0.3}) {
                SceneDescription scene = ground_scene(0.5, friction, 1);
                if (exact) make_exact(scene);
                set_step(scene, 60.0);
                BodyDescription& ball = add_sphere(scene, 0.03, {0.0, 0.03, 0.0}, 0.17);
                ball.friction = friction;
                ball.restitution = 0.5;
                ball.velocity = {0.6 * speed, 0.0, 0.8 * speed};
                ball.angular_velocity = Vec3(0.8, 0.0, -0.6) * speed / 0.03;
                World world(scene);
                run(world, scene, 2.0);
                const BodyState end = world.snapshot().bodies[1];
                EXPECT_LT((end.center_of_mass - Vec3(1.2 * speed, 0.03, 1.6 * speed)).norm(), 1e-6 * speed)
                    << speed << ' ' << friction << ' ' << exact;
            }
}

// A ball shot into a rack: the balls that it hits move on, all of them keep the momentum, and none stands still inside
// another.
TEST(ThinWall, ARackIsBroken) {
    SceneDescription scene = ground_scene(0.5, 0.0, 1);
    set_step(scene, 60.0);
    const double r = 0.0286;
    const auto add = [&](double x, double z) -> BodyDescription& {
        BodyDescription& ball = add_sphere(scene, r, {x, r, z}, 0.17);
        ball.restitution = 0.6;
        return ball;
    };
    add(-1.2, 0.0).velocity = {6.0, 0.0, 0.0};
    for (int row = 0; row < 5; ++row)
        for (int k = 0; k <= row; ++k) add(2.0002 * r * std::sqrt(0.75) * row, 2.0002 * r * (k - 0.5 * row));
    World world(scene);
    run(world, scene, 1.0);
    const Snapshot s = world.snapshot();
    for (std::size_t i = 1; i < s.bodies.size(); ++i)
        for (std::size_t k = 1; k < i; ++k)
            EXPECT_GT((s.bodies[i].center_of_mass - s.bodies[k].center_of_mass).norm(), 1.99 * r) << i << ' ' << k;
    const Measurement m = world.measure();
    EXPECT_NEAR(m.momentum.x(), 0.17 * 6.0, 1e-9);  // the direct solver ends at some 1e-10
    EXPECT_LT(m.kinetic, 0.35 * 3.06);              // exact impacts: 0.16
}

// A rod that rotates by a radian per step beside a block that it never reaches: CCD checks its motion, which is that of
// a free body.
TEST(ThinWall, SpinningBesideAWallChangesNothing) {
    for (const IntegratorKind integrator : {IntegratorKind::symplectic_euler, IntegratorKind::exact}) {
        SceneDescription scene = empty_scene(1);
        BodyDescription& rod = add_box(scene, {0.05, 1.0, 0.05}, Vec3::Zero());
        rod.angular_velocity = {45.0, 12.0, 36.0};
        rod.integrator = integrator;
        add_fixed_box(scene, {0.5, 0.5, 0.5}, {0.0, -0.7613, 0.0}, 0.5);
        World world(scene);
        const Measurement start = world.measure();
        for (int k = 0; k < 240; ++k) world.step();
        const Measurement now = world.measure();
        EXPECT_EQ(now.angular_momentum, start.angular_momentum);
        EXPECT_NEAR(now.kinetic / start.kinetic, 1.0, 1e-12);
    }
}

// Plates, rods and stools dropped on hills and hollows of one open mesh: none sinks into it, none falls through.
TEST(WavyGround, NoBodySinksThrough) {
    Random random(11);
    const auto ground = asset_of(wavy_mesh(24, 6.0));
    const Vec3 leg(0.04, 0.5, 0.04);
    const Shape stool =
        compound_of({part(BoxShape{Vec3(0.8, 0.04, 0.6)}, Vec3::Zero()), part(BoxShape{leg}, {0.35, -0.25, 0.25}),
                     part(BoxShape{leg}, {-0.35, -0.25, 0.25}), part(BoxShape{leg}, {0.0, -0.25, -0.25})});
    for (const bool exact : {true, false})
        for (const int steps : {1, 4})
            for (int i = 0; i < trials(18); ++i) {
                SceneDescription scene;
                scene.simulation.steps_per_frame = steps;
                if (exact) make_exact(scene);
                BodyDescription& floor = add_body(scene, MeshShape{ground}, Vec3::Zero());
                floor.type = BodyType::fixed;
                floor.friction = 0.6;
                floor.restitution = 0.5;
                const double thin = random(0.02, 0.06), length = random(0.4, 1.2), width = random(0.3, 1.2);
                const Shape shape = i % 3 == 0   ? Shape(BoxShape{Vec3(thin, length, width)})
                                    : i % 3 == 1 ? Shape(BoxShape{Vec3(thin, thin, length)})
                                                 : stool;
                BodyDescription& body =
                    add_body(scene, shape, {random(-2.0, 2.0), random(1.6, 3.0), random(-2.0, 2.0)});
                body.rotation = random.turn();
                body.angular_velocity = random.vector(5.0);
                body.friction = 0.6;
                body.restitution = 0.5;
                World world(scene);
                for (int frame = 0; frame < 120; ++frame) {
                    world.advance_frame();
                    const Vec3 at = world.snapshot().bodies[1].center_of_mass;
                    ASSERT_GT(at.y(), wavy_height(at.x(), at.z()) - 0.1)
                        << exact << ", " << steps << " steps, body " << i;
                    ASSERT_LT(world.measure().max_penetration, 0.03) << exact << ", " << steps << " steps, body " << i;
                }
            }
}

}  // namespace tumble::tunnelling_test
