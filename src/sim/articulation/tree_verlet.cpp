// TreeFlight: Verlet's method in joint coordinates, of second order and symmetric, and its compositions. With u the speeds
// and exp the rotation of a ball or a free root,
//   q' = q moved by h u/2,   u+ = u + h a(q', (u + u+)/2),   q+ = q' moved by h u+/2
// The accelerations depend on the speeds by centrifugal and gyroscopic terms and dampers alone: passes that share the
// inertias of the middle find u+.
#include "sim/articulation/settings.h"
#include "sim/articulation/tree_flight.h"
#include "sim/joints/settings.h"
#include "sim/math/keyframe_track.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

void turn_quaternion(double* q, const double* speed, double h) {
    const Quat turned = from_rotation_vector(h * Vec3(speed[0], speed[1], speed[2])) * Quat(q[3], q[0], q[1], q[2]);
    for (int k = 0; k < 4; ++k) q[k] = turned.coeffs()[k];
}

}  // namespace

void TreeFlight::drift(double* coordinates, const double* speeds, double h) const {
    for (const TreeNode& node : tree_.nodes()) {
        double* q = coordinates + node.at;
        const double* u = speeds + node.speed_at;
        if (node.kind == NodeKind::revolute || node.kind == NodeKind::prismatic) q[0] += h * u[0];
        if (node.kind == NodeKind::ball) turn_quaternion(q, u, h);
        if (node.kind != NodeKind::free) continue;
        for (int k = 0; k < 3; ++k) q[k] += h * u[3 + k];
        turn_quaternion(q + 3, u, h);
    }
}

// Takes the rates of a pass over; returns the change of the speeds at the end, as a share of the fastest.
double TreeFlight::take_pass(const double* speeds, double h) {
    double change = 0.0, fastest = 0.0;
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

// Moves y by h seconds. With `counts` the forces of the stage, which begins at `time` (s, in the step), go to the account.
bool TreeFlight::stage(Vector& y, double h, double time, bool counts) {
    const double tolerance = stages_.size() == 1 ? tuning::verlet_tolerance : tuning::verlet_rounding;
    const Vec3 base = tree_.is_free() ? Vec3(Vec3::Zero()) : Vec3(-frame_.gravity);
    double* speeds = y.data() + coordinates_;
    middle_ = y;
    rates_.resize(y.size());
    mean_ = after_ = y.segment(coordinates_, tree_.speeds());
    drift(middle_.data(), speeds, 0.5 * h);
    if (pushed_) middle_[extras_] += 0.5 * h;
    double last = infinity;
    for (int pass = 0;; ++pass) {
        if (pass == 0)
            dynamics_.move(middle_.data(), speeds);
        else
            dynamics_.set_speeds(mean_.data());
        springs_.drive_stage(dynamics_, y.data(), speeds, middle_.data(), h, pass == 0);
        friction_.drive(dynamics_);
        if (pushed_) add_pushes(middle_, rates_, 0.5 * h);
        if (pass == 0)
            dynamics_.accelerate(base, rates_.data() + coordinates_);
        else
            dynamics_.respond(base, rates_.data() + coordinates_);
        ++evaluations_;
        const double change = take_pass(speeds, h);
        if (!std::isfinite(change)) return false;
        // The next pass would change them by less than this.
        const double next = pass == 0 ? change : change * std::min(1.0, change / last);
        if (next <= tolerance) {
            if (pass >= tuning::verlet_easy_passes) swing_ = std::max(swing_, tuning::joint_easy_swing);
            break;
        }
        if (pass > 1 && change > tuning::verlet_contraction * last) {
            if (change < tuning::verlet_stall) break;
            coarse_ = true;
            return false;
        }
        last = change;
    }
    if (counts) {
        account_->add_stage(dynamics_, time + 0.5 * h, h);
        swing_ = std::max(swing_, std::abs(h) * account_->swing_rate());
    }
    if (heats_ < extras_) springs_.heat_stage(y.data(), speeds, middle_.data(), after_.data(), h, y.data() + heats_);
    if (pushed_) y.tail(y.size() - extras_) += h * rates_.tail(y.size() - extras_);
    y.head(coordinates_) = middle_.head(coordinates_);
    y.segment(coordinates_, tree_.speeds()) = after_;
    drift(y.data(), speeds, 0.5 * h);
    return true;
}

bool TreeFlight::compose(Vector& y, double h, bool counts) {
    double time = time_;
    for (const double share : stages_) {
        if (!stage(y, share * h, time, counts)) return false;
        time += share * h;
    }
    return true;
}

bool TreeFlight::integrate_verlet(double until, int substeps) {
    const double span = until - time_, begin = time_, longest = step_->h / substeps;
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
        if (swing_ > tuning::joint_swing && substeps < tuning::joint_swing_substeps) {
            coarse_ = true;
            return false;
        }
        done = size >= rest * (1.0 - 1e-12) ? span : done + size;
        time_ = begin + done;
        if (event_ == none) continue;
        if (event_ >= friction_.count()) return true;
        if (!change_friction()) return false;
    }
    time_ = until;
    return true;
}

}  // namespace tumble
