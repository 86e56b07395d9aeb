// EventDrivenMotion: groups of joined bodies. They fly, land and are released as a whole.
#include "sim/event_driven/event_driven_motion.h"

#include "core/sort_unique.h"
#include "sim/geometry/settings.h"
#include "sim/log/contact_log.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// A group of joined bodies is at rest, and stepped, if gravity gives its fastest point less than this share of g h in
/// a step. Not fitted: rounding of a hanging chain against the first step of a pendulum.
constexpr double group_rest = 0.01;

/// Half the length, in steps, of the first path on which a flying group's time of impact is found again, and the factor
/// to a longer one. The path's error is of the order of the fourth power of its length. Not fitted.
constexpr double refine_first = 1e-3;
constexpr double refine_longer = 30.0;

// Bounds of the body on the path up to time `span`: its bounds in the middle, moved along with the center and turned.
Bounds swept_bounds(const Body& body, const Trajectory& path, double span) {
    const Motion middle = path.at(0.5 * span);
    const Bounds there = world_bounds(body.collider, {middle.position, middle.rotation});
    const Bounds centers = path.swept(0.0, span);
    const double turned = (0.5 * span * path.spin_bound() + tuning::touch) * body.radius;
    return Bounds{there.min + (centers.min - middle.position), there.max + (centers.max - middle.position)}.grown(
        turned);
}

}  // namespace

void EventDrivenMotion::join(JointSet& joints, std::vector<Body>& bodies, const ForceField& forces) {
    driven_.begin_step(bodies, forces);
    if (joints.empty()) return;
    groups_.update(joints, bodies, forces);
    neighbor_boxes_.keep_apart(joints.apart());
}

void EventDrivenMotion::land_group(std::uint32_t group, std::vector<Body>& bodies) {
    for (const std::uint32_t k : groups_.groups()[group].bodies) {
        bodies[k].flying = false;
        events_[k].pushed = false;
    }
}

// From the present state to the end of the step. Returns false, with the bodies as they were, where the group cannot
// fly so far.
bool EventDrivenMotion::fly_group(std::uint32_t group, std::vector<Body>& bodies, const EventTime& now) {
    const EventTime end{now.step + 1, 0.0};
    const double span = std::max(0.0, clock_.between(now, end));
    const std::vector<std::uint32_t>& members = groups_.groups()[group].bodies;
    if (!groups_.start(group, span)) return false;
    for (const std::uint32_t k : members) {
        Body& body = bodies[k];
        set_state(body, groups_.start_of(k));
        body.flying = true;
        const RigidState& there = groups_.end_of(k);
        start(k, groups_.path(k, 0.0, span), now, end);
        events_[k].driven = span > 0.0;
        events_[k].swept = swept_bounds(body, events_[k].path, span);
        events_[k].turn_from = body.angular_momentum;
        events_[k].turn_to = there.angular_momentum;
        if (log_) log_->add_gravity(k, body, span, body.position);
        changed_.push_back(k);
    }
    return true;
}

// At the start of a step. Groups at rest are stepped: they fall asleep.
void EventDrivenMotion::take_off_groups(std::vector<Body>& bodies, const ForceField& forces, std::int64_t step) {
    const double rest = group_rest * settings_.gravity.norm() * h_;
    for (std::uint32_t g = 0; g < groups_.groups().size(); ++g) {
        const std::vector<std::uint32_t>& members = groups_.groups()[g].bodies;
        const bool flying = bodies[members[0]].flying;
        const auto any = [&](auto&& test) { return std::any_of(members.begin(), members.end(), test); };
        if (any([&](std::uint32_t k) { return bodies[k].asleep || (!flying && !supports_[k].none()); })) continue;
        const auto moves = [&](const Body& body, const Vec3& velocity, const Vec3& turn) {
            return velocity.norm() + body.radius * turn.norm() > rest;
        };
        land_group(g, bodies);
        if (!groups_.can_fly(g, forces)) continue;
        const bool moved =
            any([&](std::uint32_t k) { return moves(bodies[k], bodies[k].velocity, bodies[k].angular_velocity); });
        changed_.clear();
        if (!fly_group(g, bodies, {step, 0.0})) continue;
        const bool goes =
            moved || any([&](std::uint32_t k) {
                const RigidState& end = groups_.end_of(k);
                const Body& body = bodies[k];
                return moves(body, body.inverse_mass * end.momentum, body.inverse_inertia * end.angular_momentum);
            });
        if (goes) {
            taken_off_.insert(taken_off_.end(), members.begin(), members.end());
        } else {
            groups_.cancel(g);
            land_group(g, bodies);
            if (log_)
                for (const std::uint32_t k : members) log_->add_gravity(k, bodies[k], -h_, bodies[k].position);
        }
    }
    changed_.clear();
}

