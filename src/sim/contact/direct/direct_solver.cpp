#include "sim/contact/direct/direct_solver.h"

#include "sim/contact/direct/settings.h"
#include "sim/contact/model/predicted_gap.h"
#include "sim/contact/model/settings.h"
#include "sim/contact/model/spin_friction.h"

#include <algorithm>
#include <cmath>

namespace tumble {

using namespace contact_rows;

namespace {

int place_of(std::span<const std::uint32_t> bodies, std::uint32_t body) {
    const auto found = std::lower_bound(bodies.begin(), bodies.end(), body);
    return found != bodies.end() && *found == body ? int(found - bodies.begin()) : -1;
}

Eigen::Map<Vec3> three(std::vector<double>& numbers, std::size_t from) {
    return Eigen::Map<Vec3>(numbers.data() + from);
}
Eigen::Map<const Vec3> three(const std::vector<double>& numbers, std::size_t from) {
    return Eigen::Map<const Vec3>(numbers.data() + from);
}

void add_outer(BlockCholesky::Block& block, const double* left, const BlockCholesky::Row& right) {
    for (int k = 0; k < 6; ++k) block.row[k] += left[k] * right;
}

}  // namespace

void DirectSolver::load_bodies(const ContactProblem& problem, std::span<const std::uint32_t> bodies) {
    const std::size_t n = bodies.size();
    masses_.resize(n);
    for (auto* v : {&free_, &velocity_, &step_, &gradient_, &scratch_, &push_}) v->assign(6 * n, 0.0);
    length_ = total_mass_ = speed_scale_ = fastest_ = 0.0;
    for (const std::uint32_t i : bodies) length_ += problem.bodies[i].radius / double(n);
    for (std::size_t k = 0; k < n; ++k) {
        const Body& body = problem.bodies[bodies[k]];
        total_mass_ += body.mass;
        masses_[k].mass = body.mass;
        masses_[k].inertia = body.rotation * body.inertia_body * body.rotation.transpose() / (length_ * length_);
        masses_[k].inverse_inertia = body.inverse_inertia * (length_ * length_);
        put(&free_[6 * k], body.velocity, length_ * (body.angular_velocity + body.gyration));
        fastest_ = std::max({fastest_, body.velocity.norm(), length_ * body.angular_velocity.norm()});
        speed_scale_ = std::max(speed_scale_, (body.velocity - problem.before[bodies[k]].velocity).norm());
    }
}

void DirectSolver::load_patches(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                                std::span<const std::uint32_t> manifolds) {
    patches_.clear();
    driven_ = false;
    const double h = problem.patches.h;
    for (const std::uint32_t k : manifolds) {
        const Manifold& m = problem.manifolds[k];
        const Body &a = problem.bodies[m.a], &b = problem.bodies[m.b];
        Patch patch;
        const BodiesInStep both{a, b, problem.before[m.a], problem.before[m.b]};
        patch.geometry = make_constraint(m, both, problem.patches);
        const ContactConstraint& geometry = patch.geometry;
        if (geometry.count == 0) continue;
        patch.a = place_of(bodies, m.a);
        patch.b = place_of(bodies, m.b);
        patch.count = geometry.count;
        const RowBodies row_bodies{patch, a, b, length_};
        patch.manifold = k;
        patch.coefficient = geometry.friction;
        patch.size = geometry.size;
        const Vec3 round = arc_velocity(m, both, h);
        driven_ = driven_ || (patch.a == none && a.moves()) || (patch.b == none && b.moves()) || !round.isZero(0.0);
        for (int i = 0; i < patch.count; ++i) {
            const ContactConstraint::Point& p = geometry.points[std::size_t(i)];
            Row& row = patch.normal[i];
            set_row(row, geometry.normal, p.arm_a, p.arm_b, row_bodies);
            row.offset += round.dot(geometry.normal);
            row.estimate = p.impulse;
            row.target = std::min(0.0, -p.separation / h);
            patch.lever[i] = p.lever;
            patch.overlap[i] = -p.separation;
            speed_scale_ = std::max(speed_scale_, row.target - row.offset - dot(patch, row, free_));
        }
        const Vec3 &arm_a = geometry.friction_arm_a, &arm_b = geometry.friction_arm_b;
        set_row(patch.friction[0], geometry.tangent_1, arm_a, arm_b, row_bodies);
        set_row(patch.friction[1], geometry.tangent_2, arm_a, arm_b, row_bodies);
        Vec3 turn = Vec3::Zero();
        const Vec3 motion = problem.before[m.b].velocity - problem.before[m.a].velocity;
        if (patch.a == none && a.moves()) turn = turn_of_carrier(a, motion, geometry.normal);
        if (patch.b == none && b.moves()) turn = -turn_of_carrier(b, -motion, geometry.normal);
        patch.friction[0].offset += (round - 0.5 * h * turn).dot(geometry.tangent_1);
        patch.friction[1].offset += (round - 0.5 * h * turn).dot(geometry.tangent_2);
        set_twist(patch.twist, geometry.normal, row_bodies);
        patch.friction[0].estimate = m.friction[0];
        patch.friction[1].estimate = m.friction[1];
        patch.twist.estimate = m.twist;
        const Vec3& n = geometry.normal;
        const double gives =
            n.dot((a.inverse_inertia + b.inverse_inertia) * n);  // zero for bodies that no impulse moves
        patch.free_slip = std::hypot(patch.friction[0].offset + dot(patch, patch.friction[0], free_),
                                     patch.friction[1].offset + dot(patch, patch.friction[1], free_));
        patch.free_spin = std::abs(patch.twist.offset + dot(patch, patch.twist, free_));
        patch.twist_mass = 1.0 / gives;
        patches_.push_back(patch);
    }
}

// The graph: pairs of dynamic bodies in the manifolds' order.
void DirectSolver::structure(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                             std::span<const std::uint32_t> manifolds) {
    pairs_.clear();
    for (const std::uint32_t k : manifolds) {
        const Manifold& m = problem.manifolds[k];
        const int a = place_of(bodies, m.a), b = place_of(bodies, m.b);
        if (a != none && b != none) pairs_.push_back({std::uint32_t(a), std::uint32_t(b)});
    }
    matrix_.analyse(bodies.size(), pairs_);
}

std::size_t DirectSolver::factor_work(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                                      std::span<const std::uint32_t> manifolds) {
    structure(problem, bodies, manifolds);
    return matrix_.work();
}

void DirectSolver::mass_times(const std::vector<double>& u, std::vector<double>& result) const {
    for (std::size_t i = 0; i < masses_.size(); ++i) {
        const Vec3 linear = three(u, 6 * i), angular = three(u, 6 * i + 3);
        three(result, 6 * i) = masses_[i].mass * linear;
        three(result, 6 * i + 3) = masses_[i].inertia * angular;
    }
}

double DirectSolver::kinetic_energy(const std::vector<double>& u) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < masses_.size(); ++i) {
        const Vec3 linear = three(u, 6 * i), angular = three(u, 6 * i + 3);
        sum += 0.5 * masses_[i].mass * linear.squaredNorm() + 0.5 * angular.dot(masses_[i].inertia * angular);
    }
    return sum;
}

