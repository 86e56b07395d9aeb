// Exercises of a mechanics course with contact and closed-form solutions.
#include "core/deterministic_math.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::textbook_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

// A bar along z with its ridge at y = 0, x = 0.
TriangleMesh ridge(double half_width, double height, double half_length) {
    TriangleMesh mesh;
    for (const double z : {-half_length, half_length})
        for (const Vec3& corner : {Vec3(-half_width, -height, z), Vec3(half_width, -height, z), Vec3(0.0, 0.0, z)})
            mesh.vertices.push_back(corner);
    mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {0, 3, 5}, {0, 5, 2}};
    return mesh;
}

}  // namespace

// A see-saw rotates with I w^2 / 2 = m g (h0 - h), the descent of its load's center, and stays on its edge. On the
// ridge of a fixed mesh it must not sink: one end of the ridge must stay a contact where rounding selects edge against
// edge.
TEST(Textbook, SeeSawOnARidge) {
    for (const int steps : {1, 2, 4, 16}) {
        SceneDescription scene;
        scene.simulation.steps_per_frame = steps;
        BodyDescription& edge = add_body(scene, MeshShape{asset_of(ridge(0.3, 0.5, 1.0))}, Vec3::Zero());
        edge.type = BodyType::fixed;
        edge.restitution = 0.0;
        const double length = 4.0, thick = 0.1, side = 0.3, out = 1.5, board = 2.0, left = 3.0, right = 2.5;
        add_box(scene, {length, thick, 0.6}, {0.0, 0.5 * thick, 0.0}, board);
        add_box(scene, {side, side, side}, {-out, thick + 0.5 * side, 0.0}, left);
        add_box(scene, {side, side, side}, {out, thick + 0.5 * side, 0.0}, right);
        for (BodyDescription& body : scene.bodies) body.friction = 2.0;
        World world(scene);
        run(world, scene, 0.5);
        const BodyState b = world.snapshot().bodies[1];
        const double angle = 2.0 * std::atan2(b.orientation.z(), b.orientation.w());
        const double high = thick + 0.5 * side, loads = left + right;
        const double inertia = board * (length * length + 4.0 * thick * thick) / 12.0 +
                               loads * (out * out + high * high + side * side / 6.0);
        const double moment_x = (right - left) * out, moment_y = board * 0.5 * thick + loads * high;
        const double work = g * (moment_y * (1.0 - std::cos(angle)) - moment_x * std::sin(angle));
        EXPECT_GT(angle, 0.05) << steps;
        EXPECT_NEAR(b.angular_velocity.z(), std::sqrt(2.0 * work / inertia),
                    0.02 * b.angular_velocity.z() / steps + 1e-3)
            << steps;
        const double over_edge =
            -std::sin(angle) * b.center_of_mass.x() + std::cos(angle) * b.center_of_mass.y() - 0.5 * thick;
        EXPECT_NEAR(over_edge, 0.0, 1e-6) << steps;
    }
}

// Friction where a ball lands has no torque about that place: v - 2/5 r w is constant. Found a step late, inside the
// floor, the ball would have a shorter lever: one with back-spin would run back, at -0.14 m/s instead of 0.29.
TEST(Textbook, ASpinningBallKeepsItsAngularMomentumAboutTheFloor) {
    const double r = 0.1;
    const Vec3 v(2.0, 0.0, 0.5), w(10.0, 5.0, 40.0);
    for (const bool plane : {true, false})
        for (const double e : {0.0, 0.3, 0.7, 1.0})
            for (const int steps : {1, 2, 16}) {
                SceneDescription scene;
                scene.simulation.steps_per_frame = steps;
                BodyDescription& floor = plane ? add_body(scene, PlaneShape{}, Vec3::Zero())
                                               : add_box(scene, {20.0, 1.0, 20.0}, {0.0, -0.5, 0.0});
                floor.type = BodyType::fixed;
                floor.restitution = e;
                BodyDescription& ball = add_sphere(scene, r, {0.0, 1.0, 0.0});
                ball.velocity = v;
                ball.angular_velocity = w;
                for (BodyDescription& body : scene.bodies) body.friction = 0.3;
                World world(scene);
                run(world, scene, 1.5);
                const BodyState b = world.snapshot().bodies[1];
                EXPECT_NEAR(b.velocity.x() - 0.4 * r * b.angular_velocity.z(), v.x() - 0.4 * r * w.z(), 1e-9)
                    << plane << ' ' << e << ' ' << steps;
                EXPECT_NEAR(b.velocity.z() + 0.4 * r * b.angular_velocity.x(), v.z() + 0.4 * r * w.x(), 1e-9)
                    << plane << ' ' << e << ' ' << steps;
                EXPECT_NEAR(b.angular_velocity.y(), w.y(), 1e-9);
                // It rolls at this time: (5 v - 2 r w) / 7.
                EXPECT_NEAR(b.velocity.x(), (5.0 * v.x() - 2.0 * r * w.z()) / 7.0, 1e-3)
                    << plane << ' ' << e << ' ' << steps;
            }
}