// Flights that an impact has changed end now. Joints that it broke hold no longer.
void EventDrivenMotion::end_group_flights(std::vector<Body>& bodies, const EventTime& now) {
    std::vector<std::uint32_t> ending;
    for (const std::uint32_t k : changed_)
        if (flies_joined(k, bodies)) ending.push_back(groups_.group(k));
    sort_unique(ending);
    for (const std::uint32_t g : ending) {
        const std::uint32_t lead = groups_.groups()[g].bodies[0];
        groups_.end(g, clock_.between(events_[lead].start, now));
        if (!log_) continue;
        const double rest = clock_.between(now, events_[lead].until);
        for (const std::uint32_t k : groups_.groups()[g].bodies)
            log_->add_gravity(k, bodies[k], -rest, bodies[k].position);
    }
    if (cluster_.broken().empty()) return;
    // All other flights go on: their groups are found again as they were.
    groups_.find();
    for (Joint* joint : cluster_.broken()) {
        joint->broken_at = clock_.seconds(now);
        for (const std::uint32_t k : {joint->a, joint->b})
            if (k != Joint::world && groups_.group(k) == GroupFlights::none) bodies[k].jointed = false;
    }
}

// Flying groups with new states fly on. Groups that cannot, as where a limit is near, are stepped to the end of the
// step.
void EventDrivenMotion::fly_groups(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now) {
    std::vector<std::uint32_t> starting, landed;
    for (const std::uint32_t k : changed_)
        if (flies_joined(k, bodies)) starting.push_back(groups_.group(k));
    sort_unique(starting);
    for (const std::uint32_t g : starting) {
        if (fly_group(g, bodies, now)) continue;
        land_group(g, bodies);
        const std::vector<std::uint32_t>& members = groups_.groups()[g].bodies;
        landed.insert(landed.end(), members.begin(), members.end());
    }
    if (!landed.empty()) {
        sort_unique(landed);
        solve_rest(landed, bodies, forces, now);
    }
    sort_unique(changed_);
}

// Stepped groups that the impact released fly from now on. Gravity of the whole step has acted on them already.
void EventDrivenMotion::release_groups(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now) {
    const double rest = clock_.between(now, {now.step + 1, 0.0});
    std::vector<std::uint32_t> released;
    for (const std::uint32_t k : cluster_.impulse_receivers())
        if (groups_.group(k) != GroupFlights::none && !bodies[k].flying) released.push_back(groups_.group(k));
    sort_unique(released);
    for (const std::uint32_t g : released) {
        const std::vector<std::uint32_t>& members = groups_.groups()[g].bodies;
        const auto stays = [&](std::uint32_t k) { return !supports_[k].none() || bodies[k].asleep; };
        if (!groups_.can_fly(g, forces) || std::any_of(members.begin(), members.end(), stays)) continue;
        for (const std::uint32_t k : members) {
            Body& body = bodies[k];
            body.flying = true;
            events_[k].solved = false;
            body.momentum -= rest * body.mass * settings_.gravity;
            body.derive_velocities();
            if (log_) log_->add_gravity(k, body, -rest, body.position);
        }
    }
}

// The path's error is far below its deviation from a chord.
std::optional<ImpactCluster::Whereabouts> EventDrivenMotion::whereabouts(std::uint32_t i,
                                                                         const std::vector<Body>& bodies,
                                                                         const EventTime& now) const {
    if (!flies_driven(i, bodies)) return std::nullopt;
    const BodyEvent& f = events_[i];
    const double t = clock_.between(f.start, now), span = clock_.between(f.start, f.until);
    const double most = std::max(f.path.acceleration(0.0).norm(), f.path.acceleration(span).norm());
    return ImpactCluster::Whereabouts{f.path.position(t), 0.125 * span * span * most};
}

// The time of an impact of a flying group that was found on its trajectory: found again on a short path about that
// time, through the flight's own states at both ends. Where that has no impact, or begins after it, as where bodies
// graze each other, a longer one is tried, up to the whole trajectory.
TimeOfImpact EventDrivenMotion::refine(std::uint32_t i, std::uint32_t j, const TimeOfImpact& found,
                                       const std::vector<Body>& bodies, const EventTime& now, double limit) {
    for (double window = refine_first * h_;; window *= refine_longer) {
        const double from = std::max(0.0, found.time - window), to = std::min(limit, found.time + window);
        Trajectory paths[2];
        MovingBody moving[2];
        for (int side = 0; side < 2; ++side) {
            const std::uint32_t k = side == 0 ? i : j;
            const double since = clock_.between(events_[k].start, now);
            if (flies_joined(k, bodies)) {
                paths[side] = groups_.path(k, since + from, since + to);
                moving[side] = {&bodies[k], &paths[side], 0.0};
            } else if (flies_driven(k, bodies)) {
                const double time = clock_.seconds(now);
                paths[side] = driven_.path(k, time + from, time + to);
                moving[side] = {&bodies[k], &paths[side], 0.0};
            } else {
                moving[side] = {&bodies[k], &events_[k].path, since + from};
            }
        }
        const TimeOfImpact nearer = search_.find(moving[0], moving[1], to - from);
        const bool hit = nearer.kind == TimeOfImpact::Kind::impact, whole = from == 0.0 && to == limit;
        if (hit && (nearer.time > 0.0 || from == 0.0)) return {nearer.kind, from + nearer.time};
        if (whole) return nearer;
    }
}

}  // namespace tumble