// Sets friction limits from the normal impulses of the last round.
void DirectSolver::set_limits(Patch& patch) {
    double load = 0.0, levers = 0.0;
    Vec3 aside = Vec3::Zero();
    for (int i = 0; i < patch.count; ++i) {
        const double impulse = patch.normal[i].estimate;
        load += impulse;
        levers += impulse * patch.lever[i];
        aside += impulse * (patch.geometry.points[std::size_t(i)].arm_a - patch.geometry.friction_arm_a);
    }
    levers += (1.0 - patch.geometry.spread) * aside.norm();
    patch.limit = patch.coefficient * load;
    patch.twist_limit = patch.coefficient * levers;
    patch.spins = patch.twist_limit > 0.0 && patch.twist_mass * patch.free_spin > patch.twist_limit &&
                  levers * patch.free_spin > tuning::spin_share * load * patch.free_slip;
    if (!patch.spins) return;
    const double distance = levers / load, spin = distance * patch.free_spin;
    const spin_friction::Limit shared = spin_friction::limit(patch.free_slip * patch.free_slip, spin * spin);
    patch.limit *= shared.load;
    patch.spin_lever = distance * shared.lever;
}

void DirectSolver::evaluate_speeds() {
    for (Patch& patch : patches_)
        each_row(patch, [&](Row& row) { row.speed = row.offset + dot(patch, row, velocity_); });
}

