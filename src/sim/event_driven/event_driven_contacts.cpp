// EventDrivenMotion: bodies in contact. Their motion in a step, their sleep, and the switch from flight to contact.
#include "sim/event_driven/event_driven_motion.h"
#include "sim/event_driven/settings.h"

#include "core/sort_unique.h"
#include "sim/dynamics/integrator.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/event_driven/contact_transition.h"
#include "sim/log/contact_log.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace tumble {
namespace {

bool held(const Body& body) { return body.dynamic() && !body.flying && !body.asleep; }

}  // namespace

void EventDrivenMotion::take_off(const std::vector<Contact>& contacts, const std::vector<Gap>& gaps,
                                 std::vector<Body>& bodies, const ForceField& forces, std::int64_t step) {
    supports_.assign(bodies.size(), {});
    // A body that rolls over a hill leaves it along the tangent in each step, by v^2 h^2 / 2 R: less than gravity's
    // displacement while it stays on.
    mark_held(
        contacts, gaps, bodies, free_motion(forces, {step, 0.0}), {settings_.gravity.norm(), h_, h_},
        [&](std::uint32_t k) { return events_[k].solved; }, supports_);
    for (const std::uint32_t i : movers_) {
        if (!held(bodies[i]) || !supports_[i].none() || bodies[i].jointed) continue;
        bodies[i].flying = true;
        events_[i].start = {step, 0.0};  // begin_step() finds its trajectory
        taken_off_.push_back(i);
    }
    if (!groups_.empty()) take_off_groups(bodies, forces, step);
}

// Moves a body in contact uniformly to the end of the step. A clamped body moves slower: it ends where it would have
// stopped.
void EventDrivenMotion::hold(std::uint32_t i, const BodyVelocity& motion, const CcdFraction& limit,
                             const std::vector<Body>& bodies, const EventTime& now) {
    const Body& body = bodies[i];
    Vec3 velocity = limit.share * motion.velocity;
    if (limit.carrier != CcdFraction::none) {
        const Body& carrier = bodies[limit.carrier];
        velocity += (1.0 - limit.share) * carrier.point_velocity(body.position - carrier.position);
    }
    start(i, Trajectory::uniform(body, velocity, limit.share * motion.angular_velocity), now, {now.step + 1, 0.0});
    if (!body.placed) events_[i].spin = spin(body);  // a body that rolls has the momenta of its end
}

void EventDrivenMotion::begin_step(std::vector<Body>& bodies, const std::vector<BodyVelocity>& motions,
                                   const std::vector<CcdFraction>& limits, const ForceField& forces,
                                   std::int64_t step) {
    const EventTime now{step, 0.0};
    changed_.swap(taken_off_);
    taken_off_.clear();
    for (const std::uint32_t i : movers_) {
        const Body& body = bodies[i];
        events_[i].pushed = events_[i].solved = !body.flying && !body.asleep;
        if (body.flying) {
            // An explosion ends a flight in closed form.
            const bool goes_on = !events_[i].driven && forces.only_gravity(i);
            if (goes_on || events_[i].start == now) continue;
            bring(i, bodies, now);
        } else if (body.asleep) {
            continue;
        } else {
            hold(i, motions[i], limits[i], bodies, now);
            events_[i].meetings = 0;
        }
        changed_.push_back(i);
    }
    fly_changed(bodies, forces, now);
    predict_changed(bodies, now);
}

void EventDrivenMotion::lay_down(const std::vector<Body>& bodies, std::int64_t step) {
    const EventTime now{step, 0.0};
    for (const std::uint32_t i : movers_) {
        if (!bodies[i].asleep || events_[i].until == never) continue;
        start(i, Trajectory::uniform(bodies[i], Vec3::Zero(), Vec3::Zero()), now, never);
        events_[i].meetings = 0;
        changed_.push_back(i);
    }
    predict_changed(bodies, now);
}

