#include "sim/articulation/tree_flight.h"

#include "sim/articulation/settings.h"
#include "sim/dynamics/integrators/composition.h"
#include "sim/dynamics/integrators/extrapolation.h"
#include "sim/dynamics/integrators/runge_kutta_4.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

/// Error of a step of the extrapolation, as a share of a radian, of the tree's mean radius and of its fastest rate:
/// below, its results are as near to each other as rounding allows. Related test:
/// TreeFlight.ADoublePendulumToTheLastDigits.
constexpr double tree_tolerance = 2e-15;

/// Error in units of that tolerance which may be rounding. Related test: TreeFlight.LightLinksBetweenHeavyBodies.
constexpr double tree_rounding = 1e5;

/// Error of the energy in a step of Verlet's method, as a share of the kinetic energy, above which the substeps are
/// halved. Related test: Verlet.FastFreeTreesKeepTheirEnergy.
constexpr double verlet_energy = 1e-4;

/// Substeps beyond which passes that do not close the joints leave the step to the rows. Not fitted: a bound of the
/// cost.
constexpr int closure_substeps = 64;

constexpr int pushed_numbers = 7;  // by body

// m / length where a coordinate is a displacement.
bool is_length(const TreeNode& node, int k, bool speed) {
    return node.is_length(!speed && node.kind == NodeKind::free ? (k < 3 ? 3 : 0) : k);
}

}  // namespace

// Totals of the bodies' present momenta, about their center of mass.
TreeFlight::Totals TreeFlight::totals() const {
    Totals sum;
    for (const std::uint32_t i : step_->island) {
        const Body& body = step_->bodies[i];
        sum.mass += body.mass;
        sum.momentum += body.momentum;
        sum.angular_momentum += body.angular_momentum;
    }
    const Vec3 mean = sum.momentum / sum.mass;
    for (const std::uint32_t i : step_->island) {
        const Body& body = step_->bodies[i];
        const Vec3 place = body.position - tree_.origin();
        sum.angular_momentum += place.cross(body.momentum - body.mass * mean);
        sum.center += body.mass / sum.mass * place;
    }
    return sum;
}

// `stage`: length of a stage of Verlet's method, s; 0: of another method.
bool TreeFlight::start(double stage) {
    const TreeStep& step = *step_;
    if (!tree_.find(step.bodies, step.island, step.joints, step.all) || tree_.gap() > tuning::tree_gap) return false;
    dynamics_.stand();
    if (track() && step.late) return false;
    if (!closures_.find(tree_, step, stage)) return false;
    if (track() && !closures_.empty()) return false;
    if (!springs_.find(tree_, step, stage)) return false;
    friction_.find(tree_, step);
    limits_.clear();
    if (stage == 0.0 && !limits_.find(tree_, step, closures_)) return false;
    pushed_ = track() != nullptr;  // the time is a coordinate
    fitted_.resize(0);
    for (const std::uint32_t i : step.island)
        pushed_ =
            pushed_ || step.bodies[i].gravity_scale != 1.0 || !step.forces.constant(i, step.from, step.from + step.h);
    const int n = int(step.island.size());
    coordinates_ = tree_.coordinates();
    heats_ = coordinates_ + tree_.speeds();
    works_ = heats_ + springs_.dampers();
    closed_ = works_ + friction_.motors();
    extras_ = closed_ + (closures_.empty() ? 0 : 1 + TreeClosures::sums * int(closures_.parts()));
    y_.setZero(extras_ + (pushed_ ? 1 + pushed_numbers * n + 6 : 0));
    pushes_.assign(pushed_ || !closures_.empty() ? step.island.size() : 0, {});
    time_ = 0.0;
    evaluations_ = 0;
    frame_ = {tree_.origin(), Vec3::Zero(), step.forces.gravity()};
    if (tree_.is_free()) {
        start_ = totals();
        frame_.velocity = start_.momentum / start_.mass;
    }
    tree_.start(y_.data());
    law_time_ = 0.5 * (step.from + next_change(step.from));
    if (jolted()) return false;
    carry(0.0);
    dynamics_.set_state(step.bodies, step.island, y_.data());
    velocities_.resize(step.island.size());
    for (std::size_t i = 0; i < step.island.size(); ++i) {
        const Body& body = step.bodies[step.island[i]];
        velocities_[i] = {body.angular_velocity, body.velocity - frame_.velocity};
    }
    dynamics_.find_speeds(velocities_, y_.data() + coordinates_);
    if (!account_) account_.emplace(tree_, frame_);
    account_->begin(step);
    lost_ = 0.0;
    if (!y_.allFinite()) return false;
    if (!fits()) fit();
    if (stage > 0.0 && tree_.is_free()) energy_ = kinetic_energy();
    return y_.allFinite() && ((friction_.empty() && limits_.empty()) || begin_laws());
}

