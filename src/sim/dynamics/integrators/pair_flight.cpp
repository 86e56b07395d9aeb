#include "sim/dynamics/integrators/pair_flight.h"

#include "core/error.h"
#include "sim/dynamics/integrators/extrapolation.h"
#include "sim/dynamics/integrators/runge_kutta_4.h"
#include "sim/dynamics/integrators/splitting.h"
#include "sim/math/free_rotation.h"
#include "sim/math/keyframe_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// As of one body (advance.cpp): phase, rad, of one step of the tenth-order extrapolation; most steps in a span.
constexpr double pair_phase = 0.2;
constexpr int most_pair_steps = 200000;

constexpr Eigen::Index numbers = 14;  // of a state

}  // namespace

// Those that do not fly, at a time.
void PairFlight::place_others(double time) {
    const auto index = forces_->pairs().bodies();
    for (std::size_t k = 0; k < members_.size(); ++k) {
        if (members_[k].flies) continue;
        const Body& body = (*bodies_)[index[k]];
        const Member& m = members_[k];
        points_[k] = {pair_mass(body), m.start.position + (time - start_) * m.velocity.velocity, m.velocity.velocity};
        if (!turns_of_.empty())
            turns_of_[k].rotation =
                from_rotation_vector((time - start_) * m.velocity.angular_velocity).toRotationMatrix() *
                rotation_of(m.start.orientation);
    }
}

// The points of the present states, and the forces between them.
void PairFlight::gather() {
    for (const std::size_t k : flying_) {
        points_[k] = {points_[k].mass, states_[k].position, masses_[k].inverse_mass * states_[k].momentum};
        if (!turns_of_.empty()) turns_of_[k].rotation = rotation_of(states_[k].orientation);
    }
    std::fill(pulls_.begin(), pulls_.end(), Wrench());
    forces_->pairs().add(present(), middle_, pulls_);
}

// The rate of change of all states that fly, and of the time, the last number.
Eigen::VectorXd PairFlight::rates(const Eigen::VectorXd& y) {
    const auto index = forces_->pairs().bodies();
    for (std::size_t n = 0; n < flying_.size(); ++n) {
        const auto state = y.segment<numbers>(numbers * Eigen::Index(n));
        MassPoint& point = points_[flying_[n]];
        point.position = state.head<3>();
        point.velocity = masses_[flying_[n]].inverse_mass * state.segment<3>(7);
        if (!turns_of_.empty()) turns_of_[flying_[n]].rotation = rotation_of(Quat(state.segment<4>(3)));
    }
    place_others(y[y.size() - 1]);
    std::fill(pulls_.begin(), pulls_.end(), Wrench());
    forces_->pairs().add(present(), middle_, pulls_);
    Eigen::VectorXd rate(y.size());
    for (std::size_t n = 0; n < flying_.size(); ++n) {
        const std::size_t k = flying_[n];
        const auto law = [&](const FlightPoint& at_point) {
            return forces_->in_flight(index[k], (*bodies_)[index[k]], at_point, {middle_, span_start_}, pulls_[k]);
        };
        const Eigen::Index at = numbers * Eigen::Index(n);
        rate.segment<numbers>(at) = rate_of_change(StateVector(y.segment<numbers>(at)), masses_[k], ForceLaw(law));
    }
    rate[y.size() - 1] = 1.0;
    return rate;
}

void PairFlight::step(const Span& span, bool exact) {
    Eigen::VectorXd y(numbers * Eigen::Index(flying_.size()) + 1);
    for (std::size_t n = 0; n < flying_.size(); ++n)
        y.segment<numbers>(numbers * Eigen::Index(n)) = vector_of(states_[flying_[n]]);
    y[y.size() - 1] = span.from;
    const double h = span.to - span.from;
    const auto rate = [&](const Eigen::VectorXd& at) { return rates(at); };
    if (exact) {
        using namespace extrapolation;
        constexpr std::array<double, columns> weight = weights(columns);
        const Eigen::VectorXd first = rate(y);
        Eigen::VectorXd change = Eigen::VectorXd::Zero(y.size());
        for (std::size_t k = 0; k < columns; ++k) change += weight[k] * midpoint_change(y, first, h, counts[k], rate);
        y += change;
    } else {
        y = runge_kutta_4(y, h, rate);
    }
    for (std::size_t n = 0; n < flying_.size(); ++n)
        states_[flying_[n]] = state_of(StateVector(y.segment<numbers>(numbers * Eigen::Index(n))));
}

// As splitting_step(): the midpoint rule for forces that depend on velocities.
void PairFlight::kick(double h, double time) {
    const auto index = forces_->pairs().bodies();
    place_others(time);
    gather();
    const std::vector<RigidState> before = states_;
    for (const double share : {0.5, 1.0}) {
        for (const std::size_t k : flying_) {
            const RigidState& s = states_[k];
            const Vec3 velocity = masses_[k].inverse_mass * s.momentum;
            const Mat3 rotation = rotation_of(s.orientation);
            const Wrench wrench = forces_->in_flight(index[k], (*bodies_)[index[k]],
                                                     {s.position, velocity, s.angular_momentum, rotation, s.elapsed},
                                                     {middle_, span_start_}, pulls_[k]);
            RigidState& next = states_[k];
            next.momentum = before[k].momentum + share * h * wrench.force;
            next.angular_momentum = before[k].angular_momentum + share * h * wrench.torque;
        }
        if (share < 1.0) gather();
    }
}

