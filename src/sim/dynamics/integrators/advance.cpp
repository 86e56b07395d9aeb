#include "sim/dynamics/integrators/advance.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "sim/dynamics/integrators/extrapolation.h"
#include "sim/dynamics/integrators/runge_kutta_4.h"
#include "sim/dynamics/integrators/splitting.h"
#include "sim/math/free_rotation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Phase, rad, of one step of the tenth-order extrapolation: the error of the step is about 1e-14 (bench_accuracy).
/// Related test: AdvanceExactly.ForcesAtPointsAgainstTheReference.
constexpr double extrapolation_phase = 0.2;

/// The drag force |u| u is not smooth where a body comes to rest relative to the air. The time until then counts as
/// this phase (rad), until the drag is below `extrapolation_no_drag` of the change of velocity. Related test:
/// AdvanceExactly.ThrownUpThroughAir.
constexpr double extrapolation_rest_in_air = 2.0;
constexpr double extrapolation_no_drag = 1e-14;

/// Largest number of substeps in a span: half a second of computing. Only bodies far lighter than the air that they
/// push need more. Not fitted: a bound of the cost. Related test: AdvanceExactly.LightBodiesInThickAir.
constexpr int most_substeps = 200000;

/// Calls part(start, end, law) for the parts of [from, to] within which no force begins or ends.
template <class Part>
void for_each_span(const Body& body, const ForceField& forces, std::size_t index, double from, double to,
                   const Part& part) {
    while (from < to) {
        const double end = std::min(to, forces.next_change(index, from));
        // A force that acts at the part's middle acts throughout; at the part's ends, rounding of times would decide.
        const double middle = 0.5 * (from + end);
        const auto law = [&](const FlightPoint& at) {
            return forces.in_flight(index, body, at, {middle, from}, forces.held(index));
        };
        part(from, end, law);
        from = end;
    }
}

// The power of two between the cube root of x and twice that: libm's cbrt differs between platforms.
double cube_root_above(double x) {
    int exponent = 0;
    std::frexp(x, &exponent);
    return std::ldexp(1.0, exponent > 0 ? (exponent + 2) / 3 : exponent / 3);
}

// Rate (1/s) of change of the motion: by drag, by the rotation, and of the angular velocity by the torque.
struct Drag {
    double rate;  // 1/m, ForceField::drag_rate()
    Vec3 wind;    // m/s
};

double rate_of(const RigidState& s, const RigidMass& mass, const ForceLaw& law, bool turns, const Drag& drag,
               double span) {
    const Vec3 velocity = mass.inverse_mass * s.momentum;
    const Mat3 rotation = s.orientation.toRotationMatrix();
    const Wrench wrench = law({s.position, velocity, s.angular_momentum, rotation, s.elapsed});
    double rate = 0.0;
    if (drag.rate > 0.0) {
        // The rate of dv/dt = a - k |u| u, k half the drag rate, is k |u|; where the speed still builds up, sqrt(k a).
        const double speed = (velocity - drag.wind).norm(), acceleration = mass.inverse_mass * wrench.force.norm();
        rate += drag.rate * speed + std::sqrt(drag.rate * acceleration);
        // The singularity is |u| / a away. Over h it contributes k a^2 h^3 to the velocity, which vanishes for small h.
        if (acceleration > 0.0) {
            const double nothing = extrapolation_no_drag * (velocity.norm() + acceleration * span);
            const double finest = cube_root_above(drag.rate * acceleration * acceleration / nothing);
            rate += extrapolation_rest_in_air * std::min(acceleration / speed, finest);
        }
    }
    if (turns) {
        const double most = 1.0 / mass.principal_inertia.minCoeff();
        const Vec3 omega = mass.inverse_inertia * (rotation.transpose() * s.angular_momentum);  // body axes
        const double twice_energy = omega.dot(rotation.transpose() * s.angular_momentum);
        rate += std::min(std::sqrt(std::max(0.0, twice_energy) * most), s.angular_momentum.norm() * most);
        rate += std::sqrt(wrench.torque.norm() * most);
    }
    return rate;
}

/// Thin plates bob, and light bodies are braked, within less than a step, which is then divided into parts.
constexpr double most_water_parts = 256.0;

