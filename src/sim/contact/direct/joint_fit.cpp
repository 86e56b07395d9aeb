// The fit at the end of a step by rows: impulses that make the velocities fit the joints at the new poses. Without it
// they are those along the chords of the step, and their energy is too large by up to (h w)^2 / 4 of it.
#include "core/deterministic_math.h"
#include "sim/contact/direct/direct_solver.h"
#include "sim/dynamics/integrator.h"
#include "sim/joints/gear.h"
#include "sim/joints/settings.h"
#include "sim/math/keyframe_track.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The velocities fit the joints to this share of the fastest one at the end of a step by rows. Not fitted: rounding.
constexpr double joint_fits = 1e-14;

/// Share of its bound up to which a motor or dry friction counts as holding its speed at the end of a step: the bound
/// of friction follows the loads, and the impulse of a slipping joint is not quite at it. Not fitted.
constexpr double joint_fit_below = 0.999;

/// Largest error, in sizes of the joint, that is closed where CCD stops joined bodies within the step. Not fitted:
/// bodies that turn by a radian in a step open their joints by less.
constexpr double joint_clamped_open = 0.1;

/// Rounds of a solve for these displacements. Not fitted: two more passes would do the same.
constexpr int joint_close_rounds = 3;

}  // namespace

// A carrier moves at the end of the step: until then its pose is found from its velocity.
JointSide JointRows::side_at(const JointIsland& island, std::uint32_t body) const {
    JointSide side = side_of(island.problem.bodies, body);
    if (ahead_ == 0.0 || body == Joint::world || island.problem.bodies[body].dynamic()) return side;
    const Body& b = island.problem.bodies[body];
    side.position += ahead_ * b.velocity;
    side.orientation = (from_rotation_vector(ahead_ * b.angular_velocity) * side.orientation).normalized();
    return side;
}

// m/s: before the forces that the fit belongs to.
double JointRows::rate_before(const Block& block, const Row& row) const {
    double rate = row.offset;
    for (const auto& [place, six] : {std::pair(block.a, row.on_a), std::pair(block.b, row.on_b)}) {
        if (place == none) continue;
        const BodyVelocity& before = before_[std::size_t(place)];
        for (int i = 0; i < 3; ++i)
            rate += six[i] * before.velocity[i] + six[3 + i] * length_ * before.angular_velocity[i];
    }
    return rate;
}

