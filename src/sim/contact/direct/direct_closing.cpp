// DirectSolver: the passes that close the joints of an island at the end of a step or substep, for its velocities and
// for the position correction.
#include "sim/contact/direct/direct_solver.h"
#include "sim/contact/direct/settings.h"
#include "sim/dynamics/integrator.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Factor of that compliance where two passes in a row leave more than half of the error. Not fitted: a pass then
/// leaves a hundredth, and the impulses lose two more digits.
constexpr double joint_stiffer = 1e-2;

/// Stiffness of joints in the position correction, over the mean mass of the bodies, where an error is moved out. Near
/// a singular position, as of a taut chain, it is closed by displacements up to half the square root of this times as
/// large.
constexpr double joint_correction_apart = 1e3;

/// Stiffness of closed joints there, over the mass of the island: a hundred times that of contacts, so that each pass
/// makes their errors up to a hundred times smaller.
constexpr double joint_correction_closed = 1e4;

/// Convergence of the rounds without contacts, relative to the impulses. Related test:
/// JointLaws.AMotorOpensADoorToItsLimit.
constexpr double joint_round_tolerance = 1e-8;

/// Passes after which such a position ends them. Not fitted: others contract by 10 in each.
constexpr int joint_singular_rounds = 8;

/// Error, in sizes of the joint, at which the joints of an island in contact count as closed after
/// tuning::direct_rounds rounds, and once the impulses have settled; and error of a gap at the end of the step, in
/// sizes of the contact, once they have settled. Not fitted: the next step closes the rest.
constexpr double joint_contact_closed = 1e-7;
constexpr double joint_contact_settled = 1e-8;
constexpr double joint_corner_closed = 1e-5;

/// Least turn, rad, of a body in a step in which the gaps of corners are closed: the rest of the gap is half its
/// square, in sizes of the contact. Not fitted: less is invisible.
constexpr double joint_corner_turn = 0.005;

/// Change of the velocities in a round, as a share of the change in the step, at which the impulses in contact count as
/// settled. Not fitted: larger ones let resting bodies creep.
constexpr double joint_contact_rest = 1e-6;

}  // namespace

using namespace contact_rows;

// Position correction: correct_overlaps() for islands with joints. Contacts push, closed joints stay closed, at the end
// of the step and to rounding: passes as for the velocities.
bool DirectSolver::correct_joined(const JointIsland& island, bool moved) {
    const bool overlaps = correct_overlaps(island.problem.settings.h);
    const double mean = total_mass_ / double(masses_.size());
    const bool apart = joints_.start_correction(island, tuning::joint_correction_share,
                                                {joint_correction_apart * mean, joint_correction_closed * total_mass_});
    if (!overlaps && !apart) return false;
    if (!factor(true)) {
        std::fill(correction_.begin(), correction_.end(), 0.0);
        return false;
    }
    const std::vector<double> contacts = correction_;
    double last = infinity;
    for (int pass = 0; pass < tuning::joint_rounds; ++pass) {
        correction_ = contacts;
        joints_.add_correction(correction_);
        matrix_.solve(correction_);
        predict_ends(island, moved);
        const double error = joints_.close_correction(island, ends_, correction_);
        if (error <= tuning::joint_closed || (error < tuning::joint_rounding && error >= 0.5 * last)) return true;
        if (!(error < last)) break;
        last = error;
    }
    // Overlaps and violated limits that cannot be moved out with closed joints stay.
    std::fill(correction_.begin(), correction_.end(), 0.0);
    return false;
}

// Factors the matrix, unless it is that of the last factorization: with joints alone, the passes of a step share one.
bool DirectSolver::factored() {
    if (joints_.empty()) return factor(false);
    joints_.evaluate_with_weights();
    if (constraints_.empty() && factored_ && !joints_.weights_changed()) return true;
    factored_ = factor(false);
    return factored_;
}

// Poses at the end of the step, moved by the velocities of the solve and the correction as the bodies will be; `moved`:
// they have been moved, but for the correction.
void DirectSolver::predict_ends(const JointIsland& island, bool moved) {
    const double h = island.problem.settings.h;
    ends_.resize(island.bodies.size());
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        Body& body = island.problem.bodies[island.bodies[k]];
        const Vec3 correction = three(correction_, 6 * k),
                   correction_rotation = three(correction_, 6 * k + 3) / length_;
        if (moved) {
            ends_[k] = {body.position + h * correction,
                        (from_rotation_vector(h * correction_rotation) * body.orientation).normalized()};
            continue;
        }
        const Vec3 omega = three(velocity_, 6 * k + 3) / length_ - body.gyration;
        // The gyroscopic correction is that of the new angular velocity.
        const Vec3 omega_before = body.angular_velocity, momentum_before = body.angular_momentum;
        body.angular_velocity = omega;
        body.angular_momentum = length_ * length_ * (masses_[k].inertia * omega);
        const Vec3 turn = omega + gyration(body, h) + correction_rotation;
        body.angular_velocity = omega_before;
        body.angular_momentum = momentum_before;
        ends_[k].position = body.position + h * (three(velocity_, 6 * k) + correction);
        ends_[k].orientation = (from_rotation_vector(h * turn) * body.orientation).normalized();
    }
}

