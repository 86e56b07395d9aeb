// TreeFlight: steps that keep closure rows g(q) = 0. All methods keep them by their accelerations, and project the
// rest. In a stage of Verlet's method that is symmetric too:
//   u' = u + M^-1 G^T l at its start, such that g = 0 at its end, and u+ = u' + M^-1 G^T m there, such that G u+ = 0,
// as in RATTLE (Andersen 1983; Hairer, Lubich, Wanner, Geometric Numerical Integration, section VII.1.4). So the stage
// has second order, and compositions have theirs; and a mechanism at rest stays so, for l = m = 0.
#include "sim/articulation/settings.h"
#include "sim/articulation/tree_flight.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Largest energy of the impulses at one end of a stage, as a share of the kinetic one: in singular positions they
/// would be impulses, where a mechanism can move to first order alone. Not fitted: of fourth order in the step
/// elsewhere.
constexpr double closure_energy = 0.01;

/// Compliance of a flight's rows over that of a body, in units of the fourth power of the largest relative turn in the
/// stage: four-bars that lie flat twice a turn pass from 0.1 on. Related test:
/// JointReference.AFourBarPassesItsSingularPosition.
constexpr double joint_singular = 0.2;

}  // namespace

// rad/s
double TreeFlight::fastest_turn(const Vector& y) const {
    double fastest = 0.0;
    for (const TreeNode& node : tree_.nodes())
        for (int k = 0; k < node.speeds(); ++k)
            if (!node.is_length(k)) fastest = std::max(fastest, std::abs(y[coordinates_ + node.speed_at + k]));
    return fastest;
}

// At rest at the coordinates y, for impulses.
void TreeFlight::move_still(const Vector& y) {
    const std::vector<double> still(std::size_t(tree_.speeds()), 0.0);
    dynamics_.move(y.data(), still.data());
    friction_.hold(dynamics_);
    limits_.drive(dynamics_, still.data());
}

// J: most of the impulses at one end of a stage of `h` s, after it. Gaps that are rounding may close.
double TreeFlight::most_energy(double h) const {
    double sum = 0.0, mass = 0.0;
    for (std::size_t i = 0; i < tree_.nodes().size(); ++i) {
        const TreeNode& node = tree_.nodes()[i];
        if (node.body == TreeNode::no_body) continue;
        const ForwardDynamics::Link& link = dynamics_.link(int(i));
        const Vec3& w = link.velocity.turn;
        mass += node.mass;
        sum += node.mass * link.center_velocity().squaredNorm() + w.dot(node.inertia_at(link.rotation) * w);
    }
    const double speed = tuning::joint_rounding * step_->length / h;
    return 0.5 * closure_energy * sum + mass * speed * speed;
}

// Impulses of the rows at the coordinates `at`, and their mean speeds: adds them to the account and to the sums of y.
void TreeFlight::give_impulses(const Vector& at, Vector& y, const std::vector<double>& impulses, const Vector& mean,
                               double time) {
    move_still(at);
    closures_.linearize(dynamics_, at.data());
    closures_.give(closures_.shared(impulses), false);
    closures_.apply(dynamics_);
    std::vector<double> change(std::size_t(tree_.speeds()));
    dynamics_.accelerate(Vec3::Zero(), change.data());
    std::vector<Wrench> wrenches(step_->island.size());
    closures_.add_to(dynamics_, wrenches);
    account_->strike(dynamics_, time, wrenches);
    dynamics_.place(at.data(), mean.data() + coordinates_);
    closures_.add_sums(dynamics_, frame_, time, 1.0, y.data() + closed_ + 1);
}

// The matrices at the coordinates y.
void TreeFlight::linearize_closures(const Vector& y) {
    move_still(y);
    std::vector<double> change(std::size_t(tree_.speeds()));
    dynamics_.accelerate(Vec3::Zero(), change.data());
    closures_.prepare(dynamics_, y.data());
}