void JointRows::start_fit(const JointIsland& island, double ahead, bool solved, bool struck) {
    ahead_ = ahead;
    weights_changed_ = true;
    if (!solved)
        for (Row& row : rows_) row.impulse = 0.0;
    for (Block& block : blocks_) {
        const Joint& j = joint(block);
        JointGeometry g;
        if (block.gear) {
            place_gear(island, block, rows_[block.first]);
        } else {
            g = measure(j, side_at(island, j.a), side_at(island, j.b));
            block.point = g.point;
        }
        const auto at_end = [&](const Row& row) {
            const Eigen::Index axis = row.coordinate - 3;
            const bool alike =
                row.turns() && j.turns_alike() && (row.law == Joint::spring || row.law == Joint::friction);
            const Vec3 direction = row.law == Joint::cone ? g.swing.direction
                                   : alike                ? Vec3(g.axes.col(axis))
                                                          : g.coordinates[row.coordinate].direction;
            return make_row(island, block, direction, row.coordinate);
        };
        double ball = 0.0;  // N s: of the friction of a ball, by its length
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            Row& row = rows_[k];
            if (row.starts_ball) ball = hypotenuse(row.impulse, hypotenuse(rows_[k + 1].impulse, rows_[k + 2].impulse));
            const bool in_ball = j.turns_alike() && row.law == Joint::friction;
            const double size = in_ball ? ball : std::abs(row.impulse);
            // A limit that is met or bounces holds no speed; nor does friction that slips, or a motor at its bound.
            // Along the rim of a cone the swing itself changes.
            const bool rigid = row.law == Joint::lock;
            const Strike* strike = struck && is_limit(row) ? strike_of(block.joint, row) : nullptr;
            const bool limits =
                is_limit(row) && row.law != Joint::cone && row.rests && row.closes && (row.impulse != 0.0 || struck);
            const bool drives = solved && !row.soft && (row.law == Joint::motor || row.law == Joint::friction) &&
                                size < joint_fit_below * row.most;
            if (!block.gear) {
                const Row end = at_end(row);
                std::copy(std::begin(end.on_a), std::end(end.on_a), row.on_a);
                std::copy(std::begin(end.on_b), std::end(end.on_b), row.on_b);
                row.offset = end.offset;
                row.direction = end.direction;
                row.compliance = compliance_;
            }
            row.soft = row.inert = row.inert && !block.breaks;
            if (row.inert) {
                row.compliance = (row.turns() ? length_ * length_ : 1.0) / j.armature(row.coordinate);
                row.least = -infinity;
                row.most = infinity;
            } else if (block.breaks || !(rigid || limits || drives || strike)) {
                row.least = row.most = 0.0;
            } else if (strike) {
                row.least = row.law == Joint::lower ? 0.0 : -infinity;
                row.most = row.law == Joint::lower ? infinity : 0.0;
            } else if (drives) {
                row.most -= size;
                row.least = -row.most;
            } else if (limits) {
                row.least = row.law == Joint::lower ? -row.impulse : -infinity;
                row.most = row.law == Joint::lower ? infinity : -row.impulse;
            }
            if (row.law != Joint::motor) row.target = row.inert ? rate_before(block, row) : 0.0;
            if (strike) row.target = (row.turns() ? length_ : 1.0) * strike->rebound;
            row.estimate = row.impulse = 0.0;
            row.starts_ball = false;
            row.bound = 2;
        }
    }
}

// After start_fit(): the locks ask for the displacements that close them. Returns the largest gap, in sizes of the
// joint.
double JointRows::request_close(const JointIsland& island) {
    double worst = 0.0;
    for (const Block& block : blocks_) {
        const Joint& j = joint(block);
        JointGeometry g;
        double geared = 0.0;
        if (block.gear)
            geared = measure_gear(j, *joints_, [&](std::uint32_t body) { return side_at(island, body); }).error;
        else
            g = measure(j, side_at(island, j.a), side_at(island, j.b));
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            Row& row = rows_[k];
            if (row.inert) row.target = 0.0;
            if (row.law != Joint::lock || block.breaks) continue;
            const double error = block.gear ? geared : g.coordinates[row.coordinate].value;
            row.target = -(row.turns() ? length_ : 1.0) * error;
            worst = std::max(worst, std::abs(error) / (row.turns() ? 1.0 : j.size));
        }
    }
    return worst;
}

double JointRows::misfit() const {
    double most = 0.0;
    for (const Row& row : rows_) {
        const double missing = row.target - row.speed - (row.soft ? row.compliance * row.impulse : 0.0);
        if (row.least < row.most && (row.impulse > row.least || missing > 0.0) &&
            (row.impulse < row.most || missing < 0.0))
            most = std::max(most, std::abs(missing));
    }
    return most;
}

double JointRows::largest_impulse() const {
    double most = 0.0;
    for (const Row& row : rows_) most = std::max(most, std::abs(row.impulse));
    return most;
}

void JointRows::break_under_loads(const JointIsland& island) {
    const double h = island.problem.settings.h;
    for (const Block& block : blocks_) {
        Joint& j = joint(block);
        const JointDescription& strength = j.description;
        if (j.broken || block.gear || !strength.ever_breaks()) continue;
        const double force = j.account.step.reaction.force.norm(), torque = j.account.step.reaction.torque.norm();
        j.broken = std::max({force / (h * strength.break_force), force / strength.break_impulse,
                             torque / (h * strength.break_torque)}) > 1.0;
        if (j.broken) j.broken_at = island.to;
    }
}

