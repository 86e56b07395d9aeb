// Rolling on corners and rocking on edges, at few steps per frame, against the mechanics of rimless wheels and of
// rocking blocks.
#include "core/deterministic_math.h"
#include "support/compounds.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tumble::rolling_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

// A regular prism along z, standing on a face.
TriangleMesh prism(int corners, double radius, double width) {
    TriangleMesh m;
    for (const double z : {-0.5 * width, 0.5 * width})
        for (int i = 0; i < corners; ++i) {
            const double angle = 2.0 * pi * (i + 0.5) / corners - 0.5 * pi;
            const auto [sine, cosine] = sincos(angle);
            m.vertices.emplace_back(radius * cosine, radius * sine, z);
        }
    const auto n = std::uint32_t(corners);
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t next = (i + 1) % n;
        m.triangles.push_back({i, next, n + next});
        m.triangles.push_back({i, n + next, n + i});
        if (i == 0 || next == 0) continue;
        m.triangles.push_back({0, next, i});
        m.triangles.push_back({n, n + i, n + next});
    }
    return m;
}

enum class Floor { plane, box };

struct Rolled {
    double hop, speed;  // m above the circle's height; m/s at the end
};

Rolled roll(int corners, double radius, double speed, double restitution, Floor floor, int steps) {
    SceneDescription scene = ground_scene(restitution, 0.9, steps);
    if (floor == Floor::box) {
        scene.bodies[0].shape = BoxShape{{40.0, 1.0, 3.0}};
        scene.bodies[0].position = {10.0, -0.5, 0.0};
    }
    const double height = radius * sincos(0.5 * pi - pi / corners).sin;
    BodyDescription& wheel = add_body(scene, MeshShape{asset_of(prism(corners, radius, 0.4))}, {0.0, height, 0.0});
    wheel.friction = 0.9;
    wheel.restitution = restitution;
    wheel.velocity = {speed, 0.0, 0.0};
    wheel.angular_velocity = {0.0, 0.0, -speed / height};
    World world(scene);
    double highest = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        highest = std::max(highest, world.snapshot().bodies.back().center_of_mass.y());
    }
    return {highest - radius, world.snapshot().bodies.back().velocity.x()};
}

}  // namespace

// A wheel of 64 corners pivots on one after the other. Each new corner takes 1 - cos(2 pi / n) over 1 + I / m r^2 of
// its speed, or less where the wheel flies, and deflects it upwards by no more than the angle between corners. Corners
// that are held before they land, at arms at which they never touch, throw such wheels up by 0.4 m and take nine tenths
// of the energy.
TEST(Rolling, WheelsOfCornersStayOnTheGround) {
    constexpr int corners = 64;
    const double angle = 2.0 * pi / corners, sine = sincos(angle).sin, cosine = sincos(angle).cos;
    for (const Floor floor : {Floor::plane, Floor::box})
        for (const double radius : {0.5, 0.1})
            for (const double speed : {1.0, 3.0, 5.0})
                for (const int steps : {1, 2, 4, 16}) {
                    const Rolled rolled = roll(corners, radius, speed, 0.0, floor, steps);
                    // of v, over the distance: dv / dx = -loss v
                    const double up = speed * sine, loss = (1.0 - cosine) / 1.5 / (radius * angle);
                    const double pivoting = speed / (1.0 + loss * speed * 1.0);
                    EXPECT_LT(rolled.hop, up * up / (2.0 * g) + 1e-4)
                        << radius << ' ' << speed << ' ' << steps << ' ' << int(floor);
                    EXPECT_GT(rolled.speed, 0.8 * pivoting)
                        << radius << ' ' << speed << ' ' << steps << ' ' << int(floor);
                    EXPECT_LT(rolled.speed, 1.002 * speed)
                        << radius << ' ' << speed << ' ' << steps << ' ' << int(floor);
                }
}