// Returns the energy of the impulses.
double TreeFlight::fit_closures(Vector& y, double time, bool counts) {
    linearize_closures(y);
    const Vector before = y;
    double* speeds = y.data() + coordinates_;
    std::vector<double> sum(closures_.rows(), 0.0);
    for (int pass = 0; pass < 2; ++pass) {
        std::vector<double> side = closures_.speeds_of(speeds);
        for (double& x : side) x = -x;
        const std::vector<double> impulses = closures_.solve(side);
        closures_.add_response(impulses, speeds);
        for (std::size_t r = 0; r < sum.size(); ++r) sum[r] += impulses[r];
    }
    if (counts) give_impulses(before, y, sum, 0.5 * (before + y), time);
    fitted_ = y.head(coordinates_);
    return closures_.energy_of(sum);
}

bool TreeFlight::closed_stage(Vector& y, double h, double time, bool counts) {
    if (!closures_.any_rows()) return stage(y, h, time, counts);
    const double turn = std::abs(h) * fastest_turn(y), closed = closures_.place_rounding();
    closures_.set_compliance(joint_singular * turn * turn * turn * turn);
    if (fitted_.size() != coordinates_ || fitted_ != y.head(coordinates_)) linearize_closures(y);
    at_start_ = closures_;
    if (counts) account_->begin_stage();
    std::vector<double> impulses(closures_.rows(), 0.0);
    Vector start, end;
    double last = infinity;
    for (int pass = 0;; ++pass) {
        start = y;
        at_start_.add_response(impulses, start.data() + coordinates_);
        end = start;
        if (counts) account_->restart_stage();
        if (!stage(end, h, time, counts)) return false;
        dynamics_.place(end.data(), end.data() + coordinates_);
        closures_.linearize_forms(dynamics_, end.data());
        const double error = closures_.error();
        if (error <= closed || (error < tuning::joint_rounding && error >= 0.5 * last)) break;
        if (!std::isfinite(error) || pass == tuning::closure_passes || (pass > 4 && error >= 0.9 * last)) {
            // In a singular position the gap along the vanishing row closes slowly, and by itself when that is passed.
            if (error < tuning::joint_flight_open) break;
            coarse_ = true;
            phase_ = std::max(phase_, tuning::joint_easy_phase);
            return false;
        }
        last = error;
        std::vector<double> side = closures_.errors();
        for (double& x : side) x /= -h;
        const std::vector<double> more = at_start_.solve(side, closures_);
        for (std::size_t r = 0; r < more.size(); ++r) impulses[r] += more[r];
    }
    const double most = most_energy(h);
    if (at_start_.energy_of(impulses) > most) {
        coarse_ = true;
        phase_ = std::max(phase_, tuning::joint_easy_phase);
        return false;
    }
    if (counts) {
        closures_ = at_start_;
        give_impulses(y, end, impulses, 0.5 * (y + start), time);
    }
    y = end;
    if (fit_closures(y, time + h, counts) > most) {
        coarse_ = true;
        phase_ = std::max(phase_, tuning::joint_easy_phase);
        return false;
    }
    if (counts) phase_ = std::max(phase_, std::abs(h) * account_->pendulum_rate(h));
    closures_.set_compliance(0.0);
    return true;
}

// After a step of a method that keeps the rows by their accelerations.
bool TreeFlight::close(double time) {
    if (!closures_.any_rows()) return true;
    std::vector<double> change(std::size_t(tree_.speeds()));
    double last = infinity;
    for (int pass = 0; pass < tuning::closure_passes; ++pass) {
        move_still(y_);
        closures_.linearize(dynamics_, y_.data());
        const double error = closures_.error();
        if (!(error < tuning::joint_flight_open)) return false;
        if (error <= closures_.place_rounding() || error >= 0.5 * last) break;
        last = error;
        dynamics_.accelerate(Vec3::Zero(), change.data());
        closures_.prepare(dynamics_, y_.data());
        std::vector<double> side = closures_.errors();
        for (double& x : side) x = -x;
        std::fill(change.begin(), change.end(), 0.0);
        closures_.add_response(closures_.solve(side), change.data());
        drift(y_.data(), change.data(), 1.0);
    }
    fit_closures(y_, time, true);
    return true;
}

}  // namespace tumble
