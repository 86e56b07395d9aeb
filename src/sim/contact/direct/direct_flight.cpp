// DirectSolver: the step of joined bodies that touch nothing and whose joints form a tree, in joint coordinates.
#include "sim/contact/direct/direct_solver.h"
#include "sim/joints/flight_way.h"
#include "sim/joints/settings.h"
#include "sim/math/keyframe_track.h"

#include <algorithm>
#include <array>
#include <vector>

namespace tumble {

// Fine integrators find the limits; where rounding stops them, compositions of Verlet's method fly. By that method a step
// that meets a limit is flown again by the method of Runge and Kutta.
TreeFlight::Outcome DirectSolver::advance_tree(const JointIsland& island, int& substeps) {
    using Outcome = TreeFlight::Outcome;
    const ContactProblem& problem = island.problem;
    TreeStep step{problem.bodies, island.bodies,      flying_,       *problem.forces,
                  island.from,    problem.settings.h, island.length, problem.joints->to() - problem.joints->from()};
    const TreeMethod method = tree_method(problem.bodies, island.bodies);
    Outcome outcome = Outcome::declined;
    if (!method.verlet()) {
        outcome = tree_flight_.advance(step, method, substeps);
        if (outcome != Outcome::declined || !tree_flight_.is_tree()) return outcome;
        return tree_flight_.advance(step, {IntegratorKind::splitting, method.order}, substeps);
    }
    const auto any = [&](bool (*is)(const Joint&)) {
        return std::any_of(flying_.begin(), flying_.end(), [&](const Joint* joint) { return is(*joint); });
    };
    const auto fly_to_limits = [&] {
        step.most_steps = tuning::tree_few_steps;
        return tree_flight_.advance(step, {IntegratorKind::runge_kutta_4, method.order}, substeps);
    };
    const bool rests = any(at_limit), may_meet = !rests && any(limited);
    if (rests && (outcome = fly_to_limits()) != Outcome::declined) return outcome;
    std::vector<RigidState> states;
    std::vector<std::array<double, Joint::coordinates>> values;
    if (may_meet) {
        for (const std::uint32_t i : island.bodies) states.push_back(state_of(problem.bodies[i]));
        for (const Joint* joint : flying_) values.push_back(joint->value);
    }
    outcome = tree_flight_.advance(step, method, substeps);
    if (!may_meet || outcome == Outcome::flown || !tree_flight_.is_tree()) return outcome;
    for (std::size_t k = 0; k < states.size(); ++k) set_state(problem.bodies[island.bodies[k]], states[k]);
    for (std::size_t k = 0; k < values.size(); ++k) {
        flying_[k]->value = values[k];
        flying_[k]->broken = false;
    }
    return fly_to_limits();
}

// Lists the joints, if their laws are those of trees in flight. Loops have more joints than bodies.
bool DirectSolver::find_flying(const JointIsland& island) {
    const ContactProblem& problem = island.problem;
    flying_.clear();
    if (!problem.forces || island.joints.size() > island.bodies.size()) return false;
    for (const std::uint32_t k : island.joints)
        flying_.push_back(&problem.joints->joints()[problem.joints->active()[k]]);
    return tree_laws(flying_, problem.bodies);
}

// Returns false, with all as it was, where the bodies do not fly.
bool DirectSolver::fly_tree(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                            std::span<const std::uint32_t> joints) {
    double length = 0.0;
    for (const std::uint32_t i : bodies) length += problem.bodies[i].radius / double(bodies.size());
    const JointIsland island{problem, bodies, joints, length, problem.joints->from(), problem.joints->to()};
    if (!find_flying(island)) return false;
    const double h = problem.settings.h;
    int substeps = 1;
    values_.clear();
    for (const Joint* joint : flying_) {
        substeps = std::max(substeps, joint->substeps);
        values_.push_back(joint->value);
    }
    flown_from_.clear();
    for (const std::uint32_t i : bodies) {
        Body& body = problem.bodies[i];
        const BodyVelocity& before = problem.before[i];
        flown_from_.push_back({body.position, body.orientation, body.momentum, body.angular_momentum});
        // Without the forces of the step.
        body.momentum -= body.mass * (body.velocity - before.velocity);
        const Vec3 turned = body.angular_velocity - before.angular_velocity;
        if (!turned.isZero(0.0))
            body.angular_momentum -= body.rotation * (body.inertia_body * (body.rotation.transpose() * turned));
        body.derive_velocities();
    }
    const TreeFlight::Outcome outcome = advance_tree(island, substeps);
    if (outcome != TreeFlight::Outcome::flown) {
        for (std::size_t k = 0; k < bodies.size(); ++k) set_state(problem.bodies[bodies[k]], flown_from_[k]);
        for (std::size_t k = 0; k < flying_.size(); ++k) {
            Joint& joint = *flying_[k];
            joint.value = values_[k];
            joint.impulse = {};
            joint.force.setZero();
            joint.torque.setZero();
            joint.broken = false;
        }
        return false;
    }
    swing_ = tree_flight_.swing();
    for (Joint* joint : flying_) joint->substeps = next_substeps(true, substeps);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        Body& body = problem.bodies[bodies[k]];
        const RigidState& start = flown_from_[k];
        // Back to the start: the step's velocities move the body to its end.
        body.push_velocity = (body.position - start.position) / h - body.velocity;
        body.push_angular_velocity =
            rotation_vector(body.orientation * start.orientation.conjugate()) / h - body.angular_velocity;
        body.position = start.position;
        body.orientation = start.orientation;
        body.rotation = start.orientation.toRotationMatrix();
        body.placed = true;
    }
    return true;
}

}  // namespace tumble
