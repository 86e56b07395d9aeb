// DirectSolver: the augmented Lagrangian's rounds, and Newton's method with line search within a round.
#include "sim/contact/direct/direct_solver.h"
#include "sim/contact/direct/settings.h"
#include "sim/contact/model/settings.h"
#include "sim/contact/model/spin_friction.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace tumble {

using namespace contact_rows;

namespace {

/// Convergence of the Newton steps, relative to the change of velocity in the step. Not fitted: a bound of the
/// error, which double precision allows.
constexpr double direct_tolerance = 1e-9;

/// Newton steps of the first round. After a landing, each contact of a stack of 30 may change its state. Not
/// fitted: a bound of the cost.
constexpr int direct_first_newton_steps = 40;

/// A contact this close to opening or closing (share of the speed scale) counts as closed in the second
/// derivatives. Not fitted: rounding.
constexpr double direct_tie = 1e-10;

/// Residual of Newton's steps, as a share of the fastest speed, that may be rounding: the stiffness of rigid rows times
/// the rounding of speeds. Not fitted: rounding.
constexpr double joint_stall = 1e-9;

double length(double x, double y) { return std::sqrt(x * x + y * y); }

void add_outer(BlockCholesky::Block& block, const double* left, const BlockCholesky::Row& right) {
    for (int k = 0; k < 6; ++k) block.row[k] += left[k] * right;
}

}  // namespace

// Sets friction limits from the normal impulses of the last round.
void DirectSolver::set_limits(ConstraintRows& constraint) {
    if (!constraint.rubs) return;
    double load = 0.0, levers = 0.0, coefficient = constraint.coefficient;
    if (constraint.area) {
        std::tie(load, levers) = shared_load(constraint, &Row::estimate);
        coefficient = 1.0;
    } else {
        Vec3 aside = Vec3::Zero();
        for (int i = 0; i < constraint.count; ++i) {
            const double impulse = constraint.normal[i].estimate;
            load += impulse;
            levers += impulse * constraint.lever[i];
            aside += impulse * (constraint.geometry.points[std::size_t(i)].arm_a - constraint.geometry.friction_arm_a);
        }
        levers += (1.0 - constraint.geometry.spread) * aside.norm();
    }
    constraint.limit = coefficient * load;
    constraint.torsion_limit = coefficient * levers;
    constraint.spins = constraint.torsion_limit > 0.0 &&
                       constraint.torsion_mass * constraint.free_spin > constraint.torsion_limit &&
                       levers * constraint.free_spin > tuning::spin_share * load * constraint.free_slip;
    if (!constraint.spins) return;
    const double distance = levers / load, spin = distance * constraint.free_spin;
    const spin_friction::Limit shared = spin_friction::limit(constraint.free_slip * constraint.free_slip, spin * spin);
    constraint.limit *= shared.load;
    constraint.spin_lever = distance * shared.lever;
}

void DirectSolver::evaluate_speeds() {
    each_contact_row(
        [&](const ConstraintRows& constraint, Row& row) { row.speed = row.offset + dot(constraint, row, velocity_); });
    joints_.evaluate_speeds(velocity_);
}