// One Newton step, where it solves the whole problem: joints alone, none of which reaches or leaves a bound. The rest
// is rounding, and left to the next pass.
bool DirectSolver::step_linear() {
    if (!constraints_.empty()) return false;
    joints_.evaluate_speeds(velocity_);
    gradient(gradient_);
    if (!factored()) return false;
    for (std::size_t i = 0; i < step_.size(); ++i) step_[i] = -gradient_[i];
    matrix_.solve(step_);
    for (std::size_t i = 0; i < step_.size(); ++i) velocity_[i] += step_[i];
    joints_.evaluate_speeds(velocity_);
    joints_.evaluate_with_weights();
    if (joints_.weights_changed()) factored_ = false;
    return factored_;
}

// Beside contacts, and where Newton's method stalls on its bounds, the friction of joints starts soft as that of
// contacts.
void DirectSolver::set_friction_compliance(double compliance) {
    friction_compliance_ = compliance;
    if (joint_friction_softens_) joints_.soften_friction(compliance / (tuning::direct_friction_stiff * compliance_));
}

// True if no body in contact is faster than the forces change velocities in a step. Rounds that end with soft friction
// leave a creep there, which the next steps go on with.
bool DirectSolver::comes_to_rest(const JointIsland& island) const {
    return !constraints_.empty() && std::all_of(island.bodies.begin(), island.bodies.end(), [&](std::uint32_t i) {
        const BodyVelocity& before = island.problem.before[i];
        return before.velocity.norm() <= speed_scale_ && length_ * before.angular_velocity.norm() <= speed_scale_;
    });
}

// True if the last round has changed no velocity: where bodies jam, impulses may have no limit and keep changing.
bool DirectSolver::moves_no_body() const {
    const double least = (near_rest_ ? tuning::joint_rest : joint_contact_rest) * speed_scale_;
    for (std::size_t k = 0; k < velocity_.size(); ++k)
        if (!(std::abs(velocity_[k] - kept_[k]) <= least)) return false;
    return true;
}

// Moves the targets of contacts such that the gaps at the end of the step are those of corners on their arcs over the
// turned faces, and not of corners on the tangents. Returns the largest change of a gap under load, in sizes of the
// contact.
double DirectSolver::close_contacts(const JointIsland& island) {
    const ContactProblem& problem = island.problem;
    const double h = problem.settings.h;
    struct Way {
        Vec3 moved = Vec3::Zero();  // m, of the center
        Mat3 turn = Mat3::Identity();
    };
    const auto way_of = [&](int place, const Body& body) {
        if (place != none) {
            const JointSide& end = ends_[std::size_t(place)];
            return Way{end.position - body.position,
                       (end.orientation * body.orientation.conjugate()).toRotationMatrix()};
        }
        if (!body.moves()) return Way{};
        return Way{h * body.velocity, from_rotation_vector(h * body.angular_velocity).toRotationMatrix()};
    };
    double worst = 0.0;
    for (ConstraintRows& constraint : constraints_) {
        const Manifold& m = problem.manifolds[constraint.manifold];
        if (m.corners == Corners::neither) continue;  // balls and crossing edges: see predicted_gap.h
        const Body &body_a = problem.bodies[m.a], &body_b = problem.bodies[m.b];
        const Way a = way_of(constraint.a, body_a), b = way_of(constraint.b, body_b);
        const Vec3& n = constraint.geometry.normal;
        const Vec3 normal = m.corners == Corners::of_b ? a.turn * n : b.turn * n;
        for (int i = 0; i < constraint.count; ++i) {
            Row& row = constraint.normal[i];
            const ContactConstraint::Point& p = constraint.geometry.points[std::size_t(i)];
            const bool predicted = p.separation != m.points[std::size_t(p.source)].separation;
            if (constraint.rebound[i] > 0.0 || predicted) continue;
            const Vec3 apart = (body_b.position + p.arm_b) - (body_a.position + p.arm_a);
            const Vec3 at_end = apart + (b.moved + b.turn * p.arm_b - p.arm_b) - (a.moved + a.turn * p.arm_a - p.arm_a);
            const double speed = (normal.dot(at_end) - n.dot(apart)) / h;  // the mean over the step
            const double target = std::min(0.0, constraint.overlap[i] / h) + row.speed - speed;
            if (row.impulse > 0.0) worst = std::max(worst, std::abs(target - row.target) * h / constraint.size);
            row.target = target;
        }
    }
    return worst;
}

// Where the passes do not converge, as where contacts and joints exclude each other, the last one would leave large
// impulses and their energy. The velocities then fit joints and contacts at the start of the part: a projection that
// gains no energy, and leaves gaps of second order.
void DirectSolver::fit_start(const JointIsland& island) {
    joints_.aim_at_start(island);
    each_contact_row([](const ConstraintRows&, Row& row) { row.estimate = 0.0; });
    for (ConstraintRows& constraint : constraints_) {
        for (int i = 0; i < constraint.count; ++i) {
            constraint.rebound[i] = 0.0;
            constraint.normal[i].target = std::min(0.0, constraint.overlap[i] / island.problem.settings.h);
        }
    }
    close_joints(island, false);
}

