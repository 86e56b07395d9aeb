// Leaning tops and wheels: bodies of revolution on a ball for a tip, in steady precession. Contacts constrain the mean
// of the angular velocity over a step (gyroscopic_correction.h).
#include "support/compounds.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::top_test {
using namespace tumble::testing;

namespace {

// A square plate at a height over the middle of a light ball, which stands on the ground at x = z = 0, leaning towards
// +x.
struct Top {
    double ball, height, edge, thickness, lean, spin;  // m, m, m, m, rad, rad/s about its axis

    Vec3 axis() const { return {std::sin(lean), std::cos(lean), 0.0}; }

    SceneDescription scene(double friction, int steps_per_frame) const {
        SceneDescription scene = ground_scene(0.0, friction, steps_per_frame);
        std::vector<CompoundPart> parts{part(SphereShape{ball}, Vec3::Zero()),
                                        part(BoxShape{Vec3(edge, thickness, edge)}, {0.0, height, 0.0})};
        parts[0].density = 1e-3;
        BodyDescription& body = add_body(scene, compound_of(std::move(parts)), {0.0, ball, 0.0});
        body.restitution = 0.0;
        body.friction = friction;
        body.rotation = turn({0.0, 0.0, 1.0}, -lean);
        return scene;
    }
};

struct Precession {
    double rate = 0.0;   // rad/s about y
    double speed = 0.0;  // m/s of the center of mass, towards y x axis
};

// The angular velocity is Omega y + (spin - Omega cos) e; so L = I3 spin e + I1 Omega (y - cos e), and dL/dt = Omega y
// x L is
//   Omega (I3 spin - I1 Omega cos) sin   along y x e.
// On frictionless ground the load m g acts through the ball's middle, at a below the center of mass, with the torque m
// g a sin. A rolling top also has, with the ball's radius R, the speed V = (Omega a - (spin - Omega cos) R) sin, and
// the friction m Omega V inwards, with the arm a cos + R. The slower of the two roots.
Precession steady_precession(const Top& top, const BodyReport& body, bool rolls) {
    const double m = body.mass, a = body.center_of_mass.y(), c = std::cos(top.lean), i1 = body.principal_inertia[0],
                 i3 = body.principal_inertia[2], r = rolls ? top.ball : 0.0, arm = rolls ? a * c + r : 0.0;
    const double square = -i1 * c - arm * m * (a + c * r), linear = (i3 + arm * m * r) * top.spin,
                 constant = -m * 9.81 * a;
    Precession p;
    p.rate =
        a == 0.0 ? -linear / square : -2.0 * constant / (linear + std::sqrt(linear * linear - 4.0 * square * constant));
    if (rolls) p.speed = (p.rate * a - (top.spin - p.rate * c) * r) * std::sin(top.lean);
    return p;
}

struct Course {
    // mean rate, rad/s; largest change of lean, rad; largest gain of energy, relative to the start's
    double rate = 0.0, lean = 0.0, gain = 0.0;
};

Course follow(const Top& top, bool rolls, int steps_per_frame, int frames, Precession& expected) {
    SceneDescription scene = top.scene(rolls ? 2.0 : 0.0, steps_per_frame);
    expected = steady_precession(top, World(scene).report(1), rolls);
    const Vec3 y = Vec3::UnitY(), e = top.axis();
    scene.bodies[1].angular_velocity = expected.rate * y + (top.spin - expected.rate * std::cos(top.lean)) * e;
    scene.bodies[1].velocity = expected.speed * y.cross(e).normalized();
    World world(scene);
    const Measurement start = world.measure();
    Course course;
    double before = 0.0, turned = 0.0;
    for (int frame = 0; frame < frames; ++frame) {
        world.advance_frame();
        const Vec3 axis = world.snapshot().bodies[1].orientation * y;
        const double at = std::atan2(-axis.z(), axis.x());
        turned += std::remainder(at - before, 2.0 * 3.14159265358979323846);
        before = at;
        course.lean = std::max(course.lean, std::abs(std::acos(axis.y()) - top.lean));
        const Measurement m = world.measure();
        course.gain = std::max(course.gain, (m.kinetic + m.potential) / (start.kinetic + start.potential) - 1.0);
    }
    course.rate = turned * 60.0 / frames;
    return course;
}

}  // namespace

// Rotation by the tangent would increase its nutation until it lay down, or whirled with a third more energy than at
// the start.
TEST(Top, OnSlipperyGroundKeepsItsLeanAndItsEnergy) {
    for (const int steps : {4, 16})
        for (const Top& top : {Top{0.03, 0.25, 0.4, 0.06, 0.1, 40.0}, Top{0.03, 0.25, 0.4, 0.06, 0.3, 60.0}}) {
            Precession expected;
            const Course course = follow(top, false, steps, 600, expected);
            EXPECT_NEAR(course.rate, expected.rate, 1e-3 * expected.rate) << steps;
            EXPECT_LT(course.lean, steps == 4 ? 0.02 : 0.005) << steps;
            EXPECT_LT(course.gain, 1e-9) << steps;
        }
}

// A wheel whose center of mass is the ball's middle, so that contact exerts no torque but friction's.
TEST(Top, RollsInACircle) {
    for (const int steps : {4, 16}) {
        Precession expected;
        const Course course = follow({0.3, 0.0, 0.35, 0.1, 0.5, 4.0}, true, steps, 240, expected);
        EXPECT_NEAR(course.rate, expected.rate, (steps == 4 ? 1e-4 : 1e-5) * expected.rate) << steps;
        EXPECT_LT(course.lean, 1e-6) << steps;
    }
}

}  // namespace tumble::top_test