// Then the limits that are met give their rebound; motors and friction have no part in that.
void DirectSolver::fit_velocities(const JointIsland& island, JointRows::Booking booking, double ahead,
                                  Fitting fitting) {
    if (fitting != Fitting::rebounds) fit_rows(island, booking, ahead, fitting == Fitting::solved, false);
    if (!joints_.strikes().empty()) fit_rows(island, booking, ahead, false, true);
    joints_.forget_strikes();
}

// At the present poses, `ahead` s after those of the carriers. The contacts are no longer needed. `solved`: the rows
// have the impulses of the solve.
void DirectSolver::fit_rows(const JointIsland& island, JointRows::Booking booking, double ahead, bool solved,
                            bool struck) {
    const ContactProblem& problem = island.problem;
    constraints_.clear();
    read_bodies(problem, island.bodies);
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        const Body& body = problem.bodies[island.bodies[k]];
        contact_rows::put(&free_[6 * k], body.velocity, length_ * body.angular_velocity);
    }
    // The fit belongs to the forces at the end of a part.
    if (!kicked_) joints_.keep_velocities(island, false);
    kicked_ = false;
    // At rest all speeds are rounding: the speeds that the impulses add and remove count.
    const double fits = joint_fits * std::max(fastest_, joints_.largest_impulse() / lightest_);
    joints_.start_fit(island, ahead, solved, struck);
    joint_friction_softens_ = near_rest_ = factored_ = base_kept_ = false;
    velocity_ = free_;
    joints_.evaluate_speeds(velocity_);
    double last = speed_scale_ = joints_.misfit();
    if (!(last > fits)) return;
    int slow = 0;
    for (int pass = 0; pass < tuning::joint_rounds && last > fits; ++pass) {
        if (!step_linear() && !minimize(tuning::joint_first_newton_steps)) return;
        joints_.next_round(false);
        joints_.evaluate_speeds(velocity_);
        const double error = joints_.misfit();
        if (!std::isfinite(error)) return;
        // A limit or a drive that comes to its bound costs a pass.
        slow = error >= 0.5 * last ? slow + 1 : 0;
        last = error;
        if (slow >= 3) break;
    }
    joints_.give(island);
    for (const std::uint32_t i : island.bodies) problem.bodies[i].derive_velocities();
    joints_.account(island, booking);
    joints_.break_under_loads(island);
}

// Displacements are velocities over a second here. Limits, motors and friction take no part.
double DirectSolver::aim_at_gaps(const JointIsland& island) {
    read_bodies(island.problem, island.bodies);
    std::fill(free_.begin(), free_.end(), 0.0);
    joints_.start_fit(island, island.problem.settings.h, false, false);
    joint_friction_softens_ = near_rest_ = factored_ = base_kept_ = false;
    const double widest = joints_.request_close(island);
    velocity_ = free_;
    joints_.evaluate_speeds(velocity_);
    return widest;
}

void DirectSolver::close_poses(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                               std::span<const std::uint32_t> joints) {
    constraints_.clear();
    read_bodies(problem, bodies);
    const JointIsland island{problem, bodies, joints, length_, problem.joints->from(), problem.joints->to()};
    joints_.start_step(problem.settings.h, false);
    linearize_joints(island, {});
    joints_.keep_estimates();  // the impulses of the step
    double last = infinity;
    for (int pass = 0; pass < tuning::joint_rounds; ++pass) {
        const double error = aim_at_gaps(island);
        if (!(error < joint_clamped_open) || error <= tuning::joint_closed || error >= 0.5 * last) break;
        last = error;
        for (int round = 0; round < joint_close_rounds && step_linear(); ++round) joints_.next_round(false);
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            Body& body = problem.bodies[bodies[k]];
            turn_exactly(body, contact_rows::three(velocity_, 6 * k),
                         contact_rows::three(velocity_, 6 * k + 3) / length_, 1.0);
            body.derive();
        }
    }
    linearize_joints(island, {});
    joints_.keep_estimates();
    consistent_ = true;
    kicked_ = false;
    fit_velocities(island, JointRows::Booking::stop, problem.settings.h, Fitting::solved);
}

}  // namespace tumble