// The tree's speeds at the bodies' momenta: the nearest in the metric of their masses. Impulses in the joints make the
// change.
void TreeFlight::fit() {
    const std::vector<double> still(std::size_t(tree_.speeds()), 0.0);
    carry(0.0, true);
    dynamics_.move(y_.data(), still.data());
    std::vector<Wrench> momenta;
    for (std::size_t i = 0; i < step_->island.size(); ++i) {
        const Body& body = step_->bodies[step_->island[i]];
        momenta.push_back({body.momentum - body.mass * frame_.velocity, body.angular_momentum});
        dynamics_.apply(tree_.node_of_body()[i], momenta.back());
    }
    closures_.accelerate(dynamics_, Vec3::Zero(), y_.data(), y_.data() + coordinates_);
    if (!closures_.empty()) closures_.add_to(dynamics_, momenta);
    account_->strike(dynamics_, 0.0, momenta);
    carry(0.0);
    dynamics_.move(y_.data(), y_.data() + coordinates_);
    if (!closures_.empty()) closures_.add_sums(dynamics_, frame_, 0.0, 1.0, y_.data() + closed_ + 1);
    for (std::size_t i = 0; i < step_->island.size(); ++i) {
        const Body& body = step_->bodies[step_->island[i]];
        const ForwardDynamics::Link& link = dynamics_.link(tree_.node_of_body()[i]);
        const Vec3 moves = link.center_velocity() + frame_.velocity - body.velocity,
                   turns = body.rotation.transpose() * (link.velocity.turn - body.angular_velocity);
        lost_ += 0.5 * (body.mass * moves.squaredNorm() + turns.dot(body.inertia_body * turns));
    }
}

// True if the bodies' velocities are the velocities of the tree.
bool TreeFlight::fits() {
    double fastest = 0.0, off = 0.0;
    for (std::size_t i = 0; i < step_->island.size(); ++i) {
        const Body& body = step_->bodies[step_->island[i]];
        const ForwardDynamics::Link& link = dynamics_.link(tree_.node_of_body()[i]);
        fastest = std::max({fastest, body.velocity.norm(), step_->length * body.angular_velocity.norm()});
        off = std::max({off, (link.center_velocity() + frame_.velocity - body.velocity).norm(),
                        step_->length * (link.velocity.turn - body.angular_velocity).norm()});
    }
    closures_.linearize_forms(dynamics_, y_.data());
    for (const double rate : closures_.speeds_of(y_.data() + coordinates_)) off = std::max(off, std::abs(rate));
    return off <= tuning::tree_misfit * fastest;
}

// J, in the falling frame; after move() or place().
double TreeFlight::kinetic_energy() const {
    double sum = 0.0;
    for (const TreeNode& node : tree_.nodes()) {
        if (node.armature > 0.0) {
            const double speed = y_[coordinates_ + node.speed_at];
            sum += 0.5 * node.armature * speed * speed;
        }
        if (node.body == TreeNode::no_body) continue;
        const ForwardDynamics::Link& link = dynamics_.link(int(&node - tree_.nodes().data()));
        const Vec3 turn = link.rotation.transpose() * link.velocity.turn;
        sum += 0.5 * (node.mass * link.center_velocity().squaredNorm() + turn.dot(node.inertia * turn));
    }
    return sum;
}

