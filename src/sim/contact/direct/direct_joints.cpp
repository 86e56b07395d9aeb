// DirectSolver: islands with joints, in one or more substeps.
//
// A joint's force keeps its direction through a step. A link under tension T swings about its joints at the rate
// sqrt(4 T / (m l)); where a step is longer than that allows, or the passes that close the joints do not converge, the
// island is solved in substeps.
#include "sim/contact/direct/direct_solver.h"
#include "sim/contact/direct/settings.h"
#include "sim/dynamics/integrator.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/joints/joint_way.h"
#include "sim/joints/settings.h"
#include "sim/joints/spanning_joints.h"
#include "sim/math/keyframe_track.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

/// Largest factor of the estimates of impulses from a part of a step to a longer one. Not fitted: the forces of a very
/// short part are rounding.
constexpr double direct_longer = 16.0;

/// Compliance of rigid rows, over the island's mass and its number of joints. A round makes the error of a chain about
/// a thousand times smaller, at any length, because the softest motion of n links has a compliance of pi^2 / n over
/// their mass. Smaller values add rounding to the impulses.
constexpr double joint_compliance = 1e-2;

}  // namespace

using namespace contact_rows;

// The rows of the joints at the present poses, and the matrix in which they have their blocks.
void DirectSolver::linearize_joints(const JointIsland& island, std::span<const std::uint32_t> manifolds) {
    joints_.linearize(island, joint_compliance / (total_mass_ * double(island.joints.size())));
    structure(island.problem, island.bodies, manifolds);
    factored_ = base_kept_ = false;
}

// The state at the start of a part of the step: forces in equal parts, rows and contacts at the present poses.
void DirectSolver::load_part(const JointIsland& island, std::span<const std::uint32_t> manifolds, bool first) {
    const ContactProblem& problem = island.problem;
    const double d = problem.settings.h, share = force_share(island);
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        Body& body = problem.bodies[island.bodies[k]];
        if (in_parts_) {
            body.momentum += share * starts_[k].impulse;
            body.angular_momentum += share * starts_[k].angular_impulse;
            body.derive();
            find_gyration(body, d);
            masses_[k].inertia = body.rotation * body.inertia_body * body.rotation.transpose() / (length_ * length_);
            masses_[k].inverse_inertia = body.inverse_inertia * (length_ * length_);
        }
        put(&free_[6 * k], body.velocity, length_ * (body.angular_velocity + body.gyration));
        fastest_ = std::max({fastest_, body.velocity.norm(), length_ * body.angular_velocity.norm()});
    }
    linearize_joints(island, manifolds);
    if (!joints_.estimated()) each_contact_row([](const ConstraintRows&, Row& row) { row.estimate = 0.0; });
    speed_scale_ = std::max(speed_scale_, joints_.demand(free_));
    if (!in_parts_) return;
    const double longer = std::min(d / estimated_for_, direct_longer);
    estimated_for_ = d;
    each_contact_row([&](const ConstraintRows&, Row& row) { row.estimate *= longer; });
    for (ConstraintRows& constraint : constraints_) {
        if (!first) move_contact(constraint, problem);
        for (int i = 0; i < constraint.count; ++i) {
            Row& row = constraint.normal[i];
            row.target = std::min(0.0, constraint.overlap[i] / d);
            if (!first) constraint.rebound[i] = 0.0;
            if (constraint.rebound[i] > 0.0) row.target = constraint.rebound[i];
        }
    }
}

// Rows of a contact at the present positions: it acts at the same point of the body, halfway between two moving ones.
void DirectSolver::move_contact(ConstraintRows& constraint, const ContactProblem& problem) {
    const Manifold& m = problem.manifolds[constraint.manifold];
    const Body &a = problem.bodies[m.a], &b = problem.bodies[m.b];
    const double share = constraint.a == none ? 1.0 : constraint.b == none ? 0.0 : 0.5;  // of B
    const auto move = [&](Vec3& arm_a, Vec3& arm_b) {
        const Vec3 apart = (b.position + arm_b) - (a.position + arm_a);
        arm_a += share * apart;
        arm_b = a.position + arm_a - b.position;
    };
    const RowBodies bodies{constraint, a, b, length_};
    const auto rewrite = [&](Row& row, const Vec3& direction, const Vec3& arm_a, const Vec3& arm_b) {
        const double offset = row.offset;
        set_row(row, direction, arm_a, arm_b, bodies);
        row.offset = offset;
    };
    ContactConstraint& geometry = constraint.geometry;
    for (int i = 0; i < constraint.count; ++i) {
        ContactConstraint::Point& p = geometry.points[std::size_t(i)];
        move(p.arm_a, p.arm_b);
        rewrite(constraint.normal[i], geometry.normal, p.arm_a, p.arm_b);
    }
    move(geometry.friction_arm_a, geometry.friction_arm_b);
    if (!constraint.rubs) return;
    rewrite(constraint.friction[0], geometry.tangent_1, geometry.friction_arm_a, geometry.friction_arm_b);
    rewrite(constraint.friction[1], geometry.tangent_2, geometry.friction_arm_a, geometry.friction_arm_b);
}

