// TreeFlight: Verlet's method in joint coordinates, of second order and symmetric, and its compositions. With u the
// speeds and exp the rotation of a ball or a free root,
//   q' = q moved by h u/2,   u+ = u + h a(q', (u + u+)/2),   q+ = q' moved by h u+/2
// The speed of a free root is held in its own frame: it moves along a screw, which is exact for a tree that turns as a
// whole. The accelerations depend on the speeds by centrifugal and gyroscopic terms and dampers alone: passes that
// share the inertias of the middle find u+.
#include "core/deterministic_math.h"
#include "sim/articulation/settings.h"
#include "sim/articulation/tree_flight.h"
#include "sim/joints/settings.h"
#include "sim/math/keyframe_track.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Change of the speeds at the end of a stage of Verlet's method that ends its passes, as a share of the fastest one:
/// of second order, and in compositions. Related test:
/// Verlet.OrdersWithBallsAndFreeTrees; and rounding.
constexpr double verlet_tolerance = 1e-8;
constexpr double verlet_rounding = 1e-15;

/// Share of the last change above which a pass does not converge, and the change that is then rounding. Not fitted.
constexpr double verlet_contraction = 0.5;
constexpr double verlet_stall = 1e-11;

/// Passes beyond which the next step is tried with no fewer substeps. Not fitted: the number changes the cost alone.
constexpr int verlet_easy_passes = 10;

void turn_quaternion(double* q, const double* speed, double h) {
    const Quat turned = from_rotation_vector(h * Vec3(speed[0], speed[1], speed[2])) * Quat(q[3], q[0], q[1], q[2]);
    for (int k = 0; k < 4; ++k) q[k] = turned.coeffs()[k];
}

// A screw of constant angular velocity and velocity in the turning frame, for h seconds: the way of its point is V v h
// with V = 1 + B w* + C w* w* for the rotation vector w, B = (1 - cos |w|)/|w|^2 and C = (|w| - sin |w|)/|w|^3.
Vec3 way_of_screw(const double* speed, double h) {
    const Vec3 w = h * Vec3(speed[0], speed[1], speed[2]), v(speed[3], speed[4], speed[5]);
    const double square = w.squaredNorm();
    double b = 0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0 - square / 40320.0));
    double c = 1.0 / 6.0 - square * (1.0 / 120.0 - square * (1.0 / 5040.0 - square / 362880.0));
    if (square > 1e-3) {
        const double angle = std::sqrt(square);
        const auto [sine, cosine] = sincos(angle);
        b = (1.0 - cosine) / square;
        c = (angle - sine) / (square * angle);
    }
    const Vec3 across = w.cross(v);
    return h * (v + b * across + c * w.cross(across));
}

// Visits the first speed of each free root.
template <class Visit>
void each_free_root(const JointTree& tree, const Visit& visit) {
    for (const TreeNode& node : tree.nodes())
        if (node.kind == NodeKind::free) visit(node.speed_at);
}

// The velocity of a free root after such a screw, in the world.
void turn_velocity(double* speed, double h) {
    const Vec3 v = from_rotation_vector(h * Vec3(speed[0], speed[1], speed[2])) * Vec3(speed[3], speed[4], speed[5]);
    for (int k = 0; k < 3; ++k) speed[3 + k] = v[k];
}

}  // namespace

void TreeFlight::drift(double* coordinates, const double* speeds, double h) const {
    for (const TreeNode& node : tree_.nodes()) {
        double* q = coordinates + node.at;
        const double* u = speeds + node.speed_at;
        if (node.kind == NodeKind::revolute || node.kind == NodeKind::prismatic) q[0] += h * u[0];
        if (node.kind == NodeKind::ball) turn_quaternion(q, u, h);
        if (node.kind != NodeKind::free) continue;
        const Vec3 way = way_of_screw(u, h);
        for (int k = 0; k < 3; ++k) q[k] += way[k];
        turn_quaternion(q + 3, u, h);
    }
}

// Takes the rates of a pass over; returns the change of the speeds at the end, as a share of the fastest.
double TreeFlight::take_pass(const double* speeds, double h) {
    double change = 0.0, fastest = 0.0;
    each_free_root(tree_, [&](int at) {  // in its own frame
        const Vec3 turned = Vec3(mean_.segment<3>(at)).cross(Vec3(mean_.segment<3>(at + 3)));
        rates_.segment<3>(coordinates_ + at + 3) -= turned;
    });
    for (const TreeNode& node : tree_.nodes())
        for (int k = 0; k < node.speeds(); ++k) {
            const Eigen::Index at = node.speed_at + k;
            const double gained = h * rates_[coordinates_ + at], now = speeds[at] + gained;
            const double unit = node.is_length(k) ? 1.0 : step_->length;
            change = std::max(change, unit * std::abs(now - after_[at]));
            fastest = std::max({fastest, unit * std::abs(now), unit * std::abs(speeds[at])});
            after_[at] = now;
            mean_[at] = speeds[at] + 0.5 * gained;
        }
    return change > 0.0 ? change / fastest : change;
}