// Impulses for velocities at a fraction of the Newton step, and the weights of the rows in the second derivatives.
void DirectSolver::evaluate(ConstraintRows& constraint, double along, Weights* weights) const {
    const double tie = ties_ ? -direct_tie * speed_scale_ / compliance_ : 0.0;
    for (int i = 0; i < constraint.count; ++i) {
        Row& row = constraint.normal[i];
        const double y = row.estimate + (row.target - row.speed - along * row.change) / compliance_;
        row.impulse = std::max(0.0, y);
        if (weights) weights->normal[i] = y > tie ? 1.0 / compliance_ : 0.0;  // an untouched stack has only ties
    }
    if (!constraint.rubs) return;
    // Both friction directions and, where they share the limit, the torsional friction over its lever: a ball
    // (spin_friction.h).
    Row* const rows[3] = {&constraint.friction[0], &constraint.friction[1], &constraint.torsion};
    const double levers[3] = {1.0, 1.0, constraint.spin_lever};
    const int count = constraint.spins ? 3 : 2;
    double y[3] = {}, square = 0.0;
    for (int i = 0; i < count; ++i) {
        const Row& row = *rows[i];
        y[i] = row.estimate / levers[i] - levers[i] * (row.speed + along * row.change) / friction_compliance_;
        square += y[i] * y[i];
    }
    const double size = std::sqrt(square);
    const bool slides = size > constraint.limit;
    const double scale = slides ? constraint.limit / size : 1.0;
    for (int i = 0; i < count; ++i) {
        rows[i]->impulse = levers[i] * scale * y[i];
        for (int k = 0; weights && k < count; ++k) {
            const double along_it = slides ? y[i] * y[k] / square : 0.0;
            weights->friction[i][k] = levers[i] * levers[k] * scale / friction_compliance_ * ((i == k) - along_it);
        }
    }
    if (constraint.count < 2 || constraint.spins) return;
    const double turning =
        constraint.torsion.estimate -
        (constraint.torsion.speed + along * constraint.torsion.change) * length_ * length_ / friction_compliance_;
    constraint.torsion.impulse = std::clamp(turning, -constraint.torsion_limit, constraint.torsion_limit);
    if (weights)
        weights->friction[2][2] =
            std::abs(turning) <= constraint.torsion_limit ? length_ * length_ / friction_compliance_ : 0.0;
}

// M (u - u*) - J^T f; returns its size as an energy: sum g^2 / m.
double DirectSolver::gradient(std::vector<double>& g) {
    for (std::size_t k = 0; k < velocity_.size(); ++k) scratch_[k] = velocity_[k] - free_[k];
    mass_times(scratch_, g);
    for (ConstraintRows& constraint : constraints_) evaluate(constraint, 0.0, nullptr);
    evaluate_resistance(0.0, false);
    each_contact_row([&](const ConstraintRows& constraint, Row& row) {
        if (row.impulse != 0.0) add(constraint, row, -row.impulse, g);
    });
    joints_.evaluate(0.0);
    joints_.add_impulses(-1.0, g);
    double sum = 0.0;
    for (std::size_t i = 0; i < masses_.size(); ++i) {
        double square = 0.0;
        for (std::size_t k = 0; k < 6; ++k) square += g[6 * i + k] * g[6 * i + k];
        sum += square / masses_[i].mass;
    }
    return sum;
}

// Weights of a constraint in the position correction.
DirectSolver::Weights DirectSolver::correction_weights(const ConstraintRows& constraint) const {
    Weights w;
    const double stiffness = total_mass_ / tuning::direct_correction_compliance;
    const auto presses = [](const ConstraintRows& c, int i) {
        return c.normal[i].impulse > 0.0 || c.overlap[i] > tuning::direct_slop * c.size;
    };
    bool active = false;
    for (int i = 0; i < constraint.count; ++i) {
        const bool on = presses(constraint, i);
        active = active || on;
        w.normal[i] = on ? stiffness : 0.0;
    }
    if (!constraint.rubs) return w;
    for (int k = constraint.next; k != none; k = constraints_[std::size_t(k)].next)
        for (int i = 0; i < constraints_[std::size_t(k)].count; ++i)
            active = active || presses(constraints_[std::size_t(k)], i);
    // Pushed apart, not sideways.
    const double aside = active ? tuning::direct_correction_across * stiffness : 0.0;
    w.friction[0][0] = w.friction[1][1] = aside;
    w.friction[2][2] = constraint.count > 1 ? aside * length_ * length_ : 0.0;
    return w;
}

// The matrix of the masses. Joined bodies are pushed as if all had the same mass: otherwise the links between heavy
// bodies would be thrown.
void DirectSolver::set_masses(bool correcting) {
    matrix_.set_zero();
    for (std::size_t i = 0; i < masses_.size(); ++i) {
        BlockCholesky::Block& block = matrix_.diagonal(i);
        const double share =
            correcting && !joints_.empty() ? total_mass_ / (double(masses_.size()) * masses_[i].mass) : 1.0;
        for (int r = 0; r < 3; ++r) {
            block.row[r][r] = share * masses_[i].mass;
            for (int c = 0; c < 3; ++c) block.row[3 + r][3 + c] = share * masses_[i].inertia(r, c);
        }
    }
}