// True if the rows are fulfilled without impulses: at the present velocities, and at the end of the step.
bool DirectSolver::moves_freely(const JointIsland& island) {
    if (speed_scale_ > tuning::direct_rounding * fastest_) return false;
    velocity_ = free_;
    consistent_ = settled_ = true;
    joints_.evaluate_speeds(velocity_);
    predict_ends(island, false);
    if (joints_.close(island, ends_) <= std::max(tuning::joint_closed, joints_.rounding(island, fastest_, lightest_)))
        return true;
    speed_scale_ = std::max(speed_scale_, joints_.demand(free_));
    return false;
}

// Gives the solution to the bodies: the impulses, equal and opposite. Where Newton's steps stopped on the way they do
// not fit the velocities, which are nearer to the solution.
void DirectSolver::apply_solution(const JointIsland& island) {
    std::vector<Body>& bodies = island.problem.bodies;
    if (consistent_) {
        std::vector<bool> reached(island.bodies.size(), true);
        apply_contacts(island.problem, reached);
    }
    joints_.store(island, consistent_, estimates());
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        Body& body = bodies[island.bodies[k]];
        if (!consistent_) {
            body.momentum = body.mass * three(velocity_, 6 * k);
            body.angular_momentum =
                length_ * length_ * (masses_[k].inertia * (three(velocity_, 6 * k + 3) / length_ - body.gyration));
        }
        body.derive_velocities();
    }
    if (consistent_) return;
    each_contact_row([](const ConstraintRows&, Row& row) { row.impulse = 0.0; });
}

// Moves the bodies to the end of a substep.
void DirectSolver::move(const JointIsland& island) {
    const double d = island.problem.settings.h;
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        Body& body = island.problem.bodies[island.bodies[k]];
        turn_exactly(body, body.velocity, body.angular_velocity + gyration(body, d), d);
        body.derive();
    }
    for (ConstraintRows& constraint : constraints_)
        for (int i = 0; i < constraint.count; ++i) {
            const Row& row = constraint.normal[i];
            constraint.overlap[i] -= d * (row.offset + dot(constraint, row, velocity_));
        }
}

// Moves the bodies to the end of the step, with the correction. `moved`: they are there but for the correction.
void DirectSolver::move_to_end(const JointIsland& island, bool moved) {
    const double h = island.problem.settings.h;
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        Body& body = island.problem.bodies[island.bodies[k]];
        const Vec3 correction = three(correction_, 6 * k),
                   correction_rotation = three(correction_, 6 * k + 3) / length_;
        if (moved)
            turn_exactly(body, correction, correction_rotation, h);
        else
            turn_exactly(body, body.velocity + correction,
                         body.angular_velocity + gyration(body, h) + correction_rotation, h);
        body.derive();
    }
}

// Share of the step's forces that acts at the start of a part. Without contacts as much acts at its end, as in flight.
double DirectSolver::force_share(const JointIsland& part) const {
    const double share = part.problem.settings.h / (part.problem.joints->to() - part.problem.joints->from());
    return kicks() ? 0.5 * share : share;
}