// Newton's method, the rounds of the multipliers, and with `moving` the passes that close the joints at the end of the
// part, all in one loop: each pass uses the last solution.
DirectSolver::Closing DirectSolver::close_joints(const JointIsland& island, bool moving) {
    joint_friction_softens_ = !constraints_.empty();
    set_friction_compliance(tuning::direct_friction_soft * compliance_);
    near_rest_ = comes_to_rest(island);
    start();
    const double closed = std::max(tuning::joint_closed, joints_.rounding(island, fastest_, lightest_));
    double noise = joints_.rounding(fastest_);  // N s
    const double rounding = std::max(tuning::joint_rounding, 100.0 * closed);
    const double open = constraints_.empty() ? rounding : std::max(rounding, joint_contact_closed);
    consistent_ = true;
    settled_ = false;
    limits_held_ = false;
    const double most_turn = joint_corner_turn / island.problem.settings.h;  // rad/s
    const bool turns = std::any_of(island.bodies.begin(), island.bodies.end(), [&](std::uint32_t i) {
        return island.problem.bodies[i].angular_velocity.squaredNorm() > most_turn * most_turn;
    });
    const int most_rounds = near_rest_ ? tuning::joint_rounds : tuning::direct_rounds;
    double& last = gap_left_ = infinity;
    int slow = 0;  // passes in a row that do not contract
    bool stiffened = false;
    bool found = false;
    kept_ = velocity_;
    for (int round = 0; round < tuning::joint_rounds; ++round) {
        if (found) kept_ = velocity_;
        const bool trial = !joint_friction_softens_ && joints_.any_friction();
        const int most_steps = found   ? tuning::joint_newton_steps
                               : trial ? tuning::joint_trial_newton_steps
                                       : tuning::joint_first_newton_steps;
        if (!step_linear() && !minimize(most_steps)) {
            if (found) {
                velocity_ = kept_;
                joints_.return_to(velocity_);
                each_contact_row([](const ConstraintRows&, Row& row) { row.impulse = row.estimate; });
            }
            if (!found && trial) {
                joint_friction_softens_ = true;
                set_friction_compliance(tuning::direct_friction_soft * compliance_);
                start();
                continue;
            }
            if (!found) {
                std::fill(correction_.begin(), correction_.end(), 0.0);
                predict_ends(island, false);
            }
            consistent_ = found;
            return found && last < rounding ? Closing::closed : Closing::stuck;
        }
        found = true;
        const auto [change, largest] = next_round();
        std::fill(correction_.begin(), correction_.end(), 0.0);
        predict_ends(island, false);
        const double error = moving ? joints_.close(island, ends_) : 0.0;
        const double contact_error = moving && turns ? close_contacts(island) : 0.0;
        if (!std::isfinite(error) || !std::isfinite(contact_error)) {
            last = infinity;
            return Closing::open;
        }
        const double tolerance = constraints_.empty() ? joint_round_tolerance
                                 : near_rest_         ? tuning::joint_rest_tolerance
                                                      : tuning::direct_round_tolerance;
        const bool settled = settled_ =
            change <= std::max(noise, tolerance * std::max(largest, 1e-6 * total_mass_ * speed_scale_));
        if (settled && (error <= closed || (error < rounding && error >= 0.5 * last))) return Closing::closed;
        if (!constraints_.empty() && (settled || moves_no_body()) && error < joint_contact_settled &&
            contact_error < joint_corner_closed) {
            settled_ = settled;
            return Closing::closed;
        }
        // Friction may change slowly from round to round; the joints are closed all the same.
        if (!constraints_.empty() && round + 1 >= most_rounds && error < joint_contact_closed) return Closing::closed;
        // In a singular position the gap along the vanishing row closes slowly, and by itself when that is passed.
        if (loops_ && round >= joint_singular_rounds && error < tuning::joint_flight_open) return Closing::closed;
        slow = error > open && error >= 0.5 * last ? slow + 1 : 0;
        if (slow == 2 && constraints_.empty() && !stiffened) {
            // A pass leaves R / (R + s^2) of an error, where s^2 is small for heavy bodies on long arms.
            joints_.stiffen(joint_stiffer);
            noise = joints_.rounding(fastest_);
            factored_ = base_kept_ = false;
            stiffened = true;
            slow = 0;
        }
        if (slow >= 3) {
            if (constraints_.empty() || limits_held_) return Closing::open;
            limits_held_ = true;
            slow = 0;
        }
        last = error;
        set_friction_compliance(std::max(friction_compliance_ * tuning::direct_friction_stiffening,
                                         tuning::direct_friction_stiff * compliance_));
    }
    return last < rounding ? Closing::closed : Closing::open;
}

}  // namespace tumble
