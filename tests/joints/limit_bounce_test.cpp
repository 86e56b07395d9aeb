// Bounces on limits of joints until they rest, against the closed forms of their times; in all ways of motion.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace tumble::limit_bounce_test {
namespace {

using namespace testing;
using std::numbers::pi;

constexpr double g = 9.81;

struct Way {
    const char* name;
    IntegratorKind integrator;
    ImpactMode impacts;
    bool exact;  // energies to rounding
};
constexpr Way ways[] = {
    {"default", IntegratorKind::symplectic_euler, ImpactMode::stepped, false},
    {"splitting", IntegratorKind::splitting, ImpactMode::stepped, false},
    {"rk4", IntegratorKind::runge_kutta_4, ImpactMode::stepped, false},
    {"exact", IntegratorKind::exact, ImpactMode::stepped, true},
    {"exact impacts", IntegratorKind::exact, ImpactMode::exact, true},
};

SceneDescription in(const Way& way, int steps_per_frame) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    scene.simulation.integrator = way.integrator;
    scene.simulation.impacts = way.impacts;
    return scene;
}

void limit(JointAxis& axis, double lower, double upper, double restitution) {
    axis.motion = JointAxis::Motion::limited;
    axis.lower = lower;
    axis.upper = upper;
    axis.restitution = restitution;
}

struct Bounces {
    double rest = infinity;  // s, the first frame at rest
    double gain = 0.0;       // J, largest growth of the energy with the losses
    double drift = 0.0;      // J, largest change of it
    double beyond = 0.0;     // m or rad
    double speed = 0.0;      // m/s or rad/s, at the end
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    bool asleep = false;
};

/// `room` of joint 0 at a state; its coordinate `k` is at rest at the end.
Bounces measure(const SceneDescription& scene, double seconds, std::size_t k,
                const std::function<double(const JointState&)>& room) {
    World world(scene);
    world.record_contacts();
    Bounces run;
    double least = infinity, most = -infinity;
    const int frames = int(std::ceil(seconds * 60.0));
    for (int frame = 1; frame <= frames; ++frame) {
        world.advance_frame();
        const EnergyLedger& e = world.contact_records().energy;
        const Measurement m = world.measure();
        const double sum = m.kinetic + m.potential + m.elastic + e.impact_loss + e.friction_loss - e.work;
        least = std::min(least, sum);
        most = std::max(most, sum);
        run.gain = std::max(run.gain, sum - least);
        const JointState joint = world.joint_states()[0];
        run.beyond = std::max(run.beyond, -room(joint));
        run.speed = std::abs(joint.speed[k]);
        if (run.speed > 1e-9 || room(joint) > 1e-9)
            run.rest = infinity;
        else
            run.rest = std::min(run.rest, frame / 60.0);
        run.force = joint.force;
        run.torque = joint.torque;
        run.asleep = world.snapshot().bodies.back().asleep;
    }
    run.drift = most - least;
    return run;
}

/// The end of the bounces after a fall from rest over `way` with acceleration `a`.
double end_of_bounces(double way, double a, double e) { return std::sqrt(2.0 * way / a) * (1.0 + e) / (1.0 - e); }

/// The same for x'' = f(x, x') < 0 from rest at `start` to the limit `stop` below.
double end_of_bounces(const std::function<double(double, double)>& f, double start, double stop, double e) {
    constexpr double h = 1e-4;
    double time = 0.0, x = start, v = 0.0;
    const double fastest = std::sqrt(2.0 * (start - stop) * std::abs(f(stop, 0.0)));
    for (;;) {
        double last_x = x, last_v = v;
        do {
            last_x = x;
            last_v = v;
            const double a1 = f(x, v), v2 = v + 0.5 * h * a1, a2 = f(x + 0.5 * h * v, v2), v3 = v + 0.5 * h * a2,
                         a3 = f(x + 0.5 * h * v2, v3), v4 = v + h * a3, a4 = f(x + h * v3, v4);
            x += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
            v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
            time += h;
        } while (x > stop || v > 0.0);
        const double over = (stop - x) / (last_x - x);
        time -= h * over;
        x = stop;
        v = -e * (v - over * (v - last_v));
        if (v < 0.01 * fastest) return time - 2.0 * v / f(stop, 0.0) / (1.0 - e);
    }
}

