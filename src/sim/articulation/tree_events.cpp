// TreeFlight: the moments in a step in which the friction of a joint changes, or a joint breaks. The motion is smooth
// between them, so that the integrator keeps its order.
#include "sim/articulation/settings.h"
#include "sim/articulation/tree_flight.h"
#include "sim/dynamics/integrators/runge_kutta_4.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

bool TreeFlight::begin_friction() {
    double fastest = 0.0;
    for (const std::uint32_t i : step_->island) {
        const Body& body = step_->bodies[i];
        fastest = std::max({fastest, body.velocity.norm(), step_->length * body.angular_velocity.norm()});
    }
    changes_ = 0;
    friction_.begin(y_.data() + coordinates_, fastest, step_->length);
    return settle_friction();
}

// Which of the coordinates at rest are held, and where the others go: a linear complementarity problem, by pivoting all
// that are wrong, then the first of them alone (Murty 1974).
bool TreeFlight::settle_friction() {
    const int together = 10, most = together + 4 * int(friction_.count());
    for (int round = 0; round < most; ++round) {
        const Vector first = rate(y_);
        if (!friction_.revise(dynamics_, y_.data() + coordinates_, first.data() + coordinates_, round >= together))
            return true;
    }
    return false;
}

// Joints that carry more at the start of the step break by their mean load, at its end.
void TreeFlight::find_weak() {
    weak_.clear();
    for (std::size_t k = 0; k < step_->joints.size(); ++k) {
        const JointDescription& strength = step_->joints[k]->description;
        if (strength.break_force == infinity && strength.break_torque == infinity) continue;
        if (weak_.empty()) rate(y_);
        if (account_->load_of(dynamics_, int(k), pushes_) < 1.0) weak_.push_back(int(k));
    }
}

// After rate(y).
double TreeFlight::excess(std::size_t event, const Vector& y) {
    if (event < friction_.count()) return friction_.excess(event, dynamics_, y.data() + coordinates_);
    return account_->load_of(dynamics_, weak_[event - friction_.count()], pushes_) - 1.0;
}

double TreeFlight::excess_at(std::size_t event, const Vector& y) {
    rate(y);
    return excess(event, y);
}

double TreeFlight::unit_of(std::size_t event) const {
    return event < friction_.count() ? friction_.unit(event, y_.data() + coordinates_) : 1.0;
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
    for (std::size_t k = friction_.count(); k < events(); ++k) {
        const double near = tuning::tree_near_break - 1.0, before = excess_at(k, y_), after = excess_at(k, end);
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
    const Vector end = y_ + change, end_rate = rate(end);
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
bool TreeFlight::change_friction() {
    if (++changes_ > tuning::tree_most_events) return false;
    rate(y_);
    sample();
    friction_.change(event_, y_.data(), y_.data() + coordinates_, needed_);
    event_ = none;
    return settle_friction();
}

}  // namespace tumble