// Returns true if Verlet's method has kept the energy of a free tree, or if half as many substeps have kept it as well:
// then the error is rounding.
bool TreeFlight::keeps_energy() {
    if (!tree_.is_free() || pushed_ || !springs_.empty() || !closures_.empty()) return true;
    const double now = kinetic_energy(), fall = step_->h * frame_.gravity.norm();
    const double work = friction_.work(y_.data(), y_.data() + works_);
    const double scale = std::max({energy_, now, 0.5 * start_.mass * fall * fall});
    const double error = std::abs(now - energy_ - work), last = last_error_;
    last_error_ = error;
    strains_energy_ = error > 0.1 * verlet_energy * scale;
    coarse_ = error > verlet_energy * scale && error < 0.5 * last;
    return !coarse_;
}

TreeFlight::Vector TreeFlight::rate(const Vector& y) {
    fitted_.resize(0);
    Vector dy(y.size());
    const double *q = y.data(), *speeds = q + coordinates_;
    if (track()) carry(y[extras_]);
    dynamics_.move(q, speeds);
    springs_.drive(dynamics_, q, speeds, dy.data() + heats_);
    friction_.drive(dynamics_);
    limits_.drive(dynamics_, speeds);
    if (pushed_) add_pushes(y, dy);
    closures_.drive(dynamics_);
    closures_.accelerate(dynamics_, tree_.is_free() ? Vec3(Vec3::Zero()) : Vec3(-frame_.gravity), q,
                         dy.data() + coordinates_);
    if (!closures_.empty()) {
        if (!pushed_) std::fill(pushes_.begin(), pushes_.end(), Wrench{});
        closures_.add_to(dynamics_, pushes_);
        dy.segment(closed_, extras_ - closed_).setZero();
        dy[closed_] = 1.0;
        closures_.add_sums(dynamics_, frame_, y[closed_], 1.0, dy.data() + closed_ + 1);
    }
    friction_.find_powers(dynamics_, speeds, dy.data() + works_);
    dynamics_.coordinate_rates(q, speeds, dy.data());
    ++evaluations_;
    return dy;
}

// Forces beside gravity, for the velocities in the scene; their impulses and moments are taken in the falling frame.
// `ahead`: half of a stage of Verlet's method, whose impulses are those of its start.
void TreeFlight::add_pushes(const Vector& y, Vector& dy, double ahead) {
    const double t = y[extras_];
    dy[extras_] = 1.0;
    const bool free = tree_.is_free();
    const Vec3 speed = free ? frame_.speed(t) : Vec3(Vec3::Zero());
    const Vec3 behind = free ? Vec3(Vec3::Zero()) : Vec3(0.5 * t * t * frame_.gravity);
    Vec3 center = Vec3::Zero(), moment = Vec3::Zero(), impulse = Vec3::Zero(), force = Vec3::Zero();
    double mass = 0.0;
    for (std::size_t i = 0; i < step_->island.size(); ++i) {
        const std::uint32_t index = step_->island[i];
        const Body& body = step_->bodies[index];
        const int node = tree_.node_of_body()[i];
        const ForwardDynamics::Link& link = dynamics_.link(node);
        const Mat3& rotation = link.rotation;
        const Vec3 velocity = link.center_velocity() + speed, place = link.position();
        const Vec3 at_scene = place + (free ? frame_.place(t) : tree_.origin());
        Wrench wrench = step_->forces.at(index, body, at_scene, {velocity, link.velocity.turn}, rotation, law_time_);
        wrench.force -= body.mass * frame_.gravity;
        pushes_[i] = wrench;
        dynamics_.apply(node, wrench);
        const Eigen::Index at = extras_ + 1 + pushed_numbers * Eigen::Index(i);
        const Vec3 about = (place - behind).cross(wrench.force) + wrench.torque;
        dy.segment<3>(at) = wrench.force;
        dy.segment<3>(at + 3) = about;
        dy[at + 6] = wrench.force.dot(velocity) + wrench.torque.dot(link.velocity.turn);
        mass += body.mass;
        center += body.mass * place;
        moment += place.cross(wrench.force) + wrench.torque;
        force += wrench.force;
        impulse += y.segment<3>(at) + ahead * wrench.force;
    }
    dy.segment<3>(y.size() - 6) = moment - (center / mass).cross(force);
    dy.segment<3>(y.size() - 3) = impulse / mass;
}