// All bodies in contact have a support, and no others.
void EventDrivenMotion::support_stepped(const std::vector<Body>& bodies) {
    supports_.resize(bodies.size());
    for (const std::uint32_t k : movers_) {
        if (!held(bodies[k]))
            supports_[k] = {};
        else if (supports_[k].none())
            supports_[k].on = support::still;
    }
}

// Bodies in contact that the impact released are ballistic from now on, not from the next step.
void EventDrivenMotion::release_receivers(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now) {
    const auto& receivers = cluster_.impulse_receivers();
    if (std::none_of(receivers.begin(), receivers.end(), [&](std::uint32_t k) { return held(bodies[k]); })) return;
    support_stepped(bodies);
    for (const std::uint32_t k : receivers) supports_[k] = {};
    mark_held(
        cluster_.contacts(), cluster_.gaps(), bodies, free_motion(forces, now), {settings_.gravity.norm(), 0.0, h_},
        [&](std::uint32_t k) { return events_[k].solved; }, supports_);
    for (const std::uint32_t k : receivers) {
        if (!held(bodies[k]) || !supports_[k].none() || bodies[k].jointed) continue;
        bodies[k].flying = true;
        events_[k].solved = false;
        // Gravity of the whole step has acted already; the flight adds that of its rest once more.
        if (log_) log_->add_gravity(k, bodies[k], -clock_.between(now, {now.step + 1, 0.0}), bodies[k].position);
    }
    if (!groups_.empty()) release_groups(bodies, forces, now);
}

void EventDrivenMotion::wake(std::uint32_t i, std::vector<Body>& bodies, SleepMonitor& sleep, const EventTime& now) {
    was_asleep_.clear();
    for (const std::uint32_t k : movers_)
        if (bodies[k].asleep) was_asleep_.push_back(k);
    sleep.wake(i, bodies);
    for (const std::uint32_t k : was_asleep_)
        if (!bodies[k].asleep) changed_.push_back(k);
    until_ = std::min(until_, now.step + 1);
}

// Bodies of the cluster whose hops are now below the Zeno limit switch to contact: the rest of the step is solved for
// them as a step of its own.
void EventDrivenMotion::switch_to_contact(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now) {
    std::vector<std::uint32_t> switched;
    std::vector<std::uint32_t> switching;
    std::vector<std::tuple<std::uint32_t, std::uint32_t, double>> landing;  // body, support, its pressing
    const FreeMotion free = free_motion(forces, now);
    support_stepped(bodies);
    do {  // in rounds: the result must not depend on the contacts' order
        switching.clear();
        landing.clear();
        for (std::size_t i = 0; i < cluster_.contacts().size(); ++i) {
            const Contact& c = cluster_.contacts()[i];
            const Body &a = bodies[c.a], &b = bodies[c.b];
            if (!a.flying && !b.flying) continue;
            const double acceleration = pressing_acceleration(c, cluster_.gaps()[i], bodies, free, supports_);
            const double time = std::max(a.flying ? zeno_limit(c.a) : 0.0, b.flying ? zeno_limit(c.b) : 0.0);
            const double speed = std::abs(relative_velocity(c, a, b));
            const bool below_limit = (a.flying && below_zeno_limit(c.a, bodies, speed)) ||
                                     (b.flying && below_zeno_limit(c.b, bodies, speed));
            if (!below_limit && !hop_is_shorter(c, a, b, acceleration, time)) continue;
            for (const auto& [k, other] : {std::pair(c.a, c.b), std::pair(c.b, c.a)})
                if (bodies[k].flying)
                    landing.push_back({k, support_on(other, bodies[other], supports_), -acceleration});
        }
        std::sort(landing.begin(), landing.end());
        for (auto entry = landing.rbegin(); entry != landing.rend(); ++entry) {
            const auto& [k, on, pressing] = *entry;
            supports_[k] = {on, std::max(supports_[k].pressing, pressing)};
            switching.push_back(k);
        }
        for (std::size_t i = switching.size(); i-- > 0;)
            if (const std::uint32_t g = groups_.group(switching[i]); g != GroupFlights::none)
                switching.insert(switching.end(), groups_.groups()[g].bodies.begin(), groups_.groups()[g].bodies.end());
        sort_unique(switching);
        for (const std::uint32_t k : switching) {
            bodies[k].flying = false;
            if (supports_[k].none()) supports_[k].on = support::still;
        }
        switched.insert(switched.end(), switching.begin(), switching.end());
    } while (!switching.empty());
    const auto& receivers = cluster_.impulse_receivers();
    const bool joined = !groups_.empty() && std::any_of(receivers.begin(), receivers.end(), [&](std::uint32_t k) {
        return groups_.group(k) != GroupFlights::none && !bodies[k].flying;
    });
    if (!switched.empty() || joined) solve_rest(switched, bodies, forces, now);
}