bool DirectSolver::factor(bool correcting) {
    weights_.clear();
    for (ConstraintRows& constraint : constraints_) {
        weights_.push_back(correcting ? correction_weights(constraint) : Weights{});
        if (!correcting) evaluate(constraint, 0.0, &weights_.back());
    }
    if (!correcting) evaluate_resistance(0.0, true);
    return factor_weights(correcting);
}

// Factors the matrix of weights_ and the weights of the joints' rows.
bool DirectSolver::factor_weights(bool correcting) {
    ++factorizations_;
    // Beside contacts a step has many factorizations, in which the rows of locked coordinates stay the same.
    const bool kept = !correcting && !joints_.empty() && !constraints_.empty();
    if (kept && base_kept_) {
        matrix_.restore(base_);
    } else {
        set_masses(correcting);
        if (kept) {
            joints_.add_weights(matrix_, JointRows::Which::unbounded);
            matrix_.save(base_);
            base_kept_ = true;
        }
    }
    std::size_t pair = 0;
    for (std::size_t k = 0; k < constraints_.size(); ++k) {
        const ConstraintRows& constraint = constraints_[k];
        const Weights& w = weights_[k];
        const bool both = constraint.a != none && constraint.b != none;
        BlockCholesky::Block* across = nullptr;
        bool transposed = false;
        if (both) {
            while (!(pairs_[pair].i == std::uint32_t(constraint.a) && pairs_[pair].j == std::uint32_t(constraint.b)))
                ++pair;
            across = &matrix_.coupling(pair);
            transposed = matrix_.transposed(pair);
        }
        const auto add_row = [&](const Row& left, const Row& right, double weight) {
            if (weight == 0.0) return;
            const BlockCholesky::Row ra =
                weight * BlockCholesky::Row{right.on_a[0], right.on_a[1], right.on_a[2], right.on_a[3],
                                            right.on_a[4], right.on_a[5], 0.0,           0.0};
            const BlockCholesky::Row rb =
                weight * BlockCholesky::Row{right.on_b[0], right.on_b[1], right.on_b[2], right.on_b[3],
                                            right.on_b[4], right.on_b[5], 0.0,           0.0};
            if (constraint.a != none) add_outer(matrix_.diagonal(std::size_t(constraint.a)), left.on_a, ra);
            if (constraint.b != none) add_outer(matrix_.diagonal(std::size_t(constraint.b)), left.on_b, rb);
            if (!both) return;
            if (transposed)
                add_outer(*across, left.on_b, ra);
            else
                add_outer(*across, left.on_a, rb);
        };
        for (int i = 0; i < constraint.count; ++i) add_row(constraint.normal[i], constraint.normal[i], w.normal[i]);
        const Row* const friction[3] = {&constraint.friction[0], &constraint.friction[1], &constraint.torsion};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) add_row(*friction[i], *friction[j], w.friction[i][j]);
        if (constraint.resistance == none || correcting) continue;  // pushes may roll
        const ResistanceRows& resistance = resistances_[std::size_t(constraint.resistance)];
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) add_row(resistance.row(i), resistance.row(j), resistance.weights[i][j]);
    }
    joints_.add_weights(matrix_, kept ? JointRows::Which::bounded : JointRows::Which::all);
    return matrix_.factor();
}

// Slope of the minimized function along the step.
double DirectSolver::slope(double along, double mass_slope, double mass_curvature) {
    double sum = mass_slope + along * mass_curvature;
    for (ConstraintRows& constraint : constraints_) evaluate(constraint, along, nullptr);
    evaluate_resistance(along, false);
    each_contact_row([&](const ConstraintRows&, Row& row) { sum -= row.impulse * row.change; });
    if (joints_.empty()) return sum;
    joints_.evaluate(along);
    return sum - joints_.slope();
}