double TreeFlight::error_of(const Vector& difference, double scale) const {
    double worst = 0.0;
    for (const TreeNode& node : tree_.nodes()) {
        for (int k = 0; k < node.coordinates(); ++k)
            worst =
                std::max(worst, std::abs(difference[node.at + k]) / (is_length(node, k, false) ? step_->length : 1.0));
        for (int k = 0; k < node.speeds(); ++k)
            worst = std::max(worst, std::abs(difference[coordinates_ + node.speed_at + k]) /
                                        (scale * (is_length(node, k, true) ? step_->length : 1.0)));
    }
    return worst;
}

// Rate of change of the motion, 1/s: speeds, and roots of accelerations.
double TreeFlight::fastest(const Vector& y, const Vector& dy) const {
    double worst = std::max(springs_.fastest(), closures_.fastest());
    for (const TreeNode& node : tree_.nodes())
        for (int k = 0; k < node.speeds(); ++k) {
            const double unit = is_length(node, k, true) ? step_->length : 1.0;
            const Eigen::Index at = coordinates_ + node.speed_at + k;
            worst = std::max({worst, std::abs(y[at]) / unit, std::sqrt(std::abs(dy[at]) / unit)});
        }
    return worst;
}

// The change over h, from three results on until the error is rounding; returns the error in units of the tolerance.
// Two results in succession differ by the error of the former; that of the latter is smaller by as much again.
double TreeFlight::extrapolate(const Vector& first, double h, double scale, Vector& change) {
    using namespace extrapolation;
    constexpr auto table = [] {
        std::array<std::array<double, columns>, columns + 1> list{};
        for (std::size_t k = 1; k <= columns; ++k) list[k] = weights(k);
        return list;
    }();
    std::array<Vector, columns> results;
    double last = infinity, error = infinity;
    Vector before;
    for (std::size_t k = 0; k < columns; ++k) {
        results[k] = midpoint_change(y_, first, h, counts[k], [this](const Vector& y) { return rate(y); });
        before = change;
        change = Vector::Zero(y_.size());
        for (std::size_t i = 0; i <= k; ++i) change += table[k + 1][i] * results[i];
        if (k == 0) continue;
        const double now = error_of(change - before, scale);
        if (!std::isfinite(now)) return infinity;
        error = now * std::min(1.0, now / last) / tree_tolerance;
        last = now;
        if (k >= 2 && error <= 1.0) break;
    }
    return error;
}

void TreeFlight::normalize() {
    for (const TreeNode& node : tree_.nodes()) {
        if (node.kind == NodeKind::ball) y_.segment<4>(node.at).normalize();
        if (node.kind == NodeKind::free) y_.segment<4>(node.at + 3).normalize();
    }
}

std::vector<AppliedImpulse> TreeFlight::applied_impulses() const {
    std::vector<AppliedImpulse> list;
    if (pushed_ || !closures_.empty()) list.resize(step_->island.size());
    for (std::size_t i = 0; pushed_ && i < step_->island.size(); ++i) {
        const Eigen::Index at = extras_ + 1 + pushed_numbers * Eigen::Index(i);
        list[i] = {y_.segment<3>(at), y_.segment<3>(at + 3), y_[at + 6]};
    }
    if (!closures_.empty()) closures_.add_impulses(y_.data() + closed_ + 1, list);
    return list;
}

// After rate(y_).
void TreeFlight::sample() { account_->sample(dynamics_, time_, pushes_, applied_impulses()); }