// Impulses for velocities at a fraction of the Newton step, and the weights of the rows in the second derivatives.
void DirectSolver::evaluate(Patch& patch, double along, Weights* weights) const {
    const double tie = -tuning::direct_tie * speed_scale_ / compliance_;
    for (int i = 0; i < patch.count; ++i) {
        Row& row = patch.normal[i];
        const double y = row.estimate + (row.target - row.speed - along * row.change) / compliance_;
        row.impulse = std::max(0.0, y);
        if (weights) weights->normal[i] = y > tie ? 1.0 / compliance_ : 0.0;  // an untouched stack has only ties
    }
    // Both friction directions and, where they share the limit, the torsional friction over its lever: a ball
    // (spin_friction.h).
    Row* const rows[3] = {&patch.friction[0], &patch.friction[1], &patch.twist};
    const double levers[3] = {1.0, 1.0, patch.spin_lever};
    const int count = patch.spins ? 3 : 2;
    double y[3] = {}, square = 0.0;
    for (int i = 0; i < count; ++i) {
        const Row& row = *rows[i];
        y[i] = row.estimate / levers[i] - levers[i] * (row.speed + along * row.change) / friction_compliance_;
        square += y[i] * y[i];
    }
    const double size = std::sqrt(square);
    const bool slides = size > patch.limit;
    const double scale = slides ? patch.limit / size : 1.0;
    for (int i = 0; i < count; ++i) {
        rows[i]->impulse = levers[i] * scale * y[i];
        for (int k = 0; weights && k < count; ++k) {
            const double along_it = slides ? y[i] * y[k] / square : 0.0;
            weights->friction[i][k] = levers[i] * levers[k] * scale / friction_compliance_ * ((i == k) - along_it);
        }
    }
    if (patch.count < 2 || patch.spins) return;
    const double turning = patch.twist.estimate -
                           (patch.twist.speed + along * patch.twist.change) * length_ * length_ / friction_compliance_;
    patch.twist.impulse = std::clamp(turning, -patch.twist_limit, patch.twist_limit);
    if (weights)
        weights->friction[2][2] =
            std::abs(turning) <= patch.twist_limit ? length_ * length_ / friction_compliance_ : 0.0;
}

// M (u - u*) - J^T f; returns its size as an energy: sum g^2 / m.
double DirectSolver::gradient(std::vector<double>& g) {
    for (std::size_t k = 0; k < velocity_.size(); ++k) scratch_[k] = velocity_[k] - free_[k];
    mass_times(scratch_, g);
    for (Patch& patch : patches_) {
        evaluate(patch, 0.0, nullptr);
        each_row(patch, [&](Row& row) {
            if (row.impulse != 0.0) add(patch, row, -row.impulse, g);
        });
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < masses_.size(); ++i) {
        double square = 0.0;
        for (std::size_t k = 0; k < 6; ++k) square += g[6 * i + k] * g[6 * i + k];
        sum += square / masses_[i].mass;
    }
    return sum;
}

bool DirectSolver::factor(bool pushing) {
    ++factorisations_;
    matrix_.set_zero();
    for (std::size_t i = 0; i < masses_.size(); ++i) {
        BlockCholesky::Block& block = matrix_.diagonal(i);
        for (int r = 0; r < 3; ++r) {
            block.row[r][r] = masses_[i].mass;
            for (int c = 0; c < 3; ++c) block.row[3 + r][3 + c] = masses_[i].inertia(r, c);
        }
    }
    std::size_t pair = 0;
    for (Patch& patch : patches_) {
        Weights w;
        if (pushing) {
            const double stiffness = total_mass_ / tuning::direct_push_compliance;
            bool active = false;
            for (int i = 0; i < patch.count; ++i) {
                const bool on = patch.normal[i].impulse > 0.0 || patch.overlap[i] > tuning::direct_slop * patch.size;
                active = active || on;
                w.normal[i] = on ? stiffness : 0.0;
            }
            // Pushed apart, not sideways.
            const double aside = active ? tuning::direct_push_across * stiffness : 0.0;
            w.friction[0][0] = w.friction[1][1] = aside;
            w.friction[2][2] = patch.count > 1 ? aside * length_ * length_ : 0.0;
        } else {
            evaluate(patch, 0.0, &w);
        }
        const bool both = patch.a != none && patch.b != none;
        BlockCholesky::Block* across = nullptr;
        bool transposed = false;
        if (both) {
            while (!(pairs_[pair].i == std::uint32_t(patch.a) && pairs_[pair].j == std::uint32_t(patch.b))) ++pair;
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
            if (patch.a != none) add_outer(matrix_.diagonal(std::size_t(patch.a)), left.on_a, ra);
            if (patch.b != none) add_outer(matrix_.diagonal(std::size_t(patch.b)), left.on_b, rb);
            if (!both) return;
            if (transposed)
                add_outer(*across, left.on_b, ra);
            else
                add_outer(*across, left.on_a, rb);
        };
        for (int i = 0; i < patch.count; ++i) add_row(patch.normal[i], patch.normal[i], w.normal[i]);
        const Row* const friction[3] = {&patch.friction[0], &patch.friction[1], &patch.twist};
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) add_row(*friction[i], *friction[k], w.friction[i][k]);
    }
    return matrix_.factor();
}