// A rod falls on its end, on ground too rough to slip on. It has no slip before, and none in the impact: by any law of
// restitution, the end rebounds at e times its speed, and (1 - e^2) v^2 / 2 K is lost, K the compliance along the
// normal without slip, K_nn - K_nt^2 / K_tt. Friction must not change the end's speed: that would remove the rebound at
// e = 0.5, and at e = 1 leave 2.7 of 4.9 J.
// On smoother ground it slips throughout the impact, |f| = mu j.
TEST(Textbook, ARodReboundsFromRoughGround) {
    const double length = 1.0, thick = 0.1, height = 0.5;
    for (const double degrees : {20.0, 30.0, 60.0})
        for (const double mu : {0.1, 10.0})
            for (const double e : {0.2, 0.5, 1.0})
                for (const bool exact : {true, false}) {
                    SceneDescription scene = ground_scene(e, mu, 16);
                    scene.output.fps = 240;
                    const Quat tilt = turn(Vec3::UnitZ(), degrees * pi / 180.0);
                    const Vec3 arm = tilt * Vec3(-0.5 * length, -0.5 * thick, 0.0);  // of the end
                    BodyDescription& rod = add_box(scene, {length, thick, 0.4}, {0.0, height - arm.y(), 0.0});
                    rod.rotation = tilt;
                    rod.friction = mu;
                    scene.simulation.integrator = IntegratorKind::exact;
                    if (exact) scene.simulation.impacts = ImpactMode::exact;
                    World world(scene);
                    const double landing = std::sqrt(2.0 * height / g), v = g * landing;
                    run(world, scene, (std::floor(landing * 240.0) + 2.0) / 240.0);
                    const double since = (std::floor(landing * 240.0) + 2.0) / 240.0 - landing;
                    const double inertia = (length * length + thick * thick) / 12.0;
                    const double nn = 1.0 + arm.x() * arm.x() / inertia, tt = 1.0 + arm.y() * arm.y() / inertia,
                                 nt = -arm.x() * arm.y() / inertia;
                    const double slope = std::abs(nt) / tt > mu ? -std::copysign(mu, nt) : -nt / tt;  // f / j
                    const double j = (1.0 + e) * v / (nn + slope * nt), f = slope * j;
                    const BodyState b = world.snapshot().bodies[1];
                    const double near = exact ? 1e-9 : 0.02;
                    EXPECT_NEAR(b.velocity.x(), f, near) << degrees << ' ' << mu << ' ' << e << ' ' << exact;
                    EXPECT_NEAR(b.velocity.y() + g * since, j - v, near)
                        << degrees << ' ' << mu << ' ' << e << ' ' << exact;
                    EXPECT_NEAR(b.angular_velocity.z(), (arm.x() * j - arm.y() * f) / inertia, 5.0 * near)
                        << degrees << ' ' << mu << ' ' << e << ' ' << exact;
                }
}

// A box thrown flat slides as it lands and rebounds flat, slower by mu (1 + e) v_n: its front carries more of the
// impulse than its back, such that friction does not rotate it (by a radian per second otherwise).
TEST(Textbook, ABoxThrownFlatReboundsFlat) {
    const double mu = 0.2, speed = 5.0, v = std::sqrt(2.0 * g * 0.5);
    for (const double e : {0.5, 1.0})
        for (const bool exact : {true, false}) {
            SceneDescription scene = ground_scene(e, mu);
            BodyDescription& box = add_box(scene, {1.0, 0.2, 1.0}, {0.0, 0.6, 0.0});
            box.velocity = Vec3(speed, 0.0, 0.0);
            box.friction = mu;
            if (exact) scene.simulation.impacts = ImpactMode::exact;
            World world(scene);
            run(world, scene, 0.4);
            const BodyState b = world.snapshot().bodies[1];
            EXPECT_NEAR(b.velocity.x(), speed - mu * (1.0 + e) * v, exact ? 1e-12 : 3e-3) << e << ' ' << exact;
            EXPECT_LT(b.angular_velocity.norm(), exact ? 1e-12 : 1e-5) << e << ' ' << exact;
        }
}

// A ball that rolls down a rough ball leaves it where cos = 10/17 of the top's (solid, v^2 = 10/7 g (R + r)
// (cos_0 - cos)), with the spin v / r. With exact impacts it must not be released repeatedly before, just above the
// surface: that costs 2.4 % of the spin.
TEST(Textbook, ABallRollsOffABall) {
    const double large = 1.0, small = 0.2, start = 0.05, path = large + small;
    for (const bool exact : {false, true}) {
        SceneDescription scene;
        scene.output.fps = 120;
        BodyDescription& hill = add_sphere(scene, large, Vec3::Zero());
        hill.type = BodyType::fixed;
        add_sphere(scene, small, path * Vec3(std::sin(start), std::cos(start), 0.0));
        for (BodyDescription& body : scene.bodies) body.friction = 1000.0;
        if (exact) scene.simulation.impacts = ImpactMode::exact;
        World world(scene);
        run(world, scene, 2.0);
        const BodyState b = world.snapshot().bodies[1];
        const double cosine = 10.0 / 17.0 * std::cos(start), v = std::sqrt(g * path * cosine);
        EXPECT_GT(b.center_of_mass.norm(), path + 0.05) << exact;
        EXPECT_NEAR(b.velocity.x(), v * cosine, 5e-4 * v) << exact;
        EXPECT_NEAR(b.angular_velocity.z(), -v / small, 5e-4 * v / small) << exact;
    }
}

}  // namespace tumble::textbook_test