// The rest of the step for a body that has landed, if it can roll.
bool EventDrivenMotion::roll_rest(std::uint32_t k, std::vector<Body>& bodies, const ForceField& forces,
                                  const EventTime& now) {
    const double rest = clock_.between(now, {now.step + 1, 0.0});
    std::vector<std::uint32_t> of_body;
    for (std::uint32_t m = 0; m < contact_manifolds_.size(); ++m)
        if (contact_manifolds_[m].a == k || contact_manifolds_[m].b == k) of_body.push_back(m);
    auto rolled = roll_alone(k, bodies, contact_manifolds_, of_body, forces, settings_.gravity, rest);
    if (!rolled) return false;
    give_impulses(*rolled, contact_manifolds_, of_body);
    Body& body = bodies[k];
    if (log_) {
        log_->add_gravity(k, body, rest, body.position);
        log_->add_rolled(*rolled, contact_manifolds_, bodies, rest);
    }
    body.momentum = rolled->end.momentum;
    body.angular_momentum = rolled->end.angular_momentum;
    body.derive_velocities();
    events_[k].pushed = true;
    rolled_.push_back(std::move(*rolled));
    std::erase_if(contact_manifolds_, [&](const Manifold& m) { return m.a == k || m.b == k; });
    return true;
}

// The rest of the step for bodies that have landed, and for struck bodies of stepped groups: their joints must close.
void EventDrivenMotion::solve_rest(const std::vector<std::uint32_t>& landed, std::vector<Body>& bodies,
                                   const ForceField& forces, const EventTime& now) {
    until_ = std::min(until_, now.step + 1);
    const double rest = clock_.between(now, {now.step + 1, 0.0});
    if (!(rest > 0.0)) return;
    contact_manifolds_.clear();
    std::vector<std::uint32_t> touched;
    // including contacts of supporting bodies, which may lean on others
    for (const Manifold& m : cluster_.manifolds()) {
        if (bodies[m.a].flying || bodies[m.b].flying) continue;
        contact_manifolds_.push_back(m);  // its small remaining bounce is lost
        for (const std::uint32_t k : {m.a, m.b})
            if (bodies[k].dynamic() && !bodies[k].asleep) touched.push_back(k);
    }
    std::vector<std::uint32_t> joined;  // groups
    if (!groups_.empty()) {
        for (const std::vector<std::uint32_t>* list : {&landed, &std::as_const(touched), &cluster_.impulse_receivers()})
            for (const std::uint32_t k : *list)
                if (groups_.group(k) != GroupFlights::none && !bodies[k].flying) joined.push_back(groups_.group(k));
        sort_unique(joined);
        for (const std::uint32_t g : joined)
            for (const std::uint32_t k : groups_.groups()[g].bodies)
                if (!bodies[k].asleep) touched.push_back(k);
    }
    sort_unique(touched);
    std::erase_if(touched, [&](std::uint32_t k) {
        return std::ranges::find(landed, k) != landed.end() && roll_rest(k, bodies, forces, now);
    });
    for (const std::uint32_t k : touched) {
        velocities_before_[k] = {bodies[k].velocity, bodies[k].angular_velocity};
        events_[k].spin = unknown;
    }
    for (const std::uint32_t k : landed)
        if (std::ranges::find(rolled_, k, &RolledContact::body) == rolled_.end())
            give_rest_of_step(k, bodies, forces, now);
    const bool joints = !joined.empty();
    islands_.find(body_pairs(contact_manifolds_), bodies, touched,
                  joints ? std::span<const BodyPair>(groups_.joints().pairs()) : std::span<const BodyPair>());
    const ContactProblem problem{bodies,
                                 contact_manifolds_,
                                 velocities_before_,
                                 {rest, std::numeric_limits<double>::infinity()},
                                 log_ ? &totals_ : nullptr,
                                 joints ? &groups_.joints() : nullptr};
    if (log_) totals_.assign(contact_manifolds_.size(), {});
    std::vector<JointReaction> loads;
    for (const std::uint32_t g : joined) groups_.keep_loads(g, loads);
    contact_solver_.solve(problem, islands_, alone_);
    std::size_t next = 0;
    for (const std::uint32_t g : joined) groups_.take_solve(g, loads, next);
    if (log_)
        for (std::size_t k = 0; k < islands_.size(); ++k) log_->add_contacts(islands_.manifolds(k), problem, totals_);
    for (const std::uint32_t k : touched) {
        if (groups_.group(k) == GroupFlights::none) {  // pushes of joined bodies close their joints
            bodies[k].correction_velocity.setZero();
            bodies[k].correction_angular_velocity.setZero();
        }
        changed_.push_back(k);
    }
    for (const std::uint32_t k : landed) changed_.push_back(k);
}