std::string which(const Way& way, int steps, double e) {
    return std::string(way.name) + ", " + std::to_string(60 * steps) + "/s, e = " + std::to_string(e);
}

// The case of the issue, with other numbers, as the first and the second body, and on the upper limit.
TEST(LimitBounce, AWeightOnASlider) {
    for (const Way& way : ways)
        for (const int steps : {1, 16})
            for (const double e : {0.0, 0.3, 0.7})
                for (const bool swapped : {false, true}) {
                    constexpr double mass = 3.0, fall = 0.8;
                    SceneDescription scene = in(way, steps);
                    add_box(scene, {0.1, 0.2, 0.1}, {0.3, 0.2, -0.1}, mass);
                    const std::optional<std::size_t> world, body = 0;
                    JointDescription& joint = add_joint(scene, JointType::slider, swapped ? body : world,
                                                        swapped ? world : body, {0.3, 0.2, -0.1}, Vec3::UnitY());
                    limit(joint.move[0], swapped ? -1.5 : -fall, swapped ? fall : 1.5, e);
                    const double end = end_of_bounces(fall, g, e);
                    const Bounces run = measure(scene, end + 1.5, 0, [&](const JointState& state) {
                        return swapped ? fall - state.position[0] : state.position[0] + fall;
                    });
                    const std::string name = which(way, steps, e) + (swapped ? ", swapped" : "");
                    EXPECT_GT(run.rest, 0.99 * end - 0.1 / (60.0 * steps * (1.0 - e))) << name;
                    EXPECT_LT(run.rest, end + 1.0 / 60.0 + 1e-9) << name;
                    EXPECT_LT(run.drift, 1e-12 * mass * g * fall) << name;
                    EXPECT_LT(run.beyond, 1e-12) << name;
                    EXPECT_EQ(run.speed, 0.0) << name;
                    EXPECT_NEAR(run.force.norm(), mass * g, 1e-9) << name;
                    EXPECT_TRUE(run.asleep) << name;
                }
}

struct Rod {
    const char* name;
    JointType type;
    std::size_t coordinate;
};

// A rod about its end: a hinge, a universal joint, a cone about its own axis, a ball's twist about that of the hinge.
TEST(LimitBounce, ARodOnAHinge) {
    constexpr double length = 1.2, mass = 0.7, stop = 0.6, width = 0.1;
    const double inertia = mass * ((length * length + width * width) / 12.0 + 0.25 * length * length);
    const double k = mass * g * 0.5 * length / inertia;
    const double fall = mass * g * 0.5 * length * std::sin(stop);
    for (const Rod& rod : {Rod{"hinge", JointType::hinge, 3}, Rod{"universal", JointType::universal, 3},
                           Rod{"cone", JointType::ball, 5}, Rod{"twist", JointType::ball, 3}})
        for (const Way& way : ways)
            for (const double e : {0.3, 0.7}) {
                const bool cone = std::string(rod.name) == "cone";
                SceneDescription scene = in(way, 4);
                add_box(scene, {length, width, width}, {0.5 * length, 0.0, 0.0}, mass);
                JointDescription& joint =
                    add_joint(scene, rod.type, std::nullopt, 0, Vec3::Zero(), cone ? Vec3::UnitX() : Vec3::UnitZ());
                if (cone) {
                    joint.swing = {stop, stop};
                    for (JointAxis& axis : joint.turn) axis.restitution = e;
                } else {
                    limit(joint.turn[0], -stop, 1.0, e);
                }
                const double end =
                    end_of_bounces([&](double angle, double) { return -k * std::cos(angle); }, 0.0, -stop, e);
                const Bounces run = measure(scene, end + 1.0, rod.coordinate, [&](const JointState& state) {
                    return stop + state.position[rod.coordinate];
                });
                const std::string name = std::string(rod.name) + ", " + which(way, 4, e);
                EXPECT_GT(run.rest, 0.99 * end) << name;
                EXPECT_LT(run.rest, 1.01 * end + 1.0 / 60.0) << name;
                // Free flight has the error of its integrator.
                const double error = way.exact ? 1e-11 : way.integrator == IntegratorKind::runge_kutta_4 ? 1e-8 : 1e-4;
                EXPECT_LT(run.drift, error * fall) << name;
                EXPECT_LT(run.beyond, 1e-11) << name;
                EXPECT_LT(run.speed, 1e-12) << name;
                EXPECT_NEAR(run.force.y(), mass * g, 1e-7) << name;
                EXPECT_NEAR(run.torque.norm(), mass * g * 0.5 * length * std::cos(stop), 1e-7) << name;
            }
}