// Changes momenta and, in several parts, poses. Returns false where substeps are too long, and where a limit is met.
bool DirectSolver::solve_jointed_step(const JointIsland& island, std::span<const std::uint32_t> manifolds,
                                      int substeps) {
    const ContactProblem& step = island.problem;
    const double h = step.settings.h, d = h / substeps;
    read_bodies(step, island.bodies);
    linearize_constraints(step, island.bodies, manifolds);
    driven_ = true;
    factored_ = false;
    compliance_ = tuning::direct_compliance / total_mass_;
    in_parts_ = substeps > 1 || cut_;
    kicked_ = false;
    estimated_for_ = h;
    // Contacts tremble: there a rebound has to last as long as that of a contact.
    const double hop = constraints_.empty() ? 0.0 : step.settings.rebound_share;
    joints_.start_step(h, true, std::max(hop, 0.5 * tuning::limit_hop));
    for (const std::uint32_t k : island.joints) step.joints->joints()[step.joints->active()[k]].account.step = {};
    if (in_parts_)
        for (std::size_t k = 0; k < island.bodies.size(); ++k) {
            Body& body = step.bodies[island.bodies[k]];
            body.momentum -= starts_[k].impulse;
            body.angular_momentum -= starts_[k].angular_impulse;
            if (cut_) body.derive_velocities();
        }
    std::vector<double> sums;
    const double scale_of_step = speed_scale_;
    phase_ = 0.0;
    int cuts = 0;
    bool first = true;
    for (int substep = 0; substep < substeps; ++substep)
        for (double done = 0.0; done < d;) {
            const double from = island.from + substep * d + done;
            speed_scale_ = scale_of_step;
            ConstraintSettings settings = step.settings;
            settings.h = d - done;
            const ContactProblem problem{step.bodies, step.manifolds, step.before, settings, step.totals, step.joints};
            const JointIsland rest{problem, island.bodies, island.joints, length_, from, from + settings.h};
            if (!solve_part(rest, manifolds, substeps, first)) return false;
            if (joints_.find_strikes(rest, ends_, kicks())) {
                if (!cut_) {
                    cut_ = true;
                    return false;
                }
                settings.h = joints_.strikes().front().time;
                if (++cuts >= tuning::limit_cuts) joints_.stop_bounces();
                if (settings.h < d - done) give_back_part(rest);
                if (settings.h <= tuning::limit_together * h) {
                    strike(rest, from - island.from, Fitting::rebounds);
                    continue;
                }
            }
            const double length = settings.h;
            const ContactProblem problem_of_part{step.bodies, step.manifolds, step.before,
                                                 settings,    step.totals,    step.joints};
            const JointIsland part{problem_of_part, island.bodies, island.joints, length_, from, from + length};
            if (length < d - done && !solve_part(part, manifolds, substeps, first)) return false;
            apply_solution(part);
            joints_.account(part);
            if (!in_parts_) return true;
            move(part);
            std::size_t next = 0;
            each_contact_row([&](const ConstraintRows&, Row& row) {
                if (first) sums.push_back(0.0);
                sums[next++] += row.impulse;
                row.estimate = row.impulse;
            });
            first = false;
            done = length < d - done ? done + length : d;
            if (kicks()) kick(part);
            if (cut_ && !(substep + 1 == substeps && done == d))
                strike(part, part.to - island.from, consistent_ ? Fitting::solved : Fitting::unsolved);
        }
    std::size_t next = 0;
    each_contact_row([&](const ConstraintRows&, Row& row) { row.impulse = sums[next++]; });
    return true;
}

// Finds velocities and impulses of a part of the step. Returns false where substeps are too long.
bool DirectSolver::solve_part(const JointIsland& part, std::span<const std::uint32_t> manifolds, int substeps,
                              bool first) {
    joints_.keep_velocities(part, first && !cut_);
    part_starts_.clear();
    for (const std::uint32_t i : part.bodies)
        part_starts_.push_back({part.problem.bodies[i].momentum, part.problem.bodies[i].angular_momentum});
    load_part(part, manifolds, first);
    if (moves_freely(part)) return true;
    do {
        base_kept_ = false;  // joints that gave way are bounded
        const Closing closing = close_joints(part, true);
        // Shorter steps help the joints, seldom the contacts.
        const bool alone = closing == Closing::open && constraints_.empty() && !loops_;
        const int most = alone ? tuning::joint_open_substeps : tuning::joint_stuck_substeps;
        if (closing != Closing::closed && substeps < most) return false;
        if (closing != Closing::closed && !(gap_left_ < tuning::joint_flight_open)) fit_start(part);
    } while (joints_.give_way());
    if (estimates()) phase_ = std::max(phase_, joints_.pendulum_rate(part) * part.problem.settings.h);
    return !(phase_ > tuning::joint_phase && substeps < tuning::joint_phase_substeps);
}

// The state before solve_part().
void DirectSolver::give_back_part(const JointIsland& part) {
    for (std::size_t k = 0; k < part.bodies.size(); ++k) {
        Body& body = part.problem.bodies[part.bodies[k]];
        body.momentum = part_starts_[k].linear;
        body.angular_momentum = part_starts_[k].angular;
        body.derive_velocities();
    }
}

// The forces at the end of a part.
void DirectSolver::kick(const JointIsland& part) {
    const double share = force_share(part);
    joints_.keep_velocities(part, false);
    kicked_ = true;
    for (std::size_t k = 0; k < part.bodies.size(); ++k) {
        Body& body = part.problem.bodies[part.bodies[k]];
        body.momentum += share * starts_[k].impulse;
        body.angular_momentum += share * starts_[k].angular_impulse;
        body.derive_velocities();
    }
}

