#include "sim/contact/direct/direct_solver.h"

#include "core/deterministic_math.h"
#include "sim/contact/direct/settings.h"
#include "sim/contact/model/predicted_gap.h"
#include "sim/contact/model/settings.h"
#include "sim/geometry/contact_tolerance.h"

#include <algorithm>
#include <cmath>

namespace tumble {

using namespace contact_rows;

namespace {

/// A body lands if a gap closes within the step, later than after this share of it. Smaller shares are rounding of
/// resting contacts. Related test: Rocking.LosesNoMoreThanItsLandingsTake.
constexpr double direct_landing = 0.02;

/// Factor by which friction may exceed its cone while its limit follows the normal impulse. Related test:
/// ContactRest.StickOrSlipToAThousandth.
constexpr double direct_cone = 1.05;

/// Largest approach speed that a solution may leave at a contact, share of the speed scale. Not fitted: a solution
/// with a faster approach is a failure.
constexpr double direct_closing = 1e-3;

/// Share of an overlap that is corrected in a step. Smaller values leave boxes sunk after a hard landing; larger
/// ones make heaps tremble (bench_contact). Related: bench_contact "pile of 1000" and the test
/// ContactHardInput.OverlapsDissolveSlowly.
constexpr double correction_share = 0.2;

// Joined bodies bounce here and not in the stage of impacts, which knows no joints: -e v_rel- (notes eq. 14) of a point
// that touches and approaches fast; otherwise 0.
double rebound(const Manifold& m, const ContactConstraint::Point& p, const BodiesInStep& bodies,
               const ConstraintSettings& settings) {
    const double e = pair_restitution(bodies.a, bodies.b);
    const bool joined = bodies.a.jointed || bodies.b.jointed;
    if (!joined || !(e > 0.0)) return 0.0;
    const double gap = m.points[std::size_t(p.source)].separation;
    if (gap > touch_distance(bodies.a.radius, bodies.b.radius)) return 0.0;
    const auto speed = [&](const BodyVelocity& v, const Vec3& arm) {
        return m.normal.dot(v.velocity + v.angular_velocity.cross(arm));
    };
    const double approach = speed(bodies.before_a, p.arm_a) - speed(bodies.before_b, p.arm_b);
    return settings.bounces(approach, m, p.source, bodies.a, bodies.b) ? e * approach : 0.0;
}

}  // namespace

void DirectSolver::read_bodies(const ContactProblem& problem, std::span<const std::uint32_t> bodies) {
    const std::size_t n = bodies.size();
    masses_.resize(n);
    for (auto* v : {&free_, &velocity_, &step_, &gradient_, &scratch_, &correction_}) v->assign(6 * n, 0.0);
    length_ = total_mass_ = speed_scale_ = fastest_ = 0.0;
    lightest_ = infinity;
    for (const std::uint32_t i : bodies) length_ += problem.bodies[i].radius / double(n);
    for (std::size_t k = 0; k < n; ++k) {
        const Body& body = problem.bodies[bodies[k]];
        total_mass_ += body.mass;
        lightest_ = std::min(lightest_, body.mass);
        masses_[k].mass = body.mass;
        masses_[k].inertia = body.rotation * body.inertia_body * body.rotation.transpose() / (length_ * length_);
        masses_[k].inverse_inertia = body.inverse_inertia * (length_ * length_);
        put(&free_[6 * k], body.velocity, length_ * (body.angular_velocity + body.gyration));
        fastest_ = std::max({fastest_, body.velocity.norm(), length_ * body.angular_velocity.norm()});
        speed_scale_ = std::max(speed_scale_, (body.velocity - problem.before[bodies[k]].velocity).norm());
    }
}

void DirectSolver::linearize_constraints(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                                         std::span<const std::uint32_t> manifolds) {
    constraints_.clear();
    resistances_.clear();
    area_firsts_.clear();
    driven_ = false;
    const double h = problem.settings.h;
    for (const std::uint32_t k : manifolds) {
        const Manifold& m = problem.manifolds[k];
        const Body &a = problem.bodies[m.a], &b = problem.bodies[m.b];
        ConstraintRows constraint;
        const BodiesInStep both{a, b, problem.before[m.a], problem.before[m.b]};
        constraint.geometry = make_constraint(m, both, problem.settings);
        const ContactConstraint& geometry = constraint.geometry;
        if (geometry.count == 0) continue;
        constraint.a = place_of(bodies, m.a);
        constraint.b = place_of(bodies, m.b);
        constraint.count = geometry.count;
        const RowBodies row_bodies{constraint, a, b, length_};
        constraint.manifold = k;
        constraint.coefficient = geometry.friction;
        constraint.size = geometry.size;
        const Vec3 round = arc_velocity(m, both, h);
        driven_ =
            driven_ || (constraint.a == none && a.moves()) || (constraint.b == none && b.moves()) || !round.isZero(0.0);
        for (int i = 0; i < constraint.count; ++i) {
            const ContactConstraint::Point& p = geometry.points[std::size_t(i)];
            Row& row = constraint.normal[i];
            set_row(row, geometry.normal, p.arm_a, p.arm_b, row_bodies);
            row.offset += round.dot(geometry.normal);
            row.estimate = p.impulse;
            row.target = std::min(0.0, -p.separation / h);
            constraint.lever[i] = p.lever;
            constraint.overlap[i] = -p.separation;
            if (problem.joints) {
                constraint.rebound[i] = rebound(m, p, both, problem.settings);
                if (constraint.rebound[i] > 0.0) row.target = constraint.rebound[i];
            }
            speed_scale_ = std::max(speed_scale_, row.target - row.offset - dot(constraint, row, free_));
        }
        if (problem.areas && problem.areas->holds(k)) join_area(constraint, problem);
        if (!constraint.rubs) {
            constraints_.push_back(constraint);
            add_resistance(int(constraints_.size()) - 1, problem);
            continue;
        }
        const Vec3 &arm_a = geometry.friction_arm_a, &arm_b = geometry.friction_arm_b;
        set_row(constraint.friction[0], geometry.tangent_1, arm_a, arm_b, row_bodies);
        set_row(constraint.friction[1], geometry.tangent_2, arm_a, arm_b, row_bodies);
        Vec3 turn = Vec3::Zero();
        const Vec3 motion = problem.before[m.b].velocity - problem.before[m.a].velocity;
        if (constraint.a == none && a.moves()) turn = turn_of_carrier(a, motion, geometry.normal);
        if (constraint.b == none && b.moves()) turn = -turn_of_carrier(b, -motion, geometry.normal);
        constraint.friction[0].offset += (round - 0.5 * h * turn).dot(geometry.tangent_1);
        constraint.friction[1].offset += (round - 0.5 * h * turn).dot(geometry.tangent_2);
        set_turn(constraint.torsion, geometry.normal, row_bodies);
        constraint.friction[0].estimate = m.friction[0];
        constraint.friction[1].estimate = m.friction[1];
        constraint.torsion.estimate = m.torsion;
        const Vec3& n = geometry.normal;
        const double gives =
            n.dot((a.inverse_inertia + b.inverse_inertia) * n);  // zero for bodies that no impulse moves
        constraint.free_slip =
            hypotenuse(constraint.friction[0].offset + dot(constraint, constraint.friction[0], free_),
                       constraint.friction[1].offset + dot(constraint, constraint.friction[1], free_));
        constraint.free_spin = std::abs(constraint.torsion.offset + dot(constraint, constraint.torsion, free_));
        constraint.torsion_mass = 1.0 / gives;
        constraints_.push_back(constraint);
        add_resistance(int(constraints_.size()) - 1, problem);
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
    joints_.add_pairs(pairs_);
    matrix_.analyze(bodies.size(), pairs_);
}

std::size_t DirectSolver::factor_work(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                                      std::span<const std::uint32_t> manifolds) {
    joints_.clear();
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

// Friction may exceed its cone a little, because its limit follows the normal impulse.
bool DirectSolver::within_cones() const {
    return std::all_of(constraints_.begin(), constraints_.end(), [&](const ConstraintRows& constraint) {
        if (!constraint.rubs) return true;
        double load = 0.0;
        for (int i = 0; i < constraint.count; ++i) load += constraint.normal[i].impulse;
        const double friction = hypotenuse(constraint.friction[0].impulse, constraint.friction[1].impulse);
        const double limit =
            constraint.area ? shared_load(constraint, &Row::impulse).first : constraint.coefficient * load;
        return friction <= direct_cone * limit + 1e-6 * total_mass_ * speed_scale_;
    });
}

// Contact must not add energy; friction must stay within its cone.
bool DirectSolver::admissible() const {
    const double scale = total_mass_ * speed_scale_ * speed_scale_;
    if (!driven_ && kinetic_energy(velocity_) > kinetic_energy(free_) * (1.0 + 1e-9) + 1e-9 * scale) return false;
    const double closing = direct_closing * speed_scale_ + tuning::direct_rounding * fastest_;
    for (const ConstraintRows& constraint : constraints_)
        for (int i = 0; i < constraint.count; ++i) {
            const Row& row = constraint.normal[i];
            // A body squeezed between walls has no solution.
            if (row.offset + dot(constraint, row, velocity_) < row.target - closing) return false;
        }
    return within_cones();
}

// Gives the contacts' impulses to the bodies; `reached` marks bodies that got one, by index in the island.
void DirectSolver::apply_contacts(const ContactProblem& problem, std::vector<bool>& reached) {
    sum_area_loads();
    for (const ConstraintRows& constraint : constraints_) {
        const Manifold& m = problem.manifolds[constraint.manifold];
        Body &a = problem.bodies[m.a], &b = problem.bodies[m.b];
        const ContactConstraint& geometry = constraint.geometry;
        const auto [along_1, along_2, torsion] = rubbing(constraint);
        const Vec3 friction = along_1 * geometry.tangent_1 + along_2 * geometry.tangent_2;
        Vec3 force = friction,
             moment = geometry.friction_arm_a.cross(friction) + torsion * geometry.normal;  // about A's center
        for (int i = 0; i < constraint.count; ++i) {
            const Vec3 j = constraint.normal[i].impulse * geometry.normal;
            force += j;
            moment += geometry.points[std::size_t(i)].arm_a.cross(j);
        }
        if (constraint.resistance != none) moment += resistance_of(constraint);
        if (force.isZero(0.0) && moment.isZero(0.0)) continue;
        if (problem.totals) (*problem.totals)[constraint.manifold].add(force, moment, a, b);
        if (constraint.a != none) {
            reached[std::size_t(constraint.a)] = true;
            a.momentum -= force;
            a.angular_momentum -= moment;
        }
        if (constraint.b != none) {
            reached[std::size_t(constraint.b)] = true;
            b.momentum += force;
            b.angular_momentum += moment + (a.position - b.position).cross(force);
        }
    }
}

// Keeps the contacts' impulses with their manifolds.
void DirectSolver::store_contacts(const ContactProblem& problem) {
    sum_area_loads();
    for (const ConstraintRows& constraint : constraints_) {
        Manifold& m = problem.manifolds[constraint.manifold];
        release(m);
        const auto [along_1, along_2, torsion] = rubbing(constraint);
        m.friction[0] = along_1;
        m.friction[1] = along_2;
        m.torsion = torsion;
        if (constraint.resistance != none)
            for (const int i : {0, 1})
                m.rolling[i] = float(resistances_[std::size_t(constraint.resistance)].rolling[i].impulse);
        m.tangent = constraint.geometry.tangent_1;
        for (int i = 0; i < constraint.count; ++i) {
            const ContactConstraint::Point& p = constraint.geometry.points[std::size_t(i)];
            m.points[std::size_t(p.source)].impulse = constraint.normal[i].impulse;
        }
    }
}

void DirectSolver::store(const ContactProblem& problem, std::span<const std::uint32_t> bodies, bool pushed) {
    std::vector<bool> reached(bodies.size(), pushed);  // by impulses or a correction
    apply_contacts(problem, reached);
    store_contacts(problem);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        if (!reached[k]) continue;
        Body& body = problem.bodies[bodies[k]];
        body.derive_velocities();
        if (!pushed && displacement_.empty()) continue;
        body.correction_velocity = Vec3::Map(correction_.data() + 6 * k);
        body.correction_angular_velocity = Vec3::Map(correction_.data() + 6 * k + 3) / length_;
        if (displacement_.empty()) continue;
        const double rate = 1.0 / problem.settings.h;
        body.correction_velocity += rate * Vec3::Map(displacement_.data() + 6 * k) - body.velocity;
        body.correction_angular_velocity +=
            rate / length_ * Vec3::Map(displacement_.data() + 6 * k + 3) - body.angular_velocity - body.gyration;
    }
}

// Landings of a body that already stands on something, as of a rocking block on its other edge: solved in substeps.
//
// A contact row closes a gap at constant speed from the start of the step, as if the corner had landed then and the
// other corner no longer carried the body. At 60 steps per second a rocking block so loses a tenth of its energy in
// each landing, beyond the loss of the landing itself. In n substeps, each as long as the soft solver's substep, it is
// an n-th of that.
int DirectSolver::landing_substeps(const ContactProblem& problem, std::span<const std::uint32_t> bodies) const {
    if (bodies.size() != 1) return 1;
    bool lands = false, stands = false;
    for (const ConstraintRows& constraint : constraints_)
        for (int i = 0; i < constraint.count; ++i) {
            const Row& row = constraint.normal[i];
            const double closing = -(row.offset + dot(constraint, row, free_)), even = -row.target;
            lands = lands || (even > direct_landing * closing && closing > even);
            stands = stands || -constraint.overlap[i] < tuning::friction_near * constraint.size;
        }
    return lands && stands ? int(std::lround(problem.settings.h / tuning::soft_substep)) : 1;
}

bool DirectSolver::solve_in_substeps(const ContactProblem& problem, std::uint32_t index, int substeps) {
    const BodyVelocity& before = problem.before[index];
    const Body& body = problem.bodies[index];
    const double d = problem.settings.h / substeps;
    std::vector<double> faster(6), velocity(6), sums;
    put(velocity.data(), before.velocity, length_ * (before.angular_velocity + body.gyration));
    for (std::size_t k = 0; k < 6; ++k) faster[k] = (free_[k] - velocity[k]) / substeps;
    displacement_.assign(6, 0.0);
    each_contact_row([&](const ConstraintRows&, Row& row) { row.estimate /= substeps; });
    for (int substep = 0; substep < substeps; ++substep) {
        for (std::size_t k = 0; k < 6; ++k) free_[k] = velocity[k] + faster[k];
        for (ConstraintRows& constraint : constraints_)
            for (int i = 0; i < constraint.count; ++i) {
                Row& row = constraint.normal[i];
                const double gap =
                    -constraint.overlap[i] + dot(constraint, row, displacement_) + substep * d * row.offset;
                row.target = std::min(0.0, -gap / d);
            }
        friction_compliance_ = tuning::direct_friction_soft * compliance_;
        if (!solve_rounds() || !admissible()) return false;
        velocity = velocity_;
        for (std::size_t k = 0; k < 6; ++k) displacement_[k] += d * velocity[k];
        std::size_t next = 0;
        each_contact_row([&](const ConstraintRows&, Row& row) {
            if (substep == 0) sums.push_back(0.0);
            sums[next++] += row.impulse;
        });
    }
    std::size_t next = 0;
    each_contact_row([&](const ConstraintRows&, Row& row) { row.impulse = sums[next++]; });
    std::fill(correction_.begin(), correction_.end(), 0.0);
    return true;
}

bool DirectSolver::solve(const ContactProblem& problem, std::span<const std::uint32_t> bodies,
                         std::span<const std::uint32_t> manifolds, std::span<const std::uint32_t> joints) {
    factorizations_ = 0;
    displacement_.clear();
    for (const std::uint32_t k : manifolds) problem.manifolds[k].solved_by = SolvedBy::direct;
    read_bodies(problem, bodies);
    linearize_constraints(problem, bodies, manifolds);
    joints_.clear();
    if (!joints.empty()) return solve_with_joints(problem, bodies, manifolds, joints);
    if (constraints_.empty()) return true;
    structure(problem, bodies, manifolds);
    compliance_ = tuning::direct_compliance / total_mass_;
    // nothing approaches, without gravity: overlaps are pushed apart all the same
    if (speed_scale_ <= tuning::direct_rounding * fastest_) {
        velocity_ = free_;
        store(problem, bodies, correct_overlaps(problem.settings.h));
        return true;
    }

    if (const int substeps = landing_substeps(problem, bodies); substeps > 1) {
        if (!solve_in_substeps(problem, bodies[0], substeps)) return false;
    } else {
        if (!solve_rounds() || !admissible()) return false;
    }
    const bool pushed = correct_overlaps(problem.settings.h);
    store(problem, bodies, pushed);
    return true;
}

// Position correction: overlaps are removed by a pseudo-velocity that leaves the velocities unchanged, by least squares
// over the active contacts.
bool DirectSolver::correct_overlaps(double h) {
    std::fill(correction_.begin(), correction_.end(), 0.0);
    const double stiffness = total_mass_ / tuning::direct_correction_compliance;
    bool any = false;
    for (ConstraintRows& constraint : constraints_) {
        for (int i = 0; i < constraint.count; ++i) {
            // A bouncing contact separates by its own speed and is pushed only by the difference: a correction moves
            // bodies past their momenta.
            const Row& row = constraint.normal[i];
            const double parting = std::max(0.0, row.offset + dot(constraint, row, velocity_));
            const double beyond = constraint.overlap[i] - tuning::direct_slop * constraint.size;
            const double speed =
                std::min(correction_share * beyond / h, tuning::correction_limit * constraint.size) - parting;
            constraint.overlap[i] -= h * parting;
            if (!(speed > 0.0)) continue;
            any = true;
            add(constraint, constraint.normal[i], stiffness * speed, correction_);
        }
    }
    if (!joints_.empty()) return any;
    if (!any || !factor(true)) return false;
    matrix_.solve(correction_);
    return true;
}

}  // namespace tumble