// A ball with a weight in it, released at an angle: its center of mass moves about the ball's middle, on a cycloid.
// Rolling without slip keeps the energy
//   m g c (1 - cos(phi)) + (I + m (R^2 + c^2 - 2 R c cos(phi))) phi'^2 / 2:
// it swings as far on the other side, and back in the time  4 int_0^A dphi / phi'. Contact that assumes a straight path
// of its middle in a step costs a tenth of the energy per swing.
TEST(Rolling, AWeightedBallSwingsOn) {
    const double radius = 0.5, inner = 0.1, off = 0.25;
    const auto mass_of = [](double r) { return 4.0 / 3.0 * pi * r * r * r; };
    for (const double amplitude : {0.5 * pi, 2.0 / 3.0 * pi})
        for (const int steps : {1, 2, 4}) {
            SceneDescription scene = ground_scene(0.0, 1.0, steps);
            std::vector<CompoundPart> parts{part(SphereShape{radius}, Vec3::Zero()),
                                            part(SphereShape{inner}, {0.0, -off, 0.0})};
            parts[0].density = 1.0 / mass_of(radius);
            parts[1].density = 1.0 / mass_of(inner);
            BodyDescription& ball = add_body(scene, compound_of(std::move(parts)), {0.0, radius, 0.0});
            ball.friction = 1.0;
            ball.restitution = 0.0;
            ball.rotation = turn(Vec3::UnitZ(), amplitude);
            World world(scene);
            const BodyReport body = world.report(1);
            const double m = body.mass, c = 0.5 * off, inertia = body.principal_inertia.maxCoeff();
            // The integral in s, phi = A sin(s), which removes the root singularity at its end.
            double period = 0.0;
            constexpr int parts_of_it = 2000;
            for (int i = 0; i < parts_of_it; ++i) {
                const auto [sine, cosine] = sincos(0.5 * pi * (i + 0.5) / parts_of_it);
                const double phi = amplitude * sine, turned = sincos(phi).cos;
                const double all = inertia + m * (radius * radius + c * c - 2.0 * radius * c * turned);
                const double rate = std::sqrt(2.0 * m * g * c * (turned - sincos(amplitude).cos) / all);
                period += 4.0 * amplitude * cosine / rate * 0.5 * pi / parts_of_it;
            }
            double before = amplitude, highest = 0.0;
            std::vector<double> passes, tilts = {0.0};  // the extreme of each swing
            for (int frame = 1; frame <= 600; ++frame) {
                world.advance_frame();
                const BodyState now = world.snapshot().bodies[1];
                const double angle = 2.0 * atan2_stable(now.orientation.z(), now.orientation.w());
                if (angle * before < 0.0) {
                    passes.push_back((frame - angle / (angle - before)) / 60.0);
                    tilts.push_back(0.0);
                }
                tilts.back() = std::max(tilts.back(), std::abs(angle));
                highest = std::max(highest, now.center_of_mass.y() - (radius - c * sincos(angle).cos));
                before = angle;
            }
            ASSERT_GT(passes.size(), 3u);
            EXPECT_NEAR((passes.back() - passes[0]) / (0.5 * double(passes.size() - 1)), period, 1e-4 * period)
                << amplitude << ' ' << steps;
            EXPECT_NEAR(tilts[tilts.size() - 2], amplitude, 1e-3 * amplitude) << amplitude << ' ' << steps;
            EXPECT_LT(highest, 2e-5) << amplitude << ' ' << steps;
        }
}

// Housner 1963: a block that rocks from edge to edge keeps 1 - 3/2 sin^2(alpha) of its angular velocity in each
// landing, alpha the angle between its diagonal and its side. The tilt in between measures its energy. Contact that
// assumes the landing at the start of the step costs up to as much again; solved in parts of the step it costs a
// fraction of that.
TEST(Rocking, LosesNoMoreThanItsLandingsTake) {
    const Vec3 size(0.2, 1.0, 0.5);
    const double diagonal = 0.5 * std::hypot(size.x(), size.y()), alpha = atan2_stable(size.x(), size.y()),
                 tilt = 0.7 * alpha;
    const auto height = [&](double angle) {
        return sincos(0.5 * pi - alpha + angle).sin - sincos(0.5 * pi - alpha).sin;
    };
    const double kept = std::pow(1.0 - 1.5 * std::pow(sincos(alpha).sin, 2.0), 2.0);
    struct Case {
        int steps;
        double error;  // relative error of the energy after two landings; without parts of the step: 0.25 and 0.125
    };
    for (const Case& c : {Case{2, 0.15}, Case{4, 0.11}}) {
        SceneDescription scene = ground_scene(0.0, 0.9, c.steps);
        const auto [sine, cosine] = sincos(alpha - tilt);
        add_box(scene, size, {-diagonal * sine, diagonal * cosine, 0.0}).rotation = turn(Vec3::UnitZ(), -tilt);
        scene.bodies.back().friction = 0.9;
        World world(scene);
        std::vector<double> tilts = {0.0};  // the extreme of each swing
        double before = -1.0;
        for (int frame = 0; frame < 180; ++frame) {
            world.advance_frame();
            const Quat q = world.snapshot().bodies.back().orientation;
            const double angle = 2.0 * atan2_stable(q.z(), q.w());
            if (angle * before < 0.0) tilts.push_back(0.0);
            before = angle;
            tilts.back() = std::max(tilts.back(), std::abs(angle));
        }
        ASSERT_GT(tilts.size(), 3u);
        const double energy = height(tilts[2]) / height(tilt);
        EXPECT_NEAR(energy, kept * kept, c.error) << c.steps;
        EXPECT_LT(energy, kept * kept + 0.01) << c.steps;
    }
}

}  // namespace tumble::rolling_test
