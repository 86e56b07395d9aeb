// TreeFlight: the moments in a step in which a limit is met or left, the friction of a joint changes, or a joint
// breaks. The motion is smooth between them, so that the integrator keeps its order.
#include "sim/articulation/settings.h"
#include "sim/articulation/tree_flight.h"
#include "sim/dynamics/integrators/runge_kutta_4.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// Load over strength of a joint at both ends of a part of a step, above which its largest load between them is looked
/// for. Not fitted: a part is half a radian of the motion.
constexpr double tree_near_break = 0.8;

}  // namespace

bool TreeFlight::begin_laws() {
    double fastest = 0.0;
    for (const std::uint32_t i : step_->island) {
        const Body& body = step_->bodies[i];
        fastest = std::max({fastest, body.velocity.norm(), step_->length * body.angular_velocity.norm()});
    }
    changes_ = 0;
    friction_.begin(y_.data() + coordinates_, fastest, step_->length);
    limits_.begin(dynamics_, y_.data() + coordinates_, fastest, step_->length);
    return strike_all() && settle();
}

// Which of the coordinates at rest are held, and where the others go: a linear complementarity problem, by pivoting all
// that are wrong, then the first of them alone (Murty 1974).
bool TreeFlight::settle() {
    const int together = 10, most = together + 4 * int(first_weak());
    const double* speeds = y_.data() + coordinates_;
    for (int round = 0; round < most; ++round) {
        const Vector first = rate(y_);
        const double* rates = first.data() + coordinates_;
        const bool one = round >= together;
        bool any = friction_.revise(dynamics_, speeds, rates, one);
        if (!any || !one)
            any = limits_.revise(dynamics_, y_.data(), speeds, rates, std::size_t(tree_.speeds()), one) || any;
        if (!any) return !limits_.holds_twice();
    }
    return false;
}

// The impact of a coordinate on its limit. Returns false where it does not approach it.
bool TreeFlight::strike(std::size_t limit) {
    rate(y_);
    sample();
    Vector first;
    const auto rates = [&] {
        first = rate(y_);
        return static_cast<const double*>(first.data() + coordinates_);
    };
    double* speeds = y_.data() + coordinates_;
    const double whole = step_->whole > 0.0 ? step_->whole : step_->h;
    const TreeLimits::Impact impact =
        limits_.strike(limit, dynamics_, y_.data(), speeds, std::size_t(tree_.speeds()), whole, rates);
    if (!(impact.approach > 0.0)) return false;
    std::vector<Wrench> wrenches;
    if (!closures_.empty()) {
        wrenches.resize(step_->island.size());
        closures_.add_to(dynamics_, wrenches);
        closures_.add_sums(dynamics_, frame_, time_, 1.0, y_.data() + closed_ + 1);
    }
    account_->strike(dynamics_, time_, wrenches);
    friction_.strike(y_.data(), speeds);
    return true;
}

// An impact may send other coordinates at their limits beyond.
bool TreeFlight::strike_all() {
    for (std::size_t k = 0; k < limits_.count(); ++k) {
        if (k == 0) dynamics_.move(y_.data(), y_.data() + coordinates_);
        if (!limits_.strikes(k, dynamics_, y_.data(), y_.data() + coordinates_)) continue;
        if (++changes_ > tuning::tree_most_events || !strike(k)) return false;
        k = std::size_t(-1);
    }
    return true;
}

// Joints that carry more at the start of the step break by their mean load, at its end.
void TreeFlight::find_weak() {
    weak_.clear();
    for (std::size_t k = 0; k < step_->joints.size(); ++k) {
        const JointDescription& strength = step_->joints[k]->description;
        if (strength.break_force == infinity && strength.break_torque == infinity) continue;
        if (weak_.empty()) rate(y_);
        if (load_of(int(k)) < 1.0) weak_.push_back(int(k));
    }
}

// Over its strength, after rate().
double TreeFlight::load_of(int joint) {
    return tree_.hangs(joint) ? account_->load_of(dynamics_, joint, pushes_) : closures_.load_of(joint);
}

// After rate(y).
double TreeFlight::excess(std::size_t event, const Vector& y) {
    if (event < friction_.count()) return friction_.excess(event, dynamics_, y.data() + coordinates_);
    if (event < first_weak()) return limits_.excess(event - friction_.count(), dynamics_, y.data());
    return load_of(weak_[event - first_weak()]) - 1.0;
}

double TreeFlight::excess_at(std::size_t event, const Vector& y) {
    rate(y);
    return excess(event, y);
}

double TreeFlight::unit_of(std::size_t event) const {
    if (event < friction_.count()) return friction_.unit(event, y_.data() + coordinates_);
    return event < first_weak() ? limits_.unit(event - friction_.count()) : 1.0;
}

// The change of y over s seconds.
TreeFlight::Vector TreeFlight::go(const Part& part, double s) {
    if (part.method == IntegratorKind::runge_kutta_4)
        return runge_kutta_4(y_, s, [this](const Vector& y) { return rate(y); }) - y_;
    if (part.method != IntegratorKind::exact) {
        Vector end = y_;
        if (!compose(end, s, false)) end.setConstant(infinity);
        return end - y_;
    }
    Vector change = Vector::Zero(y_.size());
    extrapolate(part.first, s, part.scale, change);
    return change;
}