// Finds where the slope is a tenth of its initial value: regula falsi with the Illinois rule, kept off the ends.
double DirectSolver::line_search(double slope_0, double mass_slope, double mass_curvature) {
    const double enough = 0.1 * std::abs(slope_0);
    double high = 1.0, slope_high = slope(1.0, mass_slope, mass_curvature);
    if (slope_high <= enough) return 1.0;
    double low = 0.0, slope_low = slope_0, x = 1.0;
    for (int k = 0; k < tuning::direct_line_search; ++k) {
        x = std::clamp((low * slope_high - high * slope_low) / (slope_high - slope_low), low + 0.02 * (high - low),
                       high - 0.02 * (high - low));
        const double s = slope(x, mass_slope, mass_curvature);
        if (std::abs(s) < enough) break;
        if (s < 0.0) {
            low = x;
            slope_low = s;
            slope_high *= 0.5;
        } else {
            high = x;
            slope_high = s;
            slope_low *= 0.5;
        }
    }
    return x;
}

// `steps_without_ties`: that follow where most_steps are not enough. A tie whose contact opens makes the steps creep.
bool DirectSolver::minimize(int most_steps, int steps_without_ties) {
    const double energy = total_mass_ * speed_scale_ * speed_scale_;
    const double speed = std::max(direct_tolerance * speed_scale_, tuning::direct_rounding * fastest_);
    // Under a heavy load the links' velocities count, which are a small part of the energy.
    // With contacts too, the next round is as near as that.
    const bool loosely = !joints_.empty() && !constraints_.empty() && !near_rest_;
    const double loose = loosely ? tuning::joint_contact_tolerance : 1.0;
    const double tolerance = (joints_.empty() ? total_mass_ : lightest_) * (loose * speed) * (loose * speed);
    const double stalled = joint_stall * fastest_, rounding = total_mass_ * stalled * stalled;
    double last = infinity;
    ties_ = true;
    for (int k = 0; k <= most_steps + steps_without_ties; ++k) {
        if (k == 0 || joints_.empty()) evaluate_speeds();
        const double now = gradient(gradient_);
        if (now <= tolerance) return true;
        // Joints are stiffer than contacts: where a full step no longer helps, the rest is rounding.
        if (!joints_.empty() && k > 0 && now > 0.1 * last && now <= rounding) return true;
        last = now;
        if (k == most_steps) ties_ = false;
        if (k == most_steps + steps_without_ties || !factored()) return false;
        for (std::size_t i = 0; i < step_.size(); ++i) step_[i] = -gradient_[i];
        matrix_.solve(step_);
        double slope_0 = 0.0, mass_slope = 0.0, mass_curvature = 0.0;
        mass_times(step_, correction_);
        for (std::size_t i = 0; i < step_.size(); ++i) {
            slope_0 += gradient_[i] * step_[i];
            mass_slope += correction_[i] * (velocity_[i] - free_[i]);
            mass_curvature += correction_[i] * step_[i];
        }
        each_contact_row([&](const ConstraintRows& constraint, Row& row) { row.change = dot(constraint, row, step_); });
        joints_.evaluate_changes(step_);
        const double along = line_search(slope_0, mass_slope, mass_curvature);
        for (std::size_t i = 0; i < step_.size(); ++i) velocity_[i] += along * step_[i];
        each_contact_row([&](const ConstraintRows&, Row& row) {
            row.speed += along * row.change;
            row.change = 0.0;
        });
        joints_.advance_speeds(along);
        if (-slope_0 < 1e-30 * energy) return true;  // the remainder is rounding
    }
    return false;
}

// The minimized function, for choosing the start.
double DirectSolver::objective(const std::vector<double>& u) {
    for (std::size_t k = 0; k < u.size(); ++k) scratch_[k] = u[k] - free_[k];
    double sum = kinetic_energy(scratch_);
    for (ConstraintRows& constraint : constraints_) {
        for (int i = 0; i < constraint.count; ++i) {
            const Row& row = constraint.normal[i];
            const double y = row.estimate + (row.target - row.offset - dot(constraint, row, u)) / compliance_;
            if (y > 0.0) sum += 0.5 * compliance_ * y * y;
        }
        // Friction matters for the choice only where it is small compared with the normal terms.
    }
    return joints_.empty() ? sum : sum + joints_.objective(u);
}