bool TreeFlight::integrate(double until, IntegratorKind method) {
    const bool exact = method == IntegratorKind::exact;
    const double span = until - time_, begin = time_;
    double size = span, done = 0.0;
    for (bool fresh = true; done < span; fresh = false) {
        const Vector first = rate(y_);
        sample();
        const double scale = std::max(fastest(y_, first), account_->pendulum_rate());
        if (span * scale > tuning::tree_phase * step_->most_steps) return false;
        const double least = tuning::tree_phase / (scale * tuning::tree_shortest);
        if (fresh || !exact) size = span / std::max(1.0, std::ceil(span * scale / tuning::tree_phase));
        // Equal steps over the rest.
        const double rest = span - done;
        size = rest / std::ceil(rest / size * (1.0 - 1e-12));
        Vector change = Vector::Zero(y_.size());
        if (exact) {
            double error = extrapolate(first, size, scale, change), last = infinity;
            // An error that half a step does not make much smaller is rounding: of masses far apart.
            while (!(error <= 1.0) && !(error > 0.25 * last && error < tree_rounding)) {
                if (size < least) return false;
                last = error;
                size *= 0.5;
                error = extrapolate(first, size, scale, change);
            }
        } else {
            change = runge_kutta_4(y_, size, [this](const Vector& y) { return rate(y); }) - y_;
        }
        if (!change.allFinite()) return false;
        const double tried = size;
        if (events_possible() && !shorten_to_event({first, scale, method}, size, change)) return false;
        y_ += change;
        normalize();
        const bool last = size >= rest * (1.0 - 1e-12);
        done = last ? span : done + size;
        time_ = begin + done;
        if (!close(time_)) return false;
        const double turn = size * fastest_turn(y_);
        if (!exact && closures_.nearly_dependent(turn * turn)) return false;
        size = std::min(2.0 * tried, span);
        if (event_ == none) continue;
        if (event_ >= first_weak()) return true;
        if (!change_law()) return false;
    }
    time_ = until;
    return true;
}

// Places the bodies, with a rigid motion of a free tree that gives the whole its position and its momenta.
void TreeFlight::place() {
    const std::size_t n = step_->island.size();
    const double h = step_->h;
    const bool free = tree_.is_free();
    Vec3 shift = Vec3::Zero(), turn = Vec3::Zero(), center = Vec3::Zero(), push = Vec3::Zero();
    Vec3 wanted = Vec3::Zero(), moment = start_.angular_momentum, place = start_.center;
    inertias_.resize(n);
    if (free) {
        Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
        for (std::size_t i = 0; i < n; ++i) {
            const int at = tree_.node_of_body()[i];
            const ForwardDynamics::Link& link = dynamics_.link(at);
            const double mass = tree_.nodes()[std::size_t(at)].mass;
            center += mass * link.position();
            momentum += mass * link.center_velocity();
        }
        center /= start_.mass;
        const Vec3 mean = momentum / start_.mass;
        Sym3 inertia;
        for (std::size_t i = 0; i < n; ++i) {
            const int at = tree_.node_of_body()[i];
            const ForwardDynamics::Link& link = dynamics_.link(at);
            const TreeNode& node = tree_.nodes()[std::size_t(at)];
            const Sym3& own = inertias_[i] = node.inertia_at(link.rotation);
            const Vec3 arm = link.position() - center, carried = node.mass * arm;
            angular += own * link.velocity.turn + carried.cross(link.center_velocity() - mean);
            inertia += own;
            inertia.add_outer(-node.mass, arm);
            const double square = carried.dot(arm);
            inertia.xx += square;
            inertia.yy += square;
            inertia.zz += square;
        }
        if (pushed_) {
            for (std::size_t i = 0; i < n; ++i) wanted += y_.segment<3>(extras_ + 1 + pushed_numbers * Eigen::Index(i));
            moment += y_.segment<3>(y_.size() - 6);
            place += y_.tail<3>();
        }
        shift = place - center;
        turn = inertia.inverse() * Vec3(moment - angular);
        push = wanted / start_.mass - mean;
    }
    // The rounding of the momenta goes to the root.
    Vec3 left = start_.momentum + start_.mass * h * frame_.gravity + wanted, moment_left = moment;
    const Vec3 base = free ? frame_.place(h) : frame_.origin, speed = free ? frame_.speed(h) : Vec3(Vec3::Zero());
    const Vec3 drift = free ? Vec3(wanted / start_.mass + speed) : speed;
    // The rounding of the frame's position is the same in each step, and would add up.
    if (free) shift += h * (frame_.velocity + 0.5 * h * frame_.gravity) - (base - frame_.origin);
    for (std::size_t i = 0; i < n; ++i) {
        Body& body = step_->bodies[step_->island[i]];
        const int at = tree_.node_of_body()[i];
        const ForwardDynamics::Link& link = dynamics_.link(at);
        const Vec3 position = link.position();
        body.orientation = link.orientation.normalized();
        body.rotation = body.orientation.toRotationMatrix();
        body.position = base + (position + shift);
        if (!free) {
            body.momentum = body.mass * link.center_velocity();
            body.angular_momentum = tree_.nodes()[std::size_t(at)].inertia_at(link.rotation) * link.velocity.turn;
        } else {
            const Vec3 velocity = link.center_velocity() + push + turn.cross(position - center) + speed;
            body.momentum = body.mass * velocity;
            body.angular_momentum = inertias_[i] * Vec3(link.velocity.turn + turn);
            left -= body.momentum;
            moment_left -= body.angular_momentum + (position + shift - place).cross(body.momentum - body.mass * drift);
        }
        body.derive();
    }
    if (!free) return;
    Body& root = step_->bodies[step_->island[std::size_t(tree_.order().front().body)]];
    root.momentum += left;
    root.angular_momentum += moment_left;
    root.derive_velocities();
}

