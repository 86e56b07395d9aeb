#include "sim/contact/model/sleep.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/dynamics/forces.h"
#include "sim/geometry/contact_tolerance.h"
#include "sim/joints/joint_set.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <utility>

namespace tumble {

void SleepMonitor::count_sleepers() {
    sleepers_ =
        std::size_t(std::count_if(groups_.begin(), groups_.end(), [](const auto& group) { return group != nullptr; }));
}

bool SleepMonitor::sound(const std::vector<Body>& bodies) const {
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        const auto& group = groups_[i];
        if (bodies[i].asleep != (group != nullptr)) return false;
        if (!group) continue;
        if (!bodies[i].dynamic() || !std::binary_search(group->begin(), group->end(), i)) return false;
        for (const std::uint32_t member : *group)
            if (groups_[member] != group) return false;
    }
    return true;
}

void SleepMonitor::wake(std::uint32_t body, std::vector<Body>& bodies) {
    const auto group = groups_[body];
    if (!group) return;
    ++changes_;
    sleepers_ -= group->size();
    for (const std::uint32_t i : *group) {
        bodies[i].asleep = false;
        watches_[i] = Watch{};
        trends_[i] = Trend{};
        groups_[i].reset();
    }
}

void SleepMonitor::exchange(std::span<const std::uint32_t> changed) {
    ++changes_;
    for (const std::uint32_t i : changed) {
        watches_[i] = Watch{};
        trends_[i] = Trend{};
    }
}

namespace {

/// Bodies with smaller accelerations are told by their velocity, which is sampled at this interval (s; at least one
/// step). Not fitted: the spans hold a whole number of samples.
constexpr double sleep_sample_interval = tuning::sleep_times.front() / 16.0;

/// A body accelerates steadily if in this number of samples in a row its velocity grew, or changed in the same
/// direction by at least the share `sleep_steady` of the change before. A body that settles within a second changes
/// by less each time. Two samples would do for heaps: the velocity of a trembling body turns around sooner. Related
/// tests: Sleep.NotWhileRollingOffOrTurningBack and ContactEnergy.HeapsComeToRest.
constexpr int sleep_samples = 4;
constexpr double sleep_steady = 0.97;

/// A velocity decays if its change loses at least this times the share that the velocity loses: a velocity that goes
/// to 0 as exp(-t/T) has 1, one that turns around has less as it nears 0. Related test:
/// JointRest.ADoorThatTurnsBackStaysAwake.
constexpr double sleep_decay = 0.5;

/// Changes of velocity between two samples below this share of g h are rounding of the contact solver. Not fitted:
/// far above double precision, far below a slide. That of joined bodies is tuning::joint_rest.
constexpr double sleep_rounding = 1e-10;

// True if the bodies touch, or will before the end of the step.
bool meets(const Manifold& m, const Body& a, const Body& b, double h, double speed_change) {
    const double touch = touch_distance(a.radius, b.radius);
    for (int i = 0; i < m.count; ++i) {
        const ContactPoint& p = m.points[std::size_t(i)];
        const double v = relative_velocity(p, m.normal, a, b);
        if (p.separation <= touch + h * std::max(0.0, speed_change - v)) return true;
    }
    return false;
}

// Fixed, or kinematic without motion in the coming step.
bool stands(const Body& body) {
    return !body.dynamic() && body.velocity.isZero(0.0) && body.angular_velocity.isZero(0.0);
}

}  // namespace

bool SleepMonitor::wake_touched(const std::vector<Manifold>& manifolds, std::vector<Body>& bodies, double h,
                                double speed_change) {
    if (sleepers_ == 0) return false;
    bool woken = false;
    // A woken group may touch another sleeping one: repeat until no body wakes.
    for (bool again = true; again;) {
        again = false;
        for (const Manifold& m : manifolds) {
            const Body &a = bodies[m.a], &b = bodies[m.b];
            if (a.asleep == b.asleep) continue;
            const Body& other = a.asleep ? b : a;
            const bool disturbs = other.dynamic() || !other.velocity.isZero(0.0) || !other.angular_velocity.isZero(0.0);
            if (!disturbs || !meets(m, a, b, h, speed_change)) continue;
            wake(a.asleep ? m.a : m.b, bodies);
            again = woken = true;
        }
    }
    return woken;
}

// True if the body has been at rest for one of the spans.
bool SleepMonitor::follow(Spans& spans, const Body& body, double h) {
    bool rests = false;
    const double least = (sleep_samples + 1) * h;  // steps may be as long as a span: its trend must be known
    for (std::size_t k = 0; k < spans.size(); ++k) {
        Span& span = spans[k];
        const double time = tuning::sleep_times[k], most = tuning::sleep_drift(time) * body.radius;
        // The surface moves by at most |dx| + r |dtheta|, with |dtheta| about 2 |dq|.
        const double turned = 2.0 * (body.orientation.coeffs() - span.orientation.coeffs()).norm();
        if ((body.position - span.position).norm() + body.radius * turned > most) {
            span = {body.position, body.orientation, 0.0};
        } else {
            span.still += h;
            rests = rests || span.still >= std::max(time, least);
        }
    }
    return rests;
}