// Starts from the last step's impulses where they are better than none.
void DirectSolver::start() {
    std::fill(gradient_.begin(), gradient_.end(), 0.0);
    for (ConstraintRows& constraint : constraints_) set_limits(constraint);
    set_resistance_limits();
    each_contact_row([&](const ConstraintRows& constraint, Row& row) {
        if (row.estimate != 0.0) add(constraint, row, row.estimate, gradient_);
    });
    joints_.add_estimates(gradient_);
    for (std::size_t i = 0; i < masses_.size(); ++i) {
        const Vec3 linear = three(gradient_, 6 * i), angular = three(gradient_, 6 * i + 3);
        three(velocity_, 6 * i) = three(free_, 6 * i) + linear / masses_[i].mass;
        three(velocity_, 6 * i + 3) = three(free_, 6 * i + 3) + masses_[i].inverse_inertia * angular;
    }
    if (!(objective(velocity_) <= objective(free_))) velocity_ = free_;
}

// Takes the impulses as the next estimates. Returns the largest change and the largest impulse, N s.
std::pair<double, double> DirectSolver::next_round() {
    std::pair<double, double> most = joints_.next_round(!limits_held_);
    auto& change = most.first;
    auto& largest = most.second;
    for (ConstraintRows& constraint : constraints_) {
        // Friction by its length: the directions of its rows must not decide when the rounds end.
        const Row(&along)[2] = constraint.friction;
        change = std::max(change, length(along[0].impulse - along[0].estimate, along[1].impulse - along[1].estimate));
        largest = std::max(largest, length(along[0].impulse, along[1].impulse));
        each_row(constraint, [&](Row& row) {
            const bool across = &row == &along[0] || &row == &along[1];
            change = std::max(change, across ? 0.0 : std::abs(row.impulse - row.estimate));
            largest = std::max(largest, across ? 0.0 : std::abs(row.impulse));
            row.estimate = row.impulse;
        });
        if (!limits_held_) set_limits(constraint);
    }
    for (ResistanceRows& resistance : resistances_)
        for (int i = 0; i < 3; ++i) {
            Row& row = resistance.row(i);
            change = std::max(change, std::abs(row.impulse - row.estimate) / length_);
            row.estimate = row.impulse;
        }
    if (!limits_held_) set_resistance_limits();
    return most;
}

// Where friction itself carries the load that limits it, as at a ball wedged at a friction coefficient near 1, the
// limits follow each other by a factor near 1. Every third time they take their limit (Aitken's extrapolation).
void DirectSolver::follow_limits(int time) {
    for (ConstraintRows& constraint : constraints_) {
        double(&last)[2] = constraint.last_limits;
        const double step = constraint.limit - last[0], step_before = last[0] - last[1];
        last[1] = last[0];
        last[0] = constraint.limit;
        if (time % 3 < 2 || !(step * step_before > 0.0 && std::abs(step) < std::abs(step_before))) continue;
        constraint.limit = std::max(0.0, constraint.limit + step * step / (step_before - step));
    }
}

// From free_ and the rows' targets to velocity_ and their impulses.
bool DirectSolver::solve_rounds() {
    // Friction starts soft, where Newton's method does not stall on the edges of the discs; it becomes stiffer from
    // round to round, each starting from the solution of the last, as far as that converges.
    friction_compliance_ = tuning::direct_friction_soft * compliance_;
    start();
    bool found = false, refused = true;  // a solution outside the cones is none: the rounds go on
    for (int round = 0; round < (refused ? tuning::direct_most_rounds : tuning::direct_rounds); ++round) {
        if (found) kept_ = velocity_;
        const int steps = found ? tuning::direct_newton_steps : direct_first_newton_steps;
        if (!minimize(steps, refused ? steps : 0)) {
            if (!found) return false;
            velocity_ = kept_;
            each_contact_row([](const ConstraintRows&, Row& row) { row.impulse = row.estimate; });
            break;
        }
        found = true;
        const auto [change, largest] = next_round();
        refused = !within_cones();
        if (refused && round >= tuning::direct_rounds) follow_limits(round - tuning::direct_rounds);
        const double least = std::max(largest, 1e-6 * total_mass_ * speed_scale_);
        if (!refused && change <= tuning::direct_round_tolerance * least) break;
        friction_compliance_ = std::max(friction_compliance_ * tuning::direct_friction_stiffening,
                                        tuning::direct_friction_stiff * compliance_);
    }
    return true;
}

}  // namespace tumble
