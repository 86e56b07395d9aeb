// Flights: the bodies that contacts hold. How they go through a step, fall asleep and wake, and how flights end in contact.
#include "sim/flight/flights.h"

#include "core/sort_unique.h"
#include "sim/flight/landing.h"
#include "sim/integrator.h"
#include "sim/spin_limit.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

bool held(const Body& body) { return body.dynamic() && !body.flying && !body.asleep; }

}  // namespace

bool Flights::take_off(const std::vector<Contact>& contacts, std::vector<Body>& bodies, const ForceField& forces, std::int64_t step) {
    held_.assign(bodies.size(), false);
    mark_held(contacts, bodies, settings_.gravity, settings_.gravity.norm() * h_, held_);
    bool any = false;
    for (const std::uint32_t i : movers_) {
        if (!held(bodies[i]) || held_[i]) continue;
        fly(i, bodies, forces, {step, 0.0});
        taken_off_.push_back(i);
        any = true;
    }
    return any;
}

// Moves a held body evenly to the end of the step. What has to stop on its way goes slower: it ends where it would have
// stopped.
void Flights::hold(std::uint32_t i, const StepLimit& limit, const std::vector<Body>& bodies, const Moment& now) {
    const Body& body = bodies[i];
    Vec3 velocity = limit.share * (body.velocity + body.push_velocity);
    if (limit.carrier != StepLimit::none) {
        const Body& carrier = bodies[limit.carrier];
        velocity += (1.0 - limit.share) * carrier.point_velocity(body.position - carrier.position);
    }
    start(i, Path::uniform(body, velocity, limit.share * (body.angular_velocity + body.push_angular_velocity)), now, {now.step + 1, 0.0});
    fliers_[i].spin = spin(body);
}

void Flights::begin_step(std::vector<Body>& bodies, const std::vector<StepLimit>& limits, const ForceField& forces, std::int64_t step) {
    const Moment now{step, 0.0};
    changed_.swap(taken_off_);
    taken_off_.clear();
    for (const std::uint32_t i : movers_) {
        const Body& body = bodies[i];
        if (body.flying) {
            if (!fliers_[i].driven || fliers_[i].start == now) continue;
            bring(i, bodies, now);
            fly(i, bodies, forces, now);
        } else if (body.asleep) {
            continue;
        } else {
            hold(i, limits[i], bodies, now);
        }
        changed_.push_back(i);
    }
    predict_changed(bodies, now);
}

void Flights::lay_down(const std::vector<Body>& bodies, std::int64_t step) {
    const Moment now{step, 0.0};
    for (const std::uint32_t i : movers_) {
        if (!bodies[i].asleep || fliers_[i].until == never) continue;
        start(i, Path::uniform(bodies[i], Vec3::Zero(), Vec3::Zero()), now, never);
        changed_.push_back(i);
    }
    predict_changed(bodies, now);
}

// Held bodies that the blow has freed fly from now on, not from the next step.
void Flights::release_struck(std::vector<Body>& bodies) {
    const auto& struck = cluster_.struck();
    if (std::none_of(struck.begin(), struck.end(), [&](std::uint32_t k) { return held(bodies[k]); })) return;
    held_.resize(bodies.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) held_[k] = held(bodies[k]);
    for (const std::uint32_t k : struck) held_[k] = false;
    mark_held(cluster_.contacts(), bodies, settings_.gravity, settings_.gravity.norm() * h_, held_);
    for (const std::uint32_t k : struck)
        if (held(bodies[k]) && !held_[k]) bodies[k].flying = true;
}

void Flights::wake(std::uint32_t i, std::vector<Body>& bodies, SleepMonitor& sleep, const Moment& now) {
    was_asleep_.clear();
    for (const std::uint32_t k : movers_)
        if (bodies[k].asleep) was_asleep_.push_back(k);
    sleep.wake(i, bodies);
    for (const std::uint32_t k : was_asleep_)
        if (!bodies[k].asleep) changed_.push_back(k);
    until_ = std::min(until_, now.step + 1);
}