int parts_in_water(const RigidState& state, const RigidMass& mass, const ForceField& forces, const Body& body,
                   std::size_t index, double from, double to) {
    const Vec3 velocity = mass.inverse_mass * state.momentum;
    const Mat3 rotation = rotation_of(state.orientation);
    const FlightPoint at{state.position, velocity, state.angular_momentum, rotation, 0.0};
    return int(std::clamp(std::ceil(forces.parts_in_water(index, body, at, from, to)), 1.0, most_water_parts));
}

}  // namespace

bool steps_whole_state(IntegratorKind kind) {
    return kind == IntegratorKind::splitting || kind == IntegratorKind::runge_kutta_4;
}

void advance_one_step(Body& body, IntegratorKind kind, const ForceField& forces, std::size_t index, double from,
                      double to) {
    RigidState state = state_of(body);
    const RigidMass mass = mass_of(body);
    for_each_span(body, forces, index, from, to, [&](double start, double end, const auto& law) {
        state.elapsed = 0.0;
        const double span = end - start;
        for (double done = 0.0;;) {
            const double rest = span - done;
            const int parts =
                forces.has_water() ? parts_in_water(state, mass, forces, body, index, start + done, end) : 1;
            const double h = parts > 1 ? std::min(rest, std::max(rest / parts, span / most_water_parts)) : rest;
            if (kind == IntegratorKind::splitting)
                splitting_step(state, mass, ForceLaw(law), h);
            else
                runge_kutta_4_step(state, mass, ForceLaw(law), h);
            done += h;
            if (!(h < rest)) break;
        }
    });
    set_state(body, state);
}

RigidState advance_exactly(const Body& body, const RigidState& start_state, const ForceField& forces, std::size_t index,
                           double from, double to) {
    RigidState state = start_state;
    const RigidMass mass = mass_of(body);
    const Drag drag{forces.drag_rate(body), forces.wind()};
    for_each_span(body, forces, index, from, to, [&](double start, double end, const auto& law) {
        state.elapsed = 0.0;
        const double span = end - start;
        const bool turns = !forces.torque_free(index, 0.5 * (start + end));
        const FreeRotation rotation(mass.principal_inertia, mass.principal_axes, state.orientation,
                                    state.angular_momentum);
        if (forces.constant(index, start, end)) {
            const Vec3 still = Vec3::Zero();
            const Mat3 upright = Mat3::Identity();
            const Vec3 force = ForceLaw(law)({state.position, still, still, upright, 0.0}).force;
            state.position += span * mass.inverse_mass * (state.momentum + 0.5 * span * force);
            state.momentum += span * force;
        } else {
            // Only forces at points depend on the orientation: without them it is excluded from the steps.
            RigidMass moved = mass;
            const Vec3 angular_momentum = state.angular_momentum;
            if (!turns) state.angular_momentum.setZero();
            double done = 0.0;
            for (int step = 0; done < span; ++step) {
                if (step == most_substeps) {
                    throw RunError(
                        fmt::format("the motion of body '{}' from t = {:.6g} s to {:.6g} s needs more "
                                    "than {} steps: the forces on it are too large for its mass",
                                    safe_text(body.name), start, end, most_substeps));
                }
                const Vec3 velocity = mass.inverse_mass * state.momentum;
                const Mat3 attitude = rotation_of(state.orientation);
                const double rate =
                    rate_of(state, moved, ForceLaw(law), turns, drag, span) +
                    forces.field_rate(index, body,
                                      {state.position, velocity, state.angular_momentum, attitude, state.elapsed},
                                      0.5 * (start + end));
                // Divides the rest into equal steps at the present rate; the next step decides anew.
                const double rest = span - done;
                double count = std::ceil(rest * rate / extrapolation_phase);
                if (forces.has_water() && step < int(most_water_parts))
                    count =
                        std::max(count, double(parts_in_water(state, moved, forces, body, index, start + done, end)));
                extrapolation_step(state, moved, ForceLaw(law), count > 1.0 ? rest / count : rest);
                if (!(count > 1.0)) break;
                done += rest / count;
            }
            if (!turns) state.angular_momentum = angular_momentum;
        }
        if (!turns) state.orientation = rotation.at(span);
    });
    return state;
}

}  // namespace tumble
