// DirectSolver: rolling and spinning friction (rotational_friction.h). Rolling friction lies in a disc as friction
// does; both have limits that follow the loads from round to round.
#include "sim/contact/direct/direct_solver.h"

#include <algorithm>
#include <cmath>

namespace tumble {

using namespace contact_rows;

// Precondition: the constraint is in its place.
void DirectSolver::add_resistance(int index, const ContactProblem& problem) {
    ConstraintRows& constraint = constraints_[std::size_t(index)];
    const Manifold& m = problem.manifolds[constraint.manifold];
    const Body &a = problem.bodies[m.a], &b = problem.bodies[m.b];
    const RotationalFriction levers = rotational_friction(m, a, b);
    if (levers.none()) return;
    constraint.resistance = int(resistances_.size());
    ResistanceRows& resistance = resistances_.emplace_back();
    resistance.constraint = index;
    resistance.levers = levers;
    const RowBodies bodies{constraint, a, b, length_};
    set_turn(resistance.rolling[0], constraint.geometry.tangent_1, bodies);
    set_turn(resistance.rolling[1], constraint.geometry.tangent_2, bodies);
    set_turn(resistance.spinning, constraint.geometry.normal, bodies);
    for (const int i : {0, 1}) resistance.rolling[i].estimate = double(m.rolling[i]);
}

void DirectSolver::set_resistance_limits() {
    for (ResistanceRows& resistance : resistances_) {
        const ConstraintRows& constraint = constraints_[std::size_t(resistance.constraint)];
        double load = 0.0;
        for (int i = 0; i < constraint.count; ++i) load += constraint.normal[i].estimate;
        resistance.rolling_limit = resistance.levers.rolling * load;
        resistance.spinning_limit = resistance.levers.spinning * load;
    }
}

// Impulses for velocities at a fraction of the Newton step; with `weigh` the weights in the second derivatives too.
void DirectSolver::evaluate_resistance(double along, bool weigh) {
    const double stiffness = length_ * length_ / friction_compliance_;
    for (ResistanceRows& resistance : resistances_) {
        double y[3], square = 0.0;
        for (int i = 0; i < 3; ++i) {
            const Row& row = resistance.row(i);
            y[i] = row.estimate - (row.speed + along * row.change) * stiffness;
            if (i < 2) square += y[i] * y[i];
        }
        const double size = std::sqrt(square);
        const bool rolls = size > resistance.rolling_limit, spins = std::abs(y[2]) > resistance.spinning_limit;
        const double scale = rolls ? resistance.rolling_limit / size : 1.0;
        resistance.rolling[0].impulse = scale * y[0];
        resistance.rolling[1].impulse = scale * y[1];
        resistance.spinning.impulse = std::clamp(y[2], -resistance.spinning_limit, resistance.spinning_limit);
        if (!weigh) continue;
        for (int i = 0; i < 2; ++i)
            for (int k = 0; k < 2; ++k)
                resistance.weights[i][k] = scale * stiffness * ((i == k) - (rolls ? y[i] * y[k] / square : 0.0));
        resistance.weights[2][2] = spins ? 0.0 : stiffness;
    }
}

// N m s on B.
Vec3 DirectSolver::resistance_of(const ConstraintRows& constraint) const {
    const ResistanceRows& resistance = resistances_[std::size_t(constraint.resistance)];
    const ContactConstraint& geometry = constraint.geometry;
    return resistance.rolling[0].impulse * geometry.tangent_1 + resistance.rolling[1].impulse * geometry.tangent_2 +
           resistance.spinning.impulse * geometry.normal;
}

}  // namespace tumble