// What of the cluster now hops too briefly passes into contact: the rest of the step is solved for it as a step of its own.
const std::vector<StepLimit>* Flights::land(std::vector<Body>& bodies, const ForceField& forces, const Moment& now) {
    std::vector<std::uint32_t> landed;
    for (bool more = true; more;) {
        more = false;
        for (const Contact& c : cluster_.contacts()) {
            const Body &a = bodies[c.a], &b = bodies[c.b];
            if (!a.flying && !b.flying) continue;
            const double acceleration = pressing_acceleration(c, a, b, settings_.gravity, !a.flying, !b.flying);
            const double time = std::max(a.flying ? landing_time(c.a) : 0.0, b.flying ? landing_time(c.b) : 0.0);
            const double speed = std::abs(relative_velocity(c, a, b));
            const bool stutter = (a.flying && stutters(c.a, bodies, speed)) || (b.flying && stutters(c.b, bodies, speed));
            if (!stutter && !hop_is_shorter(c, a, b, acceleration, time)) continue;
            for (const std::uint32_t k : {c.a, c.b}) {
                if (!bodies[k].flying) continue;
                bodies[k].flying = false;
                landed.push_back(k);
            }
            more = true;
        }
    }
    if (landed.empty()) return nullptr;
    until_ = std::min(until_, now.step + 1);
    const double rest = clock_.between(now, {now.step + 1, 0.0});
    if (!(rest > 0.0)) return nullptr;
    landing_manifolds_.clear();
    std::vector<std::uint32_t> touched;
    for (const Manifold& m : cluster_.manifolds()) {
        const bool lands = std::find(landed.begin(), landed.end(), m.a) != landed.end() || std::find(landed.begin(), landed.end(), m.b) != landed.end();
        if (!lands || bodies[m.a].flying || bodies[m.b].flying) continue;
        landing_manifolds_.push_back(m);   // the little it would still bounce is given up
        for (const std::uint32_t k : {m.a, m.b})
            if (bodies[k].dynamic() && !bodies[k].asleep) touched.push_back(k);
    }
    sort_unique(touched);
    for (const std::uint32_t k : touched) {
        velocities_before_[k] = {bodies[k].velocity, bodies[k].angular_velocity};
        fliers_[k].spin = unknown;
    }
    for (const std::uint32_t k : landed) {
        Body& body = bodies[k];
        const Wrench wrench = forces.at(k, body, clock_.seconds(now));
        advance_momenta(body, wrench.force, wrench.torque, rest);
        body.derive();
    }
    islands_.find(landing_manifolds_, bodies, touched);
    contact_solver_.solve({bodies, landing_manifolds_, velocities_before_, {rest, std::numeric_limits<double>::infinity()}},
                          islands_, alone_);
    for (const std::uint32_t k : touched) {
        bodies[k].push_velocity.setZero();
        bodies[k].push_angular_velocity.setZero();
        changed_.push_back(k);
    }
    for (const std::uint32_t k : landed) changed_.push_back(k);
    sort_unique(changed_);
    return &landing_limits(landed, bodies, now);
}

// Held bodies meet what is fixed, and each other, by steps: those just landed in what is left of this one.
const std::vector<StepLimit>& Flights::landing_limits(const std::vector<std::uint32_t>& landed, std::vector<Body>& bodies,
                                                      const Moment& now) {
    std::vector<BroadPhase::Pair> pairs;
    std::vector<BodyVelocity> motions(bodies.size());
    for (const std::uint32_t k : landed) {
        motions[k] = {bodies[k].velocity, bodies[k].angular_velocity};
        for (const std::uint32_t other : neighbourhood_.fixed(k)) pairs.push_back({std::min(k, other), std::max(k, other)});
        for (const std::uint32_t other : neighbourhood_.moving(k)) {
            if (bodies[other].flying) continue;
            bring(other, bodies, now);
            motions[other] = {bodies[other].velocity, bodies[other].angular_velocity};
            pairs.push_back({std::min(k, other), std::max(k, other)});
        }
    }
    sort_unique(pairs);
    const auto find_pairs = [&]() -> const std::vector<BroadPhase::Pair>& { return pairs; };
    return motion_limit_.limits(find_pairs, touch_depth(landing_manifolds_, bodies), bodies, movers_, motions,
                                clock_.between(now, {now.step + 1, 0.0}));
}

}  // namespace tumble