// The forces of the rest of the step, on a body that has landed.
void EventDrivenMotion::give_rest_of_step(std::uint32_t k, std::vector<Body>& bodies, const ForceField& forces,
                                          const EventTime& now) {
    Body& body = bodies[k];
    const double from = clock_.seconds(now), to = clock_.seconds(now.step + 1);
    const double rest = clock_.between(now, {now.step + 1, 0.0});
    const bool pushed = events_[k].pushed;
    Wrench of_water;
    if (log_ && forces.has_water()) of_water = forces.water(k, body, from, to, false);
    const Wrench wrench = pushed ? forces.fields(k, body, from, to) : forces.throughout(k, body, from, to);
    const Impulse brief_impulse = pushed ? Impulse{} : forces.brief(k, body, from, to);
    advance_momenta(body, wrench.force, wrench.torque, rest);
    advance_momenta(body, brief_impulse);
    body.derive();
    if (log_) {
        const Impulse rest_of_step{rest * (wrench.force - body.mass * body.fall(settings_.gravity)),
                                   rest * wrench.torque};
        log_->add_gravity(k, body, rest, body.position);
        log_->add_external(k, rest_of_step + brief_impulse, body.position, {body.velocity, body.angular_velocity});
        log_->add_water_work(k,
                             rest * (of_water.force.dot(body.velocity) + of_water.torque.dot(body.angular_velocity)));
    }
    events_[k].pushed = true;
}