// x = A cos(w t) from 2 m to the limit at 1.5 m from the spring's rest, again and again.
TEST(LimitBounce, ASpringPressesToALimit) {
    constexpr double mass = 2.0, rate = 5.0, start = 2.0, stop = 1.5;
    for (const Way& way : ways)
        for (const double e : {0.3, 0.7}) {
            SceneDescription scene = in(way, 16);
            scene.simulation.gravity.setZero();
            add_box(scene, {0.1, 0.1, 0.1}, Vec3::Zero(), mass);
            JointDescription& joint = add_joint(scene, JointType::slider, std::nullopt, 0, Vec3::Zero());
            limit(joint.move[0], stop - start, 1.0, e);
            joint.move[0].spring = JointSpring{.stiffness = mass * rate * rate, .rest = -start};
            const double end = end_of_bounces([](double x, double) { return -rate * rate * x; }, start, stop, e);
            const Bounces run = measure(scene, end + 0.5, 0,
                                        [](const JointState& state) { return state.position[0] - (stop - start); });
            const std::string name = which(way, 16, e);
            EXPECT_GT(run.rest, 0.99 * end) << name;
            EXPECT_LT(run.rest, 1.01 * end + 1.0 / 60.0) << name;
            const double error = way.exact ? 1e-12 : way.integrator == IntegratorKind::runge_kutta_4 ? 1e-10 : 1e-4;
            EXPECT_LT(run.drift, error * mass * rate * rate * (start * start - stop * stop)) << name;
            EXPECT_LT(run.beyond, 1e-12) << name;
            EXPECT_EQ(run.speed, 0.0) << name;
            EXPECT_LT(run.force.norm(), 1e-9) << name;  // spring and limit
        }
}

// A motor whose force is at its bound, and one with a target and a damper.
TEST(LimitBounce, AMotorPressesToALimit) {
    constexpr double mass = 2.0, stop = -0.8;
    for (const Way& way : ways)
        for (const int steps : {1, 16})
            for (const double e : {0.3, 0.7})
                for (const bool target : {false, true}) {
                    SceneDescription scene = in(way, steps);
                    scene.simulation.gravity.setZero();
                    add_box(scene, {0.1, 0.1, 0.1}, Vec3::Zero(), mass);
                    JointDescription& joint = add_joint(scene, JointType::slider, std::nullopt, 0, Vec3::Zero());
                    limit(joint.move[0], stop, 1.0, e);
                    JointMotor& motor = joint.move[0].motor.emplace();
                    if (target) {
                        motor.targets = {{0.0, -1.5}};
                        motor.stiffness = 20.0;
                        motor.damping = 4.0;
                    } else {
                        motor.speed = -1000.0;
                        motor.max_force = 20.0;
                    }
                    const double end = end_of_bounces(
                        [&](double x, double v) { return (target ? -20.0 * (x + 1.5) - 4.0 * v : -20.0) / mass; }, 0.0,
                        stop, e);
                    const Bounces run =
                        measure(scene, end + 1.0, 0, [](const JointState& state) { return state.position[0] - stop; });
                    const std::string name = which(way, steps, e) + (target ? ", target" : ", speed");
                    EXPECT_GT(run.rest, 0.98 * end) << name;
                    EXPECT_LT(run.rest, 1.01 * end + 1.0 / 60.0) << name;
                    EXPECT_LT(run.drift, (target && !way.exact ? 1e-5 : 1e-12) * 20.0 * 0.8) << name;
                    EXPECT_LT(run.beyond, 1e-12) << name;
                    EXPECT_EQ(run.speed, 0.0) << name;
                    EXPECT_LT(run.force.norm(), 1e-9) << name;  // motor and limit
                }
}