void PairFlight::split(const Span& span) {
    const double h = span.to - span.from;
    kick(0.5 * h, span.from);
    for (const std::size_t k : flying_) free_drift(states_[k], masses_[k], h);
    kick(0.5 * h, span.to);
}

// Fastest rate at which the motion of the present states changes, 1/s.
double PairFlight::rate() const {
    const auto index = forces_->pairs().bodies();
    double fastest = forces_->pairs().rate(present(), middle_);
    for (const std::size_t k : flying_) {
        const Body& body = (*bodies_)[index[k]];
        const Mat3 attitude = rotation_of(states_[k].orientation);
        double own = forces_->field_rate(index[k], body,
                                         {points_[k].position, points_[k].velocity, states_[k].angular_momentum,
                                          attitude, states_[k].elapsed},
                                         middle_) +
                     forces_->drag_rate(body) * (points_[k].velocity - forces_->wind()).norm();
        const double most = 1.0 / masses_[k].principal_inertia.minCoeff();
        if (turns_) own += states_[k].angular_momentum.norm() * most;
        fastest = std::max(fastest, own);
    }
    return fastest;
}

void PairFlight::exact(const Span& span) {
    double now = span.from;
    for (int step_count = 0; now < span.to; ++step_count) {
        if (step_count == most_pair_steps)
            throw RunError(
                fmt::format("the motion of bodies with forces between each other from t = {:.6g} s to "
                            "{:.6g} s needs more than {} steps: give them a softening, or less strength",
                            span.from, span.to, most_pair_steps));
        place_others(now);
        gather();
        const double rest = span.to - now, count = std::ceil(rest * rate() / pair_phase);
        const double end = count > 1.0 ? now + rest / count : span.to;
        step({now, end, span.middle}, true);
        if (!(end > now)) break;
        now = end;
    }
}

void PairFlight::start(const std::vector<Body>& bodies, std::vector<Member> members, const ForceField& forces,
                       double from) {
    bodies_ = &bodies;
    forces_ = &forces;
    members_ = std::move(members);
    start_ = from;
    reached_.clear();
    states_.resize(members_.size());
    masses_.resize(members_.size());
    points_.assign(members_.size(), {});
    turns_of_.assign(forces.pairs().has_torques() ? members_.size() : 0, {});
    pulls_.assign(members_.size(), {});
    flying_.clear();
    exactly_ = false;
    by_parts_ = true;
    const auto index = forces.pairs().bodies();
    for (std::size_t k = 0; k < members_.size(); ++k) {
        if (!members_[k].flies) continue;
        const Body& body = bodies[index[k]];
        flying_.push_back(k);
        masses_[k] = mass_of(body);
        points_[k].mass = body.mass;
        if (!turns_of_.empty()) turns_of_[k].inverse_inertia = 1.0 / body.principal_inertia.minCoeff();
        exactly_ = exactly_ || members_[k].integrator == IntegratorKind::exact;
        by_parts_ = by_parts_ && members_[k].integrator == IntegratorKind::splitting;
    }
}

const std::vector<RigidState>& PairFlight::at(double time) {
    for (const auto& [when, states] : reached_)
        if (when == time) return states;
    for (const std::size_t k : flying_) states_[k] = members_[k].start;
    advance(time);
    return reached_.emplace_back(time, states_).second;
}

void PairFlight::advance(double to) {
    const ForceField& forces = *forces_;
    const auto index = forces.pairs().bodies();
    for (double now = start_; now < to;) {
        double end = to;
        turns_ = false;
        for (const std::size_t k : flying_) end = std::min(end, forces.next_change(index[k], now));
        middle_ = 0.5 * (now + end);
        span_start_ = now;
        for (const std::size_t k : flying_) states_[k].elapsed = 0.0;
        for (const std::size_t k : flying_) turns_ = turns_ || !forces.torque_free(index[k], middle_);
        const Span span{now, end, middle_};
        if (exactly_) {
            // Without torques the rotations are in closed form.
            const std::vector<RigidState> before = states_;
            if (!turns_)
                for (const std::size_t k : flying_) states_[k].angular_momentum.setZero();
            exact(span);
            for (const std::size_t k : flying_) {
                if (turns_) continue;
                states_[k].angular_momentum = before[k].angular_momentum;
                states_[k].orientation = FreeRotation(masses_[k].principal_inertia, masses_[k].principal_axes,
                                                      before[k].orientation, before[k].angular_momentum)
                                             .at(end - now);
            }
        } else if (by_parts_) {
            split(span);
        } else {
            step(span, false);
        }
        now = end;
    }
}

}  // namespace tumble