// Moves y by h seconds. With `counts` the forces of the stage, which begins at `time` (s, in the step), go to the
// account.
bool TreeFlight::stage(Vector& y, double h, double time, bool counts) {
    const double tolerance = stages_.size() == 1 ? verlet_tolerance : verlet_rounding;
    const Vec3 base = tree_.is_free() ? Vec3(Vec3::Zero()) : Vec3(-frame_.gravity);
    middle_ = y;
    double* speeds = middle_.data() + coordinates_;
    rates_.resize(y.size());
    drift(middle_.data(), speeds, 0.5 * h);
    each_free_root(tree_, [&](int at) { turn_velocity(speeds + at, 0.5 * h); });
    mean_ = after_ = middle_.segment(coordinates_, tree_.speeds());
    if (pushed_) middle_[extras_] += 0.5 * h;
    double last = infinity;
    for (int pass = 0;; ++pass) {
        if (pass == 0 && pushed_) carry(middle_[extras_]);
        if (pass == 0)
            dynamics_.move(middle_.data(), speeds);
        else
            dynamics_.set_speeds(mean_.data());
        springs_.drive_stage(dynamics_, y.data(), speeds, middle_.data(), h, pass == 0);
        friction_.drive(dynamics_);
        closures_.drive(dynamics_);
        if (pushed_) add_pushes(middle_, rates_, 0.5 * h);
        closures_.accelerate(dynamics_, base, middle_.data(), rates_.data() + coordinates_, pass > 0);
        ++evaluations_;
        const double change = take_pass(speeds, h);
        if (!std::isfinite(change)) return false;
        // The next pass would change them by less than this.
        const double next = pass == 0 ? change : change * std::min(1.0, change / last);
        if (next <= tolerance) {
            if (pass >= verlet_easy_passes) phase_ = std::max(phase_, tuning::joint_easy_phase);
            break;
        }
        if (pass > 1 && change > verlet_contraction * last) {
            if (change < verlet_stall) break;
            coarse_ = true;
            return false;
        }
        last = change;
    }
    if (counts) {
        account_->add_stage(dynamics_, time + 0.5 * h, h);
        if (!closures_.any_rows()) phase_ = std::max(phase_, std::abs(h) * account_->pendulum_rate());
    }
    if (!closures_.empty()) {
        y[closed_] += h;
        closures_.add_sums(dynamics_, frame_, time + 0.5 * h, h, y.data() + closed_ + 1);
    }
    if (heats_ < works_) springs_.heat_stage(y.data(), speeds, middle_.data(), after_.data(), h, y.data() + heats_);
    if (works_ < closed_) {
        friction_.find_powers(dynamics_, mean_.data(), rates_.data() + works_);
        y.segment(works_, closed_ - works_) += h * rates_.segment(works_, closed_ - works_);
    }
    if (pushed_) y.tail(y.size() - extras_) += h * rates_.tail(y.size() - extras_);
    y.head(coordinates_) = middle_.head(coordinates_);
    y.segment(coordinates_, tree_.speeds()) = after_;
    drift(y.data(), after_.data(), 0.5 * h);
    each_free_root(tree_, [&](int at) { turn_velocity(y.data() + coordinates_ + at, 0.5 * h); });
    return true;
}

bool TreeFlight::compose(Vector& y, double h, bool counts) {
    double time = time_;
    for (const double share : stages_) {
        if (!closed_stage(y, share * h, time, counts)) return false;
        time += share * h;
    }
    return true;
}

bool TreeFlight::integrate_verlet(double until, int substeps) {
    const double span = until - time_, begin = time_, longest = step_->h / substeps;
    double fastest = 0.0;  // 1/s
    for (const TreeNode& node : tree_.nodes())
        for (int k = 0; k < node.speeds(); ++k)
            fastest = std::max(
                fastest, std::abs(y_[coordinates_ + node.speed_at + k]) / (node.is_length(k) ? step_->length : 1.0));
    if (!(span * fastest <= tuning::tree_phase * tuning::tree_most_steps)) return false;
    for (double done = 0.0; done < span;) {
        const double rest = span - done;
        double size = rest / std::ceil(rest / longest * (1.0 - 1e-12));
        if (events_possible()) {
            const Vector first = rate(y_);
            const Part part{first, 0.0, IntegratorKind::symplectic_euler};
            Vector change = go(part, size);
            if (coarse_ || !change.allFinite() || !shorten_to_event(part, size, change)) return false;
        }
        if (!compose(y_, size, true)) return false;
        if (phase_ > tuning::joint_phase && substeps < tuning::joint_phase_substeps) {
            coarse_ = true;
            return false;
        }
        done = size >= rest * (1.0 - 1e-12) ? span : done + size;
        time_ = begin + done;
        if (event_ == none) continue;
        if (event_ >= first_weak()) return true;
        if (!change_law()) return false;
    }
    time_ = until;
    return true;
}

}  // namespace tumble
