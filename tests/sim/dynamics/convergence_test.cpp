// Properties of each integrator: its order, its energy error in the long run, its reversibility.
#include "sim/dynamics/integrator.h"
#include "sim/dynamics/integrators/extrapolation.h"
#include "sim/dynamics/integrators/runge_kutta_4.h"
#include "sim/dynamics/integrators/splitting.h"
#include "sim/random_shapes.h"
#include "support/motion_reference.h"

#include <gtest/gtest.h>

#include <functional>

namespace tumble::convergence_test {
using namespace tumble::testing;

namespace {

// An asymmetric body, free or under gravity, drag and a force at a point that rotates with it.
struct Problem {
    double mass = 2.0;
    Vec3 inertia{0.2, 0.5, 0.6}, gravity = Vec3::Zero(), wind = Vec3::Zero(), point = Vec3::Zero(),
                                 force = Vec3::Zero();
    double drag = 0.0;  // N s^2 / m^2
    RigidState start;

    Problem() {
        start.orientation = Quat(0.8, 0.2, -0.4, 0.4).normalized();
        start.momentum = mass * Vec3(3.0, 4.0, -1.0);
        start.angular_momentum = start.orientation * inertia.cwiseProduct(Vec3(1.0, 2.5, -1.5));
    }
    static Problem driven() {
        Problem p;
        p.gravity = Vec3(0.0, -9.81, 0.0);
        // Fast relative to the air: near zero speed |u| u has a singularity, and the order shows at smaller steps only.
        p.start.momentum = p.mass * Vec3(30.0, 4.0, -1.0);
        p.wind = Vec3(2.0, 0.0, 1.0);
        p.drag = 0.02;
        p.point = Vec3(0.3, 0.2, 0.1);
        p.force = Vec3(-1.0, 3.0, 2.0);
        return p;
    }
    Wrench operator()(const Vec3&, const Vec3& velocity, const Mat3& rotation) const {
        const Vec3 u = wind - velocity, f = rotation * force;
        return {mass * gravity + drag * u.norm() * u + f, (rotation * point).cross(f)};
    }
    RigidMass rigid_mass() const {
        return {1.0 / mass, Mat3(inertia.cwiseInverse().asDiagonal()), inertia, Quat::Identity()};
    }
    Body body() const {
        Body b;
        b.mass = mass;
        b.inverse_mass = 1.0 / mass;
        b.inertia_body = inertia.asDiagonal();
        b.inverse_inertia_body = inertia.cwiseInverse().asDiagonal();
        set_state(b, start);
        return b;
    }
    ReferenceBody reference() const {
        ReferenceBody r;
        r.mass = mass;
        r.drag = drag;
        r.force_turns = true;
        const Vec3 v = start.momentum / mass;
        for (int i = 0; i < 3; ++i) {
            const auto n = std::size_t(i);
            r.inertia[n] = inertia[i], r.gravity[n] = gravity[i], r.wind[n] = wind[i];
            r.point[n] = point[i], r.force[n] = force[i];
            r.y[n] = start.position[i], r.y[4 + n] = start.orientation.vec()[i];
            r.y[7 + n] = v[i], r.y[10 + n] = start.angular_momentum[i];
        }
        r.y[3] = start.orientation.w();
        return r;
    }
    double energy(const RigidState& s) const {
        const Vec3 m = s.orientation.conjugate() * s.angular_momentum;
        return 0.5 * (s.momentum.squaredNorm() / mass + m.dot(m.cwiseQuotient(inertia)));
    }
};

using Method = std::function<void(const Problem&, RigidState&, double h, int steps)>;

Method euler(bool symplectic, RotationForm form) {
    return [=](const Problem& p, RigidState& state, double h, int steps) {
        Body body = p.body();
        set_state(body, state);
        for (int i = 0; i < steps; ++i) {
            const Vec3 v = body.velocity, omega = body.angular_velocity;
            const Wrench wrench = p(body.position, v, body.rotation);
            advance_momenta(body, wrench.force, wrench.torque, h);
            body.derive();
            advance_pose(body, symplectic ? body.velocity : v, symplectic ? body.angular_velocity : omega, h, form);
            body.derive();
        }
        state = state_of(body);
    };
}

template <class Step>
Method method(Step step) {
    return [=](const Problem& p, RigidState& state, double h, int steps) {
        const RigidMass mass = p.rigid_mass();
        for (int i = 0; i < steps; ++i) step(state, mass, ForceLaw(p), h);
    };
}

struct Named {
    const char* name;
    Method run;
    double order;
    int steps;  // for one second, in the asymptotic range and far above rounding
};

std::vector<Named> ladder() {
    return {{"explicit Euler, quaternion", euler(false, RotationForm::quaternion), 1.0, 800},
            {"explicit Euler, matrix", euler(false, RotationForm::matrix), 1.0, 800},
            {"symplectic Euler, quaternion", euler(true, RotationForm::quaternion), 1.0, 800},
            {"symplectic Euler, matrix", euler(true, RotationForm::matrix), 1.0, 800},
            {"splitting", method(splitting_step), 2.0, 200},
            {"Runge-Kutta", method(runge_kutta_4_step), 4.0, 100},
            {"extrapolation", method(extrapolation_step), 10.0, 6}};
}

struct Error {
    double position, angle, momentum, angular_momentum;
};

Error error_of(const Problem& p, const ReferenceBody& truth, const Method& run, int steps) {
    RigidState s = p.start;
    run(p, s, 1.0 / steps, steps);
    return {(s.position - truth.position()).norm(), truth.angle_to(s.orientation),
            (s.momentum / p.mass - truth.velocity()).norm(), (s.angular_momentum - truth.angular_momentum()).norm()};
}

void expect_order(const char* what, double coarse, double fine, const Named& m) {
    const double slope = std::log2(coarse / fine);
    EXPECT_NEAR(slope, m.order, 0.06 * m.order) << m.name << ", " << what << ": " << coarse << ", " << fine;
}

}  // namespace

TEST(Convergence, FreeRotationHasTheOrderOfTheMethod) {
    const Problem p;
    ReferenceBody truth = p.reference();
    truth.advance(1.0, 40000);
    for (const Named& m : ladder()) {
        const Error coarse = error_of(p, truth, m.run, m.steps), fine = error_of(p, truth, m.run, 2 * m.steps);
        expect_order("angle", coarse.angle, fine.angle, m);
        EXPECT_LT(fine.position, 1e-12) << m.name;  // rounding of thousands of steps
    }
}

TEST(Convergence, DragAndAForceAtAPointKeepTheOrder) {
    const Problem p = Problem::driven();
    ReferenceBody truth = p.reference();
    truth.advance(1.0, 40000);
    for (const Named& m : ladder()) {
        const Error coarse = error_of(p, truth, m.run, m.steps), fine = error_of(p, truth, m.run, 2 * m.steps);
        expect_order("position", coarse.position, fine.position, m);
        expect_order("angle", coarse.angle, fine.angle, m);
        expect_order("velocity", coarse.momentum, fine.momentum, m);
        expect_order("angular momentum", coarse.angular_momentum, fine.angular_momentum, m);
    }
}

// Over a million steps, sampled a hundred times: the splitting's energy stays in its initial band; that of the others
// drifts at a steady rate.
TEST(Convergence, EnergyInTheLongRun) {
    const Problem p;
    const int blocks = 100, steps = trials(trials(10000));
    const double h = 0.01, energy = p.energy(p.start);
    const auto band = [&](const Method& run, double& early, double& late) {
        RigidState s = p.start;
        early = late = 0.0;
        for (int i = 0; i < blocks; ++i) {
            for (int k = 0; k < 10; ++k) {
                run(p, s, h, steps / 10);
                const double error = std::fabs(p.energy(s) / energy - 1.0);
                (i < blocks / 10 ? early : late) = std::max(i < blocks / 10 ? early : late, error);
            }
        }
        EXPECT_EQ(s.angular_momentum, p.start.angular_momentum);
    };
    double early, late;
    band(method(splitting_step), early, late);
    EXPECT_LT(late, 1.2 * early);
    EXPECT_LT(late, 5e-4);
    band(method(runge_kutta_4_step), early, late);
    EXPECT_GT(late, 2.5 * early);
    // In proportion to time, for long times.
    if (steps == 10000) {
        EXPECT_NEAR(late / early, 10.0, 2.0) << early << ", " << late;
    }
    band(euler(true, RotationForm::quaternion), early, late);
    EXPECT_GT(late, 0.01);
}

TEST(Convergence, ExtrapolationHardlyLosesEnergy) {
    const Problem p;
    RigidState s = p.start;
    method(extrapolation_step)(p, s, 0.05, trials(trials(20000)));
    EXPECT_LT(std::fabs(p.energy(s) / p.energy(p.start) - 1.0), 1e-9);
    EXPECT_EQ(s.angular_momentum, p.start.angular_momentum);
}

// Run forward, reverse the momenta, run as far again: back at the start, up to rounding. No other integrator does.
TEST(Convergence, SplittingRunsBack) {
    Problem p = Problem::driven();
    p.drag = 0.0;  // which is not reversible
    const auto distance = [&](const Method& run) {
        RigidState s = p.start;
        run(p, s, 0.01, 1000);
        s.momentum = -s.momentum;
        s.angular_momentum = -s.angular_momentum;
        run(p, s, 0.01, 1000);
        return (s.position - p.start.position).norm() + s.orientation.angularDistance(p.start.orientation) +
               (s.momentum + p.start.momentum).norm() + (s.angular_momentum + p.start.angular_momentum).norm();
    };
    EXPECT_LT(distance(method(splitting_step)), 1e-9);
    EXPECT_GT(distance(method(runge_kutta_4_step)), 1e-6);
    EXPECT_GT(distance(euler(true, RotationForm::quaternion)), 1e-3);
}

// The principal axes of the mass may be given in any frame.
TEST(Convergence, PrincipalAxesRotatedInTheBody) {
    const Problem p;
    const Quat axes = Quat(0.3, 0.5, -0.7, 0.2).normalized();
    RigidMass turned = p.rigid_mass();
    turned.principal_axes = axes;
    const Mat3 r = axes.toRotationMatrix();
    turned.inverse_inertia = r * turned.inverse_inertia * r.transpose();
    for (const auto step : {splitting_step, runge_kutta_4_step, extrapolation_step}) {
        RigidState a = p.start, b = p.start;
        b.orientation = b.orientation * axes.conjugate();
        for (int i = 0; i < 100; ++i) {
            step(a, p.rigid_mass(), ForceLaw(p), 0.01);
            step(b, turned, ForceLaw(p), 0.01);
        }
        EXPECT_LT((a.orientation.coeffs() - (b.orientation * axes).coeffs()).norm(), 1e-13);
    }
}

}  // namespace tumble::convergence_test