// Counts angles more than half a turn from the angles of the start, which the poses do not show.
void TreeFlight::count_turns() {
    for (const TreeNode& node : tree_.nodes())
        if (node.kind == NodeKind::revolute)
            step_->joints[std::size_t(node.joint)]->value[node.coordinate] += node.sign * y_[node.at];
}

TreeFlight::Outcome TreeFlight::fly(const TreeStep& step, TreeMethod method, int substeps) {
    own_.emplace(step);
    step_ = &*own_;
    event_ = none;
    coarse_ = strains_energy_ = false;
    phase_ = 0.0;
    if (!start(method.verlet() ? step.h / substeps : 0.0)) return Outcome::declined;
    if (method.order != order_ && method.verlet()) {
        order_ = method.order;
        stages_ = composition_stages(order_);
    }
    // The stages that go back would let a stiff spring grow.
    if (springs_.any_stiff() && method.order > 2) return Outcome::declined;
    const auto bounded = [&] { return springs_.within_bounds(y_.data(), y_.data() + coordinates_); };
    if (!bounded()) return Outcome::stopped;
    find_weak();
    const double end = step.from + step.h;
    for (double now = step.from; now < end;) {
        const double next = next_change(now);
        if (track() && !track()->smooth() && next < end) return Outcome::declined;  // an impulse of the carrier
        law_time_ = 0.5 * (now + next);
        const double until = next < end ? next - step.from : step.h;
        if (!(method.verlet() ? integrate_verlet(until, substeps) : integrate(until, method.kind)))
            return Outcome::declined;
        if (event_ != none) break;
        now = next;
    }
    if (!bounded()) return Outcome::stopped;
    if (event_ != none) own_->h = time_;
    carry(time_);
    if (!method.verlet() || !friction_.empty())
        rate(y_);
    else
        dynamics_.place(y_.data(), y_.data() + coordinates_);
    if (method.verlet() && substeps < tuning::joint_phase_substeps && !keeps_energy()) return Outcome::declined;
    if (!method.verlet()) sample();
    place();
    count_turns();
    if (track()) {
        const ForwardDynamics::Link& ground = dynamics_.link(TreeNode::ground);
        account_->carry(tree_.carrier(),
                        {tree_.origin() + ground.point - ground.rotation * tree_.carried_at(), ground.orientation});
    }
    if (!account_->finish(applied_impulses())) return Outcome::stopped;
    if (!closures_.finish(*own_, y_.data() + closed_ + 1)) return Outcome::stopped;
    if (lost_ > 0.0) step_->joints[std::size_t(std::max(0, tree_.hung()))]->account.step.work.impacts += lost_;
    springs_.account(*own_, y_.data(), y_.data() + heats_);
    friction_.account(*own_, dynamics_, y_.data(), y_.data() + works_);
    limits_.account(*own_, dynamics_);
    account_->give_work();
    return Outcome::flown;
}

// In more and more substeps, while they are too long.
TreeFlight::Outcome TreeFlight::advance_tree(const TreeStep& step, TreeMethod method, int& substeps) {
    last_error_ = infinity;
    for (;;) {
        const Outcome outcome = fly(step, method, substeps);
        if (outcome != Outcome::declined || !coarse_) return outcome;
        if (2 * substeps > (closures_.empty() ? tuning::joint_phase_substeps : closure_substeps))
            return Outcome::declined;
        const double phase = phase_ * substeps;
        do substeps *= 2;
        while (phase > tuning::joint_phase * substeps && substeps < tuning::joint_phase_substeps);
    }
}

}  // namespace tumble