// A weight on a slider whose base hangs on another one: each impact acts on both, and a limit at rest passes it on.
TEST(LimitBounce, TwoWeightsOnOneAnother) {
    for (const Way& way : ways)
        for (const double e : {0.3, 0.7}) {
            SceneDescription scene = in(way, 4);
            add_box(scene, {0.1, 0.1, 0.1}, Vec3::Zero(), 2.0);
            add_box(scene, {0.1, 0.1, 0.1}, {0.0, 1.0, 0.0}, 1.0);
            add_joint(scene, JointType::slider, std::nullopt, 0, Vec3::Zero(), Vec3::UnitY());
            add_joint(scene, JointType::slider, 0, 1, {0.0, 1.0, 0.0}, Vec3::UnitY());
            limit(scene.joints[0].move[0], -0.3, 1.0, e);
            limit(scene.joints[1].move[0], -0.7, 1.0, e);
            const Bounces run = measure(scene, 6.0, 0, [](const JointState& state) { return state.position[0] + 0.3; });
            const std::string name = which(way, 4, e);
            EXPECT_LT(run.drift, 1e-12 * 30.0) << name;
            EXPECT_LT(run.beyond, 1e-12) << name;
            EXPECT_LT(run.rest, 5.0) << name;
            EXPECT_NEAR(run.force.y(), 3.0 * g, 1e-9) << name;
            EXPECT_TRUE(run.asleep) << name;
        }
}

// The knee of a double pendulum that swings: it strikes its limits, is held there and let go.
TEST(LimitBounce, AKneeIsHeldAndLetGo) {
    for (const Way& way : ways)
        for (const double e : {0.0, 0.5}) {
            SceneDescription scene = double_pendulum_scene(4);
            scene.simulation.integrator = way.integrator;
            scene.simulation.impacts = way.impacts;
            limit(scene.joints[1].turn[0], -0.3, 0.5, e);
            std::swap(scene.joints[0], scene.joints[1]);
            int held = 0, free = 0;
            const Bounces run = measure(scene, 5.0, 3, [&](const JointState& state) {
                const double room = std::min(state.position[3] + 0.3, 0.5 - state.position[3]);
                ++(std::abs(room) < 1e-12 ? held : free);
                return room;
            });
            const std::string name = which(way, 4, e);
            const double error = way.exact ? 1e-12 : way.integrator == IntegratorKind::runge_kutta_4 ? 1e-6 : 1e-3;
            EXPECT_LT(run.drift, error * 3.0 * g) << name;
            EXPECT_LT(run.beyond, 1e-12) << name;
            if (e == 0.0) {
                EXPECT_GT(held, 20) << name;
            }
            EXPECT_GT(free, 20) << name;
        }
}

// A free figure of three rods whose joints rattle between their limits: momenta, energy and losses to rounding.
TEST(LimitBounce, AFreeFigureRattles) {
    for (const Way& way : {ways[3], ways[4]})
        for (const double e : {0.0, 0.6, 1.0}) {
            SceneDescription scene = in(way, 4);
            scene.simulation.gravity.setZero();
            for (int i = 0; i < 3; ++i) {
                BodyDescription& rod = add_box(scene, {1.0, 0.1, 0.2}, {double(i), 0.0, 0.0}, 1.0 + i);
                rod.velocity = {0.0, 0.3 * i, 0.0};
            }
            add_joint(scene, JointType::hinge, 0, 1, {0.5, 0.0, 0.0}, Vec3::UnitZ());
            add_joint(scene, JointType::ball, 1, 2, {1.5, 0.0, 0.0}, Vec3::UnitX());
            limit(scene.joints[0].turn[0], -0.2, 0.3, e);
            scene.joints[0].turn[0].friction = 0.05;
            scene.joints[1].swing = {0.3, 0.3};
            for (JointAxis& axis : scene.joints[1].turn) axis.restitution = e;
            scene.bodies[2].angular_velocity = {1.0, 2.0, 3.0};
            World world(scene);
            world.record_contacts();
            world.step();  // the velocities fit
            const auto sum = [&] {
                const Measurement m = world.measure();
                const EnergyLedger& ledger = world.contact_records().energy;
                return m.kinetic + ledger.impact_loss + ledger.friction_loss;
            };
            world.advance_frame();
            const double energy = sum(), start = world.measure().kinetic;
            const Measurement first = world.measure();
            for (int frame = 0; frame < 240; ++frame) {
                world.advance_frame();
                ASSERT_NEAR(sum(), energy, 1e-11 * start) << which(way, 4, e) << ", " << frame;
                ASSERT_GT(world.joint_states()[0].position[3], -0.2 - 1e-12);
                ASSERT_LT(world.joint_states()[0].position[3], 0.3 + 1e-12);
                ASSERT_LT(std::hypot(world.joint_states()[1].position[4], world.joint_states()[1].position[5]),
                          0.3 + 1e-9);
            }
            const Measurement last = world.measure();
            EXPECT_LT((last.momentum - first.momentum).norm(), 1e-12);
            EXPECT_LT((last.angular_momentum - first.angular_momentum).norm(), 1e-11);
            EXPECT_GT(last.kinetic, 0.05 * start);
        }
}