// Slope of the minimized function along the step.
double DirectSolver::slope(double along, double mass_slope, double mass_curvature) {
    double sum = mass_slope + along * mass_curvature;
    for (Patch& patch : patches_) {
        evaluate(patch, along, nullptr);
        each_row(patch, [&](Row& row) { sum -= row.impulse * row.change; });
    }
    return sum;
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

bool DirectSolver::minimise(int most_steps) {
    const double energy = total_mass_ * speed_scale_ * speed_scale_;
    const double speed = std::max(tuning::direct_tolerance * speed_scale_, tuning::direct_rounding * fastest_);
    const double tolerance = total_mass_ * speed * speed;
    for (int k = 0; k <= most_steps; ++k) {
        evaluate_speeds();
        if (gradient(gradient_) <= tolerance) return true;
        if (k == most_steps || !factor(false)) return false;
        for (std::size_t i = 0; i < step_.size(); ++i) step_[i] = -gradient_[i];
        matrix_.solve(step_);
        double slope_0 = 0.0, mass_slope = 0.0, mass_curvature = 0.0;
        mass_times(step_, push_);
        for (std::size_t i = 0; i < step_.size(); ++i) {
            slope_0 += gradient_[i] * step_[i];
            mass_slope += push_[i] * (velocity_[i] - free_[i]);
            mass_curvature += push_[i] * step_[i];
        }
        for (Patch& patch : patches_) each_row(patch, [&](Row& row) { row.change = dot(patch, row, step_); });
        const double along = line_search(slope_0, mass_slope, mass_curvature);
        for (std::size_t i = 0; i < step_.size(); ++i) velocity_[i] += along * step_[i];
        for (Patch& patch : patches_) each_row(patch, [](Row& row) { row.change = 0.0; });
        if (-slope_0 < 1e-30 * energy) return true;  // the remainder is rounding
    }
    return false;
}

// The minimized function, for choosing the start.
double DirectSolver::objective(const std::vector<double>& u) {
    for (std::size_t k = 0; k < u.size(); ++k) scratch_[k] = u[k] - free_[k];
    double sum = kinetic_energy(scratch_);
    for (Patch& patch : patches_) {
        for (int i = 0; i < patch.count; ++i) {
            const Row& row = patch.normal[i];
            const double y = row.estimate + (row.target - row.offset - dot(patch, row, u)) / compliance_;
            if (y > 0.0) sum += 0.5 * compliance_ * y * y;
        }
        // Friction matters for the choice only where it is small compared with the normal terms.
    }
    return sum;
}

// Starts from the last step's impulses where they are better than none.
void DirectSolver::start() {
    std::fill(gradient_.begin(), gradient_.end(), 0.0);
    for (Patch& patch : patches_) {
        set_limits(patch);
        each_row(patch, [&](Row& row) {
            if (row.estimate != 0.0) add(patch, row, row.estimate, gradient_);
        });
    }
    for (std::size_t i = 0; i < masses_.size(); ++i) {
        const Vec3 linear = three(gradient_, 6 * i), angular = three(gradient_, 6 * i + 3);
        three(velocity_, 6 * i) = three(free_, 6 * i) + linear / masses_[i].mass;
        three(velocity_, 6 * i + 3) = three(free_, 6 * i + 3) + masses_[i].inverse_inertia * angular;
    }
    if (!(objective(velocity_) <= objective(free_))) velocity_ = free_;
}

// Contact must not add energy; friction must stay within its cone.
bool DirectSolver::admissible() const {
    const double scale = total_mass_ * speed_scale_ * speed_scale_;
    if (!driven_ && kinetic_energy(velocity_) > kinetic_energy(free_) * (1.0 + 1e-9) + 1e-9 * scale) return false;
    const double closing = tuning::direct_closing * speed_scale_ + tuning::direct_rounding * fastest_;
    for (const Patch& patch : patches_) {
        double load = 0.0;
        for (int i = 0; i < patch.count; ++i) {
            const Row& row = patch.normal[i];
            load += row.impulse;
            // A body squeezed between walls has no solution.
            if (row.offset + dot(patch, row, velocity_) < row.target - closing) return false;
        }
        const double friction = std::hypot(patch.friction[0].impulse, patch.friction[1].impulse);
        if (friction > tuning::direct_cone * patch.coefficient * load + 1e-6 * total_mass_ * speed_scale_) return false;
    }
    return true;
}

bool DirectSolver::solve(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                         std::span<const std::uint32_t> manifolds) {
    factorisations_ = 0;
    way_.clear();
    load_bodies(problem, bodies);
    load_patches(problem, bodies, manifolds);
    if (patches_.empty()) return true;
    structure(problem, bodies, manifolds);
    compliance_ = tuning::direct_compliance / total_mass_;
    // nothing approaches, without gravity: overlaps are pushed apart all the same
    if (speed_scale_ <= tuning::direct_rounding * fastest_) {
        velocity_ = free_;
        store(problem, bodies, push_out(problem.patches.h));
        return true;
    }

    if (const int parts = landing_parts(problem, bodies); parts > 1) {
        if (!solve_in_parts(problem, bodies[0], parts)) return false;
    } else {
        if (!solve_rounds() || !admissible()) return false;
    }
    const bool pushed = push_out(problem.patches.h);
    store(problem, bodies, pushed);
    return true;
}

// From free_ and the rows' targets to velocity_ and their impulses.
bool DirectSolver::solve_rounds() {
    // Friction starts soft, where Newton's method does not stall on the edges of the discs; it becomes stiffer from
    // round to round, each starting from the solution of the last, as far as that converges.
    friction_compliance_ = tuning::direct_friction_soft * compliance_;
    start();
    bool found = false;
    for (int round = 0; round < tuning::direct_rounds; ++round) {
        if (found) kept_ = velocity_;
        if (!minimise(found ? tuning::direct_newton_steps : tuning::direct_first_newton_steps)) {
            if (!found) return false;
            velocity_ = kept_;
            for (Patch& patch : patches_) each_row(patch, [](Row& row) { row.impulse = row.estimate; });
            break;
        }
        found = true;
        double change = 0.0, largest = 0.0;
        for (Patch& patch : patches_) {
            each_row(patch, [&](Row& row) {
                change = std::max(change, std::abs(row.impulse - row.estimate));
                largest = std::max(largest, std::abs(row.impulse));
                row.estimate = row.impulse;
            });
            set_limits(patch);
        }
        if (change <= tuning::direct_round_tolerance * std::max(largest, 1e-6 * total_mass_ * speed_scale_)) break;
        friction_compliance_ = std::max(friction_compliance_ * tuning::direct_friction_stiffening,
                                        tuning::direct_friction_stiff * compliance_);
    }
    return true;
}

// Position correction: overlaps are removed by a pseudo-velocity that leaves the velocities unchanged, by least squares
// over the active contacts.
bool DirectSolver::push_out(double h) {
    std::fill(push_.begin(), push_.end(), 0.0);
    const double stiffness = total_mass_ / tuning::direct_push_compliance;
    bool any = false;
    for (Patch& patch : patches_) {
        for (int i = 0; i < patch.count; ++i) {
            // A bouncing contact separates by its own speed and is pushed only by the difference: a push moves bodies
            // past their momenta.
            const Row& row = patch.normal[i];
            const double parting = std::max(0.0, row.offset + dot(patch, row, velocity_));
            const double beyond = patch.overlap[i] - tuning::direct_slop * patch.size;
            const double speed = std::min(tuning::push_share * beyond / h, tuning::push_limit * patch.size) - parting;
            patch.overlap[i] -= h * parting;
            if (!(speed > 0.0)) continue;
            any = true;
            add(patch, patch.normal[i], stiffness * speed, push_);
        }
    }
    if (!any || !factor(true)) return false;
    matrix_.solve(push_);
    return true;
}

}  // namespace tumble