// Between two parts: the velocities fit the joints, and limits that are met give their rebound. Contacts take no part:
// where they are pressed, the next part stops them.
void DirectSolver::strike(const JointIsland& part, double ahead, Fitting fitting) {
    std::vector<ConstraintRows> contacts;
    std::vector<ResistanceRows> resistances;
    contacts.swap(constraints_);
    resistances.swap(resistances_);
    const double scale = speed_scale_;
    fit_velocities(part, JointRows::Booking::fit, ahead, fitting);
    speed_scale_ = scale;
    constraints_.swap(contacts);
    resistances_.swap(resistances);
}

// Substeps of the next step, by those of this one.
int DirectSolver::next_substeps(int substeps) const {
    return phase_ < tuning::joint_easy_phase ? std::max(1, substeps / 2) : substeps;
}

namespace {

// Joints with the laws of flight that are no tree.
bool has_loops(const JointIsland& island) {
    const JointSet& set = *island.problem.joints;
    std::vector<const Joint*> joints;
    for (const std::uint32_t k : island.joints) joints.push_back(&set.joints()[set.active()[k]]);
    SpanningJoints tree;
    return tree_laws(joints, island.problem.bodies) &&
           !(span_joints(island.bodies, joints, set.joints(), tree) && tree.cut.empty());
}

}  // namespace

bool DirectSolver::solve_with_joints(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                                     std::span<const std::uint32_t> manifolds, std::span<const std::uint32_t> joints) {
    const double h = problem.settings.h;
    const JointIsland island{problem, bodies, joints, length_, problem.joints->from(), problem.joints->to()};
    starts_.resize(bodies.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        const Body& body = problem.bodies[bodies[k]];
        const BodyVelocity& before = problem.before[bodies[k]];
        starts_[k] = {body.position,
                      body.momentum,
                      body.angular_momentum,
                      body.orientation,
                      body.rotation,
                      body.mass * (body.velocity - before.velocity),
                      length_ * length_ * (masses_[k].inertia * (body.angular_velocity - before.angular_velocity))};
    }
    std::vector<Joint*> island_joints;
    std::vector<std::array<double, Joint::coordinates>> values;
    int substeps = 1;
    for (const std::uint32_t k : joints) {
        Joint& joint = problem.joints->joints()[problem.joints->active()[k]];
        if (joint.broken) continue;  // in an impact of this step
        island_joints.push_back(&joint);
        values.push_back(joint.value);
        substeps = std::max(substeps, joint.substeps);
    }
    const auto reset = [&] {
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            Body& body = problem.bodies[bodies[k]];
            const Start& start = starts_[k];
            body.position = start.position;
            body.orientation = start.orientation;
            body.rotation = start.rotation;
            body.momentum = start.momentum;
            body.angular_momentum = start.angular_momentum;
            body.derive();
            find_gyration(body, h);
        }
        for (std::size_t k = 0; k < island_joints.size(); ++k) {
            island_joints[k]->value = values[k];
            island_joints[k]->impulse = {};
            island_joints[k]->force.setZero();
            island_joints[k]->torque.setZero();
            island_joints[k]->broken = false;
        }
        if (problem.totals)
            for (const std::uint32_t k : manifolds) (*problem.totals)[k] = {};
    };
    // Steps that fine integrators leave to the rows, as that of a joint that breaks at once, are exact for even forces
    // too. So are those of loops: with half of the forces at both ends and fitted velocities they are RATTLE's.
    loops_ = manifolds.empty() && has_loops(island);
    cut_ = loops_ || (manifolds.empty() && fine_integrator(joined_integrator(problem.bodies, bodies)));
    for (bool cut = cut_; !solve_jointed_step(island, manifolds, substeps); cut = cut_) {
        if (cut == cut_) substeps *= 2;
        reset();
    }
    for (Joint* joint : island_joints) joint->substeps = next_substeps(substeps);
    correct_joined(island, in_parts_);
    store_contacts(problem);
    move_to_end(island, in_parts_);
    fit_velocities(island, JointRows::Booking::fit, h, consistent_ ? Fitting::solved : Fitting::unsolved);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        Body& body = problem.bodies[bodies[k]];
        // Back to the start: the step's velocities move the body to its end.
        const Vec3 moved = body.position - starts_[k].position;
        const Vec3 turned = rotation_vector(body.orientation * starts_[k].orientation.conjugate());
        body.position = starts_[k].position;
        body.orientation = starts_[k].orientation;
        body.rotation = starts_[k].rotation;
        body.derive();
        find_gyration(body, h);
        body.correction_velocity = moved / h - body.velocity;
        body.correction_angular_velocity = turned / h - body.angular_velocity - body.gyration;
    }
    return std::all_of(bodies.begin(), bodies.end(), [&](std::uint32_t i) {
        return problem.bodies[i].momentum.allFinite() && problem.bodies[i].angular_momentum.allFinite();
    });
}

}  // namespace tumble