// Bodies in contact meet fixed bodies, and each other, by steps. Exceptions:
// - Bodies that an impact has deflected in this step, or that have switched to contact, move for the rest of the step
//   only until they meet something, and so do bodies that were moving towards them: the next impact is there.
// - After a few such meetings in a step they stop there.
// - But two touching bodies that are free to move continue, because stopping would lose their common motion, and are
//   left to the contact of the next step.
void EventDrivenMotion::hold_receivers(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now) {
    std::vector<std::uint32_t> going, near;
    for (const std::uint32_t k : changed_)
        if (held(bodies[k])) going.push_back(k);
    if (going.empty()) return;
    const double rest = clock_.between(now, {now.step + 1, 0.0});
    motions_.resize(bodies.size());
    for (const std::uint32_t k : going) {
        motions_[k] = {bodies[k].velocity + bodies[k].correction_velocity,
                       bodies[k].angular_velocity + bodies[k].correction_angular_velocity};
        if (groups_.group(k) != GroupFlights::none) motions_[k].angular_velocity += gyration(bodies[k], rest);
    }
    for (const RolledContact& rolled : rolled_)
        motions_[rolled.body] = mean_velocity(bodies[rolled.body], rolled.end, rest);
    const TouchDepth depth = touch_depth(cluster_.manifolds(), bodies);
    const auto goes = [&](std::uint32_t k) { return std::binary_search(going.begin(), going.end(), k); };
    const std::vector<CcdFraction>* limits = nullptr;
    for (bool more = true; more;) {
        sort_unique(going);
        std::vector<BroadPhase::Pair> pairs;
        near = going;
        for (const std::uint32_t k : going) {
            const auto add = [&](std::uint32_t other) {
                const auto [a, b] = std::minmax(k, other);
                const bool both = bodies[a].dynamic() && bodies[b].dynamic();
                const bool often =
                    both && std::max(events_[a].meetings, events_[b].meetings) >= tuning::meetings_in_step;
                if (!often || !depth(a, b)) pairs.push_back({a, b});
            };
            for (const std::uint32_t other : neighbor_boxes_.fixed(k)) add(other);
            for (const std::uint32_t other : neighbor_boxes_.moving(k)) {
                if (bodies[other].flying) continue;
                near.push_back(other);
                add(other);
            }
        }
        sort_unique(near);
        sort_unique(pairs);
        for (const std::uint32_t k : near) {
            if (goes(k)) continue;
            bring(k, bodies, now);
            const Motion motion = events_[k].path.at(clock_.between(events_[k].start, now));
            motions_[k] = {motion.velocity, motion.angular_velocity};
        }
        const auto find_pairs = [&]() -> const std::vector<BroadPhase::Pair>& { return pairs; };
        const bool any_fast = std::any_of(near.begin(), near.end(),
                                          [&](std::uint32_t k) { return ccd_clamp_.fast(k, motions_[k], rest); });
        limits = &ccd_clamp_.limits({bodies, motions_, rest, any_fast}, find_pairs, depth);
        std::vector<std::uint32_t> stopped;
        for (const std::uint32_t k : near)
            if (!goes(k) && held(bodies[k]) && (*limits)[k].share < 1.0) stopped.push_back(k);
        going.insert(going.end(), stopped.begin(), stopped.end());
        more = !stopped.empty();
    }
    for (const std::uint32_t k : going) {
        changed_.push_back(k);
        if (const std::uint32_t g = groups_.group(k); g != GroupFlights::none) {
            // Joined bodies move for the same fraction of the time: otherwise their joints would open.
            CcdFraction all;
            for (const std::uint32_t member : groups_.groups()[g].bodies)
                all.share = std::min(all.share, (*limits)[member].share);
            hold(k, motions_[k], all, bodies, now);
            bodies[k].correction_velocity.setZero();
            bodies[k].correction_angular_velocity.setZero();
            continue;
        }
        const CcdFraction& limit = (*limits)[k];
        if (limit.met != CcdFraction::none && events_[k].meetings < tuning::meetings_in_step) {
            hold(k, motions_[k], {}, bodies, now);
            events_[k].until = later(now, limit.share * rest);
            events_[k].met = limit.met;
            continue;
        }
        if (limit.share < 1.0) {
            const Wrench wrench = forces.endless(k, bodies[k], clock_.seconds(now), clock_.seconds(now.step + 1));
            return_work(bodies[k], rest * wrench.force, rest * wrench.torque, limit.share);
        }
        hold(k, motions_[k], limit, bodies, now);
    }
    for (const std::uint32_t k : near) motions_[k] = {};
    for (const RolledContact& rolled : rolled_) events_[rolled.body].spin = unknown;
    rolled_.clear();
}

}  // namespace tumble