// Way (m) of the surface that is left to a motion that decays; infinite for others. With the shares l of the velocity
// and k of its change that are lost from sample to sample, exp(-t/T) has k = l and the way |v| T; even braking, after
// which a body turns back, has k = 0.
double SleepMonitor::way_left(const Trend& before, const Trend& now, double since) {
    const auto lost = [](const Trend::Velocity& from, const Trend::Velocity& to) {
        return 1.0 - to.dot(from) / from.squaredNorm();
    };
    const double of_velocity = lost(before.velocity, now.velocity), of_change = lost(before.change, now.change);
    if (!(of_velocity > 0.0 && of_velocity < 1.0 && of_change >= sleep_decay * of_velocity)) return infinity;
    return since * now.velocity.norm() / of_velocity;
}

// Samples the body's velocity.
void SleepMonitor::sample(Watch& watch, Trend& trend, const Body& body, double speed_change) {
    Trend now;
    now.velocity << body.velocity, body.radius * body.angular_velocity;
    now.change = now.velocity - trend.velocity;
    const bool grew = now.velocity.dot(trend.velocity) > trend.velocity.squaredNorm();
    const bool same = now.change.dot(trend.change) > sleep_steady * trend.change.squaredNorm();
    const double rounding = body.jointed ? tuning::joint_rest : sleep_rounding;
    const bool any = now.change.norm() > rounding * speed_change;
    watch.steady = any && (grew || same) ? watch.steady + 1 : 0;
    if (body.jointed) now.left = way_left(trend, now, watch.since);
    if (now.left < infinity) now.damped = trend.damped + watch.since;
    watch.ends = now.damped >= tuning::sleep_times.front() &&
                 now.left <= tuning::sleep_drift(tuning::sleep_times.back()) * body.radius;
    watch.since = 0.0;
    trend = now;
}

bool SleepMonitor::rests(std::uint32_t i, const Body& body, double h, double speed_change) {
    Watch& watch = watches_[i];
    watch.since += h;
    if (watch.since >= sleep_sample_interval) sample(watch, trends_[i], body, speed_change);
    const bool stays = follow(watch.spans, body, h);
    return (watch.ends || (stays && watch.steady < sleep_samples)) && !body.flying;
}

void SleepMonitor::lay_down(std::vector<std::uint32_t> members, std::vector<Body>& bodies) {
    ++changes_;
    sleepers_ += members.size();
    const auto group = std::make_shared<const std::vector<std::uint32_t>>(std::move(members));
    for (const std::uint32_t i : *group) {
        Body& body = bodies[i];
        body.asleep = true;
        body.momentum.setZero();
        body.angular_momentum.setZero();
        body.derive();
        groups_[i] = group;
    }
}

void SleepMonitor::observe(const ContactIslands& islands, const std::vector<Manifold>& manifolds,
                           std::vector<Body>& bodies, double h, double speed_change, const JointSet* joints,
                           const ForceField* water, double time) {
    if (water != nullptr) observe_afloat(islands, bodies, h, speed_change, *water, time);
    for (std::size_t island = 0; island < islands.size(); ++island) {
        bool still = true, supported = false;
        for (const std::uint32_t i : islands.bodies(island)) {
            // in each step, whatever the other bodies do
            const bool at_rest = rests(i, bodies[i], h, speed_change);
            still = still && at_rest;
        }
        if (!still) continue;
        for (const std::uint32_t k : islands.manifolds(island)) {
            const Manifold& m = manifolds[k];
            if (!stands(bodies[m.a]) && !stands(bodies[m.b])) continue;
            for (int i = 0; i < m.count; ++i) supported = supported || m.points[std::size_t(i)].impulse > 0.0;
        }
        for (const std::uint32_t k : islands.joints(island)) {
            const Joint& joint = joints->joints()[joints->active()[k]];
            still = still && !JointSet::driven(joint, joints->from(), joints->to() + h);
            for (const std::uint32_t i : {joint.a, joint.b})
                supported = supported || i == Joint::world || stands(bodies[i]);
        }
        const auto members = islands.bodies(island);
        if (still && water != nullptr)
            for (const std::uint32_t i : members) {
                still = still && !water->stirred(i, bodies[i], time);
                supported = supported || water->afloat(i, bodies[i]);
            }
        if (still && supported) lay_down({members.begin(), members.end()}, bodies);
    }
}

void SleepMonitor::observe_afloat(const ContactIslands& islands, std::vector<Body>& bodies, double h,
                                  double speed_change, const ForceField& water, double time) {
    std::vector<char> touches(bodies.size(), 0);
    for (std::size_t island = 0; island < islands.size(); ++island)
        for (const std::uint32_t i : islands.bodies(island)) touches[i] = 1;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        if (touches[i] != 0 || !bodies[i].dynamic() || bodies[i].asleep) continue;
        if (rests(i, bodies[i], h, speed_change) && water.afloat(i, bodies[i]) && !water.stirred(i, bodies[i], time))
            lay_down({i}, bodies);
    }
}

}  // namespace tumble
