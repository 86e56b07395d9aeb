// TreeFlight: the moments in a step in which the friction of a joint changes. The motion is smooth between them, so that
// the integrator keeps its order.
#include "sim/articulation/settings.h"
#include "sim/articulation/tree_flight.h"
#include "sim/dynamics/integrators/runge_kutta_4.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

double TreeFlight::fastest_body() const {
    double fastest = 0.0;
    for (const std::uint32_t i : step_->island) {
        const Body& body = step_->bodies[i];
        fastest = std::max({fastest, body.velocity.norm(), step_->length * body.angular_velocity.norm()});
    }
    return fastest;
}

bool TreeFlight::begin_friction() {
    changes_ = 0;
    changing_ = TreeFriction::none;
    friction_.begin(y_.data() + coordinates_, fastest_body(), step_->length);
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

double TreeFlight::excess_at(std::size_t friction, const Vector& y) {
    rate(y);
    return friction_.excess(friction, dynamics_, y.data() + coordinates_);
}

// Shortens a part of the step to the first change of friction in it: the zero of an excess, by the rule of false position
// (Illinois; Dowell and Jarratt 1971). Returns false where it is not found.
bool TreeFlight::shorten_to_change(const Vector& first, double scale, bool exact, double& size, Vector& change) {
    changing_ = TreeFriction::none;
    const auto go = [&](double s) {
        Vector moved = Vector::Zero(y_.size());
        if (exact)
            extrapolate(first, s, scale, moved);
        else
            moved = runge_kutta_4(y_, s, [this](const Vector& y) { return rate(y); }) - y_;
        return moved;
    };
    const double* speeds = y_.data() + coordinates_;
    for (int trial = 0; trial < tuning::friction_most_trials; ++trial) {
        Vector end = y_ + change;
        const Vector end_rate = rate(end);
        std::size_t next = friction_.first_beyond(dynamics_, end.data() + coordinates_, changing_);
        for (std::size_t k = 0; next == TreeFriction::none && changing_ == TreeFriction::none && k < friction_.count();
             ++k) {
            const double share =
                friction_.turns_back_at(k, speeds, first.data() + coordinates_, end.data() + coordinates_,
                                        end_rate.data() + coordinates_, size);
            if (share == 0.0) continue;
            const Vector there = go(share * size);
            if (!(excess_at(k, y_ + there) > 0.0)) continue;
            size *= share;
            change = there;
            next = k;
        }
        if (next == TreeFriction::none) {
            if (changing_ != TreeFriction::none) {
                excess_at(changing_, end);
                needed_ = friction_.net(changing_, dynamics_);
            }
            return true;
        }
        const double unit = friction_.unit(next, speeds);
        double low = 0.0, high = size, at_low = excess_at(next, y_), at_high = excess_at(next, y_ + change);
        // It comes back to rest in the same part.
        for (int halving = 0; at_low >= 0.0 && halving < 20; ++halving) {
            const Vector there = go(0.5 * high);
            const double now = excess_at(next, y_ + there);
            if (now < 0.0) {
                low = 0.5 * high;
                at_low = now;
            } else {
                high *= 0.5;
                at_high = now;
                change = there;
            }
        }
        int side = 0;
        while (at_low < 0.0 && high - low > 4.0 * std::numeric_limits<double>::epsilon() * size &&
               !(at_high <= tuning::friction_located * unit)) {
            double s = high - (high - low) * at_high / (at_high - at_low);
            if (!(s > low && s < high)) s = 0.5 * (low + high);
            const Vector there = go(s);
            const double now = excess_at(next, y_ + there);
            ++trial;
            if (now >= 0.0) {
                high = s;
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
            if (trial > tuning::friction_most_trials) return false;
        }
        size = high;
        changing_ = next;
        // Others that change before it.
    }
    return false;
}

// After the part that ends with it.
bool TreeFlight::change_friction() {
    if (++changes_ > tuning::friction_most_changes) return false;
    rate(y_);
    sample();
    friction_.change(changing_, y_.data(), y_.data() + coordinates_, needed_);
    changing_ = TreeFriction::none;
    return settle_friction();
}

}  // namespace tumble