// e = 1: a weight bounces to its height again and again.
TEST(LimitBounce, WithoutLossItNeverRests) {
    for (const Way& way : ways) {
        SceneDescription scene = in(way, 1);
        add_box(scene, {0.1, 0.1, 0.1}, Vec3::Zero(), 2.0);
        add_joint(scene, JointType::slider, std::nullopt, 0, Vec3::Zero(), Vec3::UnitY());
        limit(scene.joints[0].move[0], -0.5, 1.0, 1.0);
        const Bounces run = measure(scene, 30.0, 0, [](const JointState& state) { return state.position[0] + 0.5; });
        EXPECT_LT(run.drift, 1e-12 * g) << way.name;
        EXPECT_EQ(run.rest, infinity) << way.name;
    }
}

// Rows: a slider twice is no tree. Its flights are those of the integrators.
TEST(LimitBounce, AWeightOnTwoSliders) {
    for (const int steps : {1, 16})
        for (const double e : {0.3, 0.7}) {
            constexpr double mass = 3.0, fall = 0.8;
            SceneDescription scene = in(ways[0], steps);
            add_box(scene, {0.1, 0.2, 0.1}, Vec3::Zero(), mass);
            for (const double x : {-0.2, 0.2})
                add_joint(scene, JointType::slider, std::nullopt, 0, {x, 0.0, 0.0}, Vec3::UnitY());
            limit(scene.joints[0].move[0], -fall, 1.5, e);
            const double end = end_of_bounces(fall, g, e);
            const Bounces run =
                measure(scene, end + 1.0, 0, [&](const JointState& state) { return state.position[0] + fall; });
            const std::string name = which(ways[0], steps, e);
            EXPECT_GT(run.rest, 0.98 * end) << name;
            EXPECT_LT(run.rest, 1.01 * end + 1.0 / 60.0) << name;
            EXPECT_LT(run.gain, 1e-9 * mass * g * fall) << name;
            EXPECT_LT(run.beyond, 1e-9) << name;
            EXPECT_LT(run.speed, 1e-9) << name;
        }
}

// Rows with contacts: the slider stands on a box on the floor.
TEST(LimitBounce, AWeightOnABoxOnTheFloor) {
    for (const int steps : {1, 16})
        for (const double e : {0.3, 0.7}) {
            constexpr double mass = 1.0, fall = 0.5;
            SceneDescription scene = ground_scene(0.0, 0.5, steps);
            add_box(scene, {1.0, 0.4, 1.0}, {0.0, 0.2, 0.0}, 20.0);
            add_box(scene, {0.2, 0.2, 0.2}, {0.0, 1.5, 0.0}, mass);
            add_joint(scene, JointType::slider, 1, 2, {0.0, 1.5, 0.0}, Vec3::UnitY());
            limit(scene.joints[0].move[0], -fall, 1.0, e);
            const Bounces run =
                measure(scene, 4.0, 0, [&](const JointState& state) { return state.position[0] + fall; });
            const std::string name = which(ways[0], steps, e);
            EXPECT_LT(run.rest, 3.5) << name;
            EXPECT_LT(run.gain, 1e-8 * mass * g * fall) << name;  // contacts settle to a tolerance
            EXPECT_LT(run.beyond, 1e-9) << name;
            EXPECT_NEAR(run.force.y(), mass * g, 1e-6) << name;
        }
}

}  // namespace
}  // namespace tumble::limit_bounce_test