// An event that begins and ends within the part, and shows at neither end: then the part is shortened to its middle.
std::size_t TreeFlight::event_within(const Part& part, const Vector& end, const Vector& end_rate, double& size,
                                     Vector& change) {
    const auto happens = [&](std::size_t event, double share) {
        const Vector there = go(part, share * size);
        if (!(excess_at(event, y_ + there) > 0.0)) return false;
        size *= share;
        change = there;
        return true;
    };
    const Eigen::Index speeds = coordinates_;
    for (std::size_t k = 0; k < friction_.count(); ++k) {
        const double share = friction_.turns_back_at(k, y_.data() + speeds, part.first.data() + speeds,
                                                     end.data() + speeds, end_rate.data() + speeds, size);
        if (share > 0.0 && happens(k, share)) return k;
    }
    for (std::size_t k = 0; k < limits_.count(); ++k) {
        const double share = limits_.passes_at(k, y_.data(), y_.data() + speeds, end.data(), end.data() + speeds, size);
        if (share > 0.0 && happens(friction_.count() + k, share)) return friction_.count() + k;
    }
    for (std::size_t k = first_weak(); k < events(); ++k) {
        const double near = tree_near_break - 1.0, before = excess_at(k, y_), after = excess_at(k, end);
        if (before < near || after < near) continue;
        const double middle = excess_at(k, y_ + go(part, 0.5 * size));
        const double bend = 2.0 * (before + after - 2.0 * middle), slope = 4.0 * middle - 3.0 * before - after;
        const double share = bend < 0.0 ? -0.5 * slope / bend : 0.0;
        if (share > 0.0 && share < 1.0 && before + share * (slope + share * bend) > 0.0 && happens(k, share)) return k;
    }
    return none;
}

// The first in the list that has happened at the end of the part, or before.
std::size_t TreeFlight::first_event(const Part& part, double& size, Vector& change) {
    const Vector end = y_ + change;
    Vector end_rate;
    if (!friction_.empty() || !weak_.empty() || limits_.needs_rates()) end_rate = rate(end);
    for (std::size_t k = 0; k < events(); ++k)
        if (k != event_ && excess(k, end) > 0.0) return k;
    return event_ == none ? event_within(part, end, end_rate, size, change) : none;
}

// The zero of an excess by the rule of false position (Illinois; Dowell and Jarratt 1971).
bool TreeFlight::locate(const Part& part, std::size_t event, double& size, Vector& change) {
    const double unit = unit_of(event), shortest = 4.0 * std::numeric_limits<double>::epsilon() * size;
    double low = 0.0, at_low = excess_at(event, y_), at_high = excess_at(event, y_ + change);
    // A coordinate that leaves its rest and comes back to it in the same part.
    for (int halving = 0; at_low >= 0.0 && halving < 20; ++halving) {
        const Vector there = go(part, 0.5 * size);
        const double now = excess_at(event, y_ + there);
        if (now < 0.0) {
            low = 0.5 * size;
            at_low = now;
        } else {
            size *= 0.5;
            at_high = now;
            change = there;
        }
    }
    int side = 0;
    for (int trial = 0; trial < tuning::tree_most_trials; ++trial) {
        if (!(at_low < 0.0) || size - low <= shortest || at_high <= tuning::tree_event_located * unit) return true;
        double s = size - (size - low) * at_high / (at_high - at_low);
        if (!(s > low && s < size)) s = 0.5 * (low + size);
        const Vector there = go(part, s);
        const double now = excess_at(event, y_ + there);
        if (now >= 0.0) {
            size = s;
            at_high = now;
            change = there;
            if (side == 1) at_low *= 0.5;
            side = 1;
        } else {
            low = s;
            at_low = now;
            if (side == -1) at_high *= 0.5;
            side = -1;
        }
    }
    return false;
}

// Shortens a part of the step to the first event in it. Returns false where it is not found.
bool TreeFlight::shorten_to_event(const Part& part, double& size, Vector& change) {
    event_ = none;
    for (std::size_t k = 0; k <= events(); ++k) {
        const std::size_t next = first_event(part, size, change);
        if (next == none) {
            if (event_ < friction_.count()) {
                rate(y_ + change);
                needed_ = friction_.net(event_, dynamics_);
            }
            return true;
        }
        if (!locate(part, next, size, change)) return false;
        event_ = next;
    }
    return false;
}

// After the part that ends with it.
bool TreeFlight::change_law() {
    if (++changes_ > tuning::tree_most_events) return false;
    const std::size_t event = event_, limit = event - friction_.count();
    event_ = none;
    if (event < friction_.count()) {
        rate(y_);
        sample();
        friction_.change(event, y_.data(), y_.data() + coordinates_, needed_);
    } else if (limits_.held(limit)) {
        rate(y_);
        sample();
        limits_.let_go(limit);
    } else if (!strike(limit) || !strike_all()) {
        return false;
    }
    return settle();
}

}  // namespace tumble
