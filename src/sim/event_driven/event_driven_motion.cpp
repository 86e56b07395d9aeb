#include "sim/event_driven/event_driven_motion.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "core/sort_unique.h"
#include "sim/contact/model/contact_constraint.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/event_driven/contact_transition.h"
#include "sim/event_driven/settings.h"
#include "sim/geometry/settings.h"
#include "sim/impact/settings.h"
#include "sim/log/contact_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// Hops shorter than this, s, are not followed (Zeno limit): the contact closes. A bouncing ball comes to rest
/// within this over 1 - e of its closed-form time; its remaining speed is below g times this. Related test:
/// SettlingBall.RestsAtItsTimeAtAnyStep and bench_accuracy "ball coming to rest".
constexpr double shortest_hop = 1e-7;

/// Impacts at intervals below this, s, are in a row. After `impacts_before_zeno_growth` of them a body is coming to
/// rest: the shortest hop that is followed doubles with every eight impacts. e = 0.9 needs about 90 from a
/// millisecond down. Related tests: Zeno.TiltedBoxesComeToRestOnAFace and Zeno.FlatBoxRestsWhenABallDoes.
constexpr double impact_row_interval = 1e-3;
constexpr int impacts_before_zeno_growth = 128;

/// Impacts in a row from which on hops of invisible size count as contact. Related test:
/// Zeno.FlatBoxRestsWhenABallDoes.
constexpr int impacts_before_zeno_check = 16;

/// Phase, rad, of the longest trajectory of bodies that pass each other or the center of a field; and the shortest one
/// that this makes, steps. Not fitted: bodies come closer by a quarter of their distance.
constexpr double longest_phase = 0.25;
constexpr double shortest_path = 1.0 / 65536;

/// Neighbors up to which the box of a body in the search for neighbors grows (event_driven_motion.h),
constexpr std::size_t few_neighbors = 6;

/// and this margin, radii. Measured on 216 balls, crowded and scattered (bench_accuracy "crowds").
constexpr double box_margin = 0.3;

}  // namespace

EventDrivenMotion::EventDrivenMotion(const std::vector<Body>& bodies, const SimulationSettings& settings, double fps)
    : settings_(settings),
      clock_{fps, settings.steps_per_frame},
      h_(clock_.seconds(1)),
      events_(bodies.size()),
      balls_(bodies.size()),
      half_spaces_(bodies.size()),
      neighbor_boxes_(bodies),
      queue_(bodies.size()),
      ccd_clamp_(bodies),
      islands_(bodies.size()),
      contact_solver_(bodies.size(), settings.contact_solver, ContactSolver::Effort::precisely),
      velocities_before_(bodies.size()) {
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        start(i, Trajectory::uniform(bodies[i], Vec3::Zero(), Vec3::Zero()), {}, never);
        if (const auto* ball = std::get_if<Ball>(&bodies[i].collider)) balls_[i].radius = ball->radius;
        if (bodies[i].moves() || bodies[i].absent) continue;
        if (const auto* space = std::get_if<HalfSpace>(&bodies[i].collider)) {
            const Vec3 normal = bodies[i].rotation * space->normal;
            half_spaces_[i] = {normal, space->offset + normal.dot(bodies[i].position), true};
        } else {
            events_[i].swept = world_bounds(bodies[i].collider, bodies[i].pose());
        }
    }
    list_movers(bodies);
}

void EventDrivenMotion::list_movers(const std::vector<Body>& bodies) {
    movers_.clear();
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
        if (bodies[i].moves()) movers_.push_back(i);
}

void EventDrivenMotion::exchange(const std::vector<Body>& bodies, std::span<const std::uint32_t> changed,
                                 const EventTime& now) {
    list_movers(bodies);
    neighbor_boxes_.exchange(bodies, changed);
    for (const std::uint32_t i : changed) {
        queue_.remove(i);
        ccd_clamp_.measure(i, bodies[i]);
        const std::uint32_t version = events_[i].version;
        events_[i] = {};
        events_[i].version = version;
        start(i, Trajectory::uniform(bodies[i], bodies[i].velocity, bodies[i].angular_velocity), now, never);
        if (!bodies[i].moves()) events_[i].swept = world_bounds(bodies[i].collider, bodies[i].pose());
        if (bodies[i].moves()) box(i, bodies, now);
    }
}

void EventDrivenMotion::measure(const std::vector<Body>& bodies) {
    list_movers(bodies);
    neighbor_boxes_.list_fixed(bodies);
    ccd_clamp_.measure(bodies);
}

// The pieces go on in contact until the step ends; the bodies that struck them as after an impact.
void EventDrivenMotion::break_bodies(const BlowResult& blow, std::vector<Body>& bodies, SleepMonitor& sleep,
                                     const ForceField& forces, const EventTime& now) {
    const std::vector<std::uint32_t> changed = changed_bodies(blow.partings);
    exchange(bodies, changed, now);
    until_ = std::min(until_, now.step + 1);
    for (const std::uint32_t k : blow.struck) {
        if (bodies[k].asleep) wake(k, bodies, sleep, now);
        events_[k].spin = unknown;
        changed_.push_back(k);
        if (std::binary_search(changed.begin(), changed.end(), k)) give_rest_of_step(k, bodies, forces, now);
    }
    if (!groups_.empty()) end_group_flights(bodies, now);
    fly_changed(bodies, forces, now);
    hold_receivers(bodies, forces, now);
    predict_changed(bodies, now);
}

EventTime EventDrivenMotion::later(const EventTime& now, double seconds) const {
    const double offset = now.offset + seconds;
    if (!(offset < 1e12 * h_)) return never;
    const auto steps = std::int64_t(std::floor(offset / h_));
    return {now.step + steps, offset - clock_.seconds(steps)};
}

void EventDrivenMotion::start(std::uint32_t i, const Trajectory& path, const EventTime& now, const EventTime& until) {
    BodyEvent& f = events_[i];
    f.path = path;
    f.start = now;
    f.until = until;
    f.driven = false;
    f.swept = everywhere;
    f.met = CcdFraction::none;
    f.spin = unknown;
    ++f.version;
    Ballistic& ball = balls_[i];
    ball.valid = ball.radius > 0.0 && path.parabolic() && path.acceleration(0.0) == settings_.gravity && until == never;
    ball.position = path.position(0.0);
    ball.velocity = path.velocity(0.0);
    ball.start = now;
}

// A driven trajectory ends with the step, or earlier: where a force begins or ends, or before the body passes another
// one with a force on it, of whose impact the flight does not know. Times within a step are compared by their offsets:
// the same change always has the same offset.
EventTime EventDrivenMotion::drive_end(std::uint32_t i, double rate, const EventTime& now) const {
    const ForceField& forces = driven_.forces();
    const double step_start = clock_.seconds(now.step), step_end = clock_.seconds(now.step + 1);
    EventTime end{now.step + 1, 0.0};
    if (rate * h_ > longest_phase) end = std::min(end, later(now, std::max(longest_phase / rate, shortest_path * h_)));
    for (double change = forces.next_change(i, step_start); change < step_end; change = forces.next_change(i, change))
        if (change - step_start > now.offset) return std::min(end, {now.step, change - step_start});
    return end;
}

// Starts free trajectories of all changed bodies that fly, from their present states.
void EventDrivenMotion::fly_changed(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now) {
    sort_unique(changed_);
    bool pairs = false;
    for (const std::uint32_t k : changed_) {
        if (!bodies[k].flying || flies_joined(k, bodies)) continue;
        if (forces.pairs().has(k))
            pairs = true;
        else
            fly(k, bodies, forces, now);
    }
    if (pairs) fly_pairs(bodies, forces, now);
}

// Bodies with forces between each other fly together: all their flights end at the same time.
void EventDrivenMotion::fly_pairs(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now) {
    const double time = clock_.seconds(now);
    std::vector<std::uint32_t> flying;
    for (const std::uint32_t i : forces.pairs().bodies()) {
        if (!std::binary_search(changed_.begin(), changed_.end(), i)) bring(i, bodies, now);
        if (!bodies[i].flying) continue;
        flying.push_back(i);
        if (events_[i].pushed) driven_.forgo_points(i);
        if (log_) log_->start_flight(i, bodies[i]);
    }
    double rate = forces.pair_rate(bodies, time);
    for (const std::uint32_t i : flying) rate = std::max(rate, forces.passing_rate(bodies[i], time));
    EventTime end{now.step + 1, 0.0};
    for (const std::uint32_t i : flying) end = std::min(end, drive_end(i, rate, now));
    driven_.start_pairs(flying, time);
    for (const std::uint32_t i : flying) drive(i, bodies[i], now, end);
    changed_.insert(changed_.end(), flying.begin(), flying.end());
    sort_unique(changed_);
}

// A trajectory under varying forces, from the body's present state; its end is as accurate as double precision allows.
void EventDrivenMotion::drive(std::uint32_t i, Body& body, const EventTime& now, const EventTime& end) {
    const RigidState here = state_of(body), there = driven_.at(i, clock_.seconds(end));
    start(i, trajectory_between(body, here, there, clock_.between(now, end)), now, end);
    events_[i].driven = true;
    events_[i].turn_from = here.angular_momentum;
    events_[i].turn_to = there.angular_momentum;
}

// Starts a free trajectory from the body's present state.
void EventDrivenMotion::fly(std::uint32_t i, std::vector<Body>& bodies, const ForceField& forces,
                            const EventTime& now) {
    Body& body = bodies[i];
    body.flying = true;
    if (log_) log_->start_flight(i, body);
    if (forces.only_gravity(i)) {
        start(i, Trajectory::flight(body, body.fall(settings_.gravity)), now, never);
        return;
    }
    // Under other forces, step by step.
    if (events_[i].pushed) driven_.forgo_points(i);
    driven_.start(i, clock_.seconds(now));
    drive(i, body, now, drive_end(i, forces.passing_rate(body, clock_.seconds(now)), now));
}

MovingBody EventDrivenMotion::moving_body(std::uint32_t i, const std::vector<Body>& bodies,
                                          const EventTime& now) const {
    return {&bodies[i], &events_[i].path, clock_.between(events_[i].start, now)};
}

void EventDrivenMotion::bring(std::uint32_t i, std::vector<Body>& bodies, const EventTime& now) {
    if (flies_joined(i, bodies)) return groups_.bring(i, clock_.between(events_[i].start, now));
    if (flies_driven(i, bodies) && events_[i].start < now && now < events_[i].until)
        set_state(bodies[i], driven_.at(i, clock_.seconds(now)));
    else
        show(i, bodies, now);
    if (bodies[i].flying && !events_[i].driven) bodies[i].derive();  // the others are derived already
    if (log_ && bodies[i].flying) log_->end_flight(i, bodies[i], events_[i].driven);
}

// The body's state and velocities, without the data that only contacts need.
void EventDrivenMotion::show(std::uint32_t i, std::vector<Body>& bodies, const EventTime& now) const {
    Body& body = bodies[i];
    if (!body.moves() || body.asleep) return;
    const BodyEvent& f = events_[i];
    const double t = clock_.between(f.start, now);
    const Motion motion = f.path.at(t);
    body.position = motion.position;
    body.orientation = motion.orientation;
    body.rotation = motion.rotation;
    if (!body.dynamic()) return;
    if (!body.flying) {
        body.derive();
        if (spin_grew(body, f.spin)) limit_spin(body, f.spin);
        return;
    }
    body.velocity = motion.velocity;
    body.momentum = body.mass * motion.velocity;
    body.angular_velocity = motion.angular_velocity;
    if (!f.driven) return;
    const double span = clock_.between(f.start, f.until);
    body.angular_momentum = f.turn_from + (t / span) * (f.turn_to - f.turn_from);
    body.derive();
}

void EventDrivenMotion::place(std::vector<Body>& bodies, std::int64_t step) const {
    for (const std::uint32_t i : movers_)
        if (bodies[i].dynamic()) show(i, bodies, {step, 0.0});
}

bool EventDrivenMotion::stepping(const std::vector<Body>& bodies) const {
    return std::any_of(movers_.begin(), movers_.end(), [&](std::uint32_t i) {
        const Body& body = bodies[i];
        return body.flying ? events_[i].driven : !body.asleep;
    });
}

void EventDrivenMotion::predict_changed(const std::vector<Body>& bodies, const EventTime& now) {
    sort_unique(changed_);
    for (const std::uint32_t i : changed_) box(i, bodies, now);
    for (const std::uint32_t i : changed_) predict(i, bodies, now);
    changed_.clear();
}

// A box that contains the body for about the time that it takes to leave its own position; at least for the step.
void EventDrivenMotion::box(std::uint32_t i, const std::vector<Body>& bodies, const EventTime& now) {
    BodyEvent& f = events_[i];
    f.boxed_until = never;
    if (!neighbor_boxes_.crowded()) {
        if (!neighbor_boxes_.known(i)) neighbor_boxes_.enclose(i, Bounds{Vec3::Zero(), Vec3::Zero()});
        return;
    }
    const double r = bodies[i].radius, t = clock_.between(f.start, now);
    const double v = f.path.velocity(t).norm(), a = f.path.acceleration(t).norm();
    const double displacement = f.box_displacement * r;
    double time = v > 0.0 || a > 0.0 ? 2.0 * displacement / (v + std::sqrt(v * v + 2.0 * a * displacement))
                                     : std::numeric_limits<double>::infinity();
    time = std::min(std::max(time, h_), clock_.between(now, f.until));
    if (!std::isfinite(time) || time > 1e9 * h_)
        time = f.path.still() ? 0.0 : 1e9 * h_;
    else
        f.boxed_until = later(now, time);
    // A part of the trajectory may fit into the present box: cheaper than a new search for neighbors. Not a small part
    // of a step: repeated parts of the remainder never reach its end.
    for (const double part : {1.0, 0.5, 0.25}) {
        if (part < 1.0 && part * time < 0.25 * h_) break;
        if (!neighbor_boxes_.encloses(i, f.path.swept(t, t + part * time).grown(r))) continue;
        if (part < 1.0) f.boxed_until = later(now, part * time);
        return;
    }
    neighbor_boxes_.enclose(i, f.path.swept(t, t + time).grown(r + box_margin * r));
    // Larger boxes last longer but have more neighbors.
    const std::size_t neighbors = neighbor_boxes_.moving(i).size();
    if (neighbors < few_neighbors)
        f.box_displacement = std::min(1.5 * f.box_displacement, tuning::longest_box_displacement);
    else if (neighbors > 3 * few_neighbors)
        f.box_displacement = std::max(f.box_displacement / 1.5, tuning::shortest_box_displacement);
}

void EventDrivenMotion::predict(std::uint32_t i, const std::vector<Body>& bodies, const EventTime& now) {
    BodyEvent& f = events_[i];
    const bool flying = bodies[i].flying;
    f.event = BodyEvent::Event::leaves_box;
    EventTime next = std::min(f.boxed_until, f.until);
    double horizon = clock_.between(now, next);
    const MovingBody self = moving_body(i, bodies, now);
    const auto consider = [&](std::uint32_t j) {
        if (!f.swept.overlaps(events_[j].swept)) return;
        const double limit = std::min(horizon, clock_.between(now, events_[j].until));
        TimeOfImpact found = search_.find(self, moving_body(j, bodies, now), limit);
        if (found.kind == TimeOfImpact::Kind::impact && (flies_driven(i, bodies) || flies_driven(j, bodies)))
            found = refine(i, j, found, bodies, now, limit);
        if (found.kind == TimeOfImpact::Kind::none || !(found.time < horizon)) return;
        horizon = found.time;
        next = later(now, found.time);
        f.event = found.kind == TimeOfImpact::Kind::impact ? BodyEvent::Event::impact : BodyEvent::Event::recheck;
        f.partner = j;
        f.partner_version = events_[j].version;
    };
    if (flying)
        for (const std::uint32_t j : neighbor_boxes_.fixed(i))
            if (!half_spaces_[j].valid || !half_spaces_[j].stays_below(f.path, bodies[i].radius, self.since, horizon))
                consider(j);
    const Ballistic& ball = balls_[i];
    const Vec3 at = f.path.position(self.since), velocity = f.path.velocity(self.since);
    for (const std::uint32_t j : neighbor_boxes_.moving(i)) {
        const Ballistic& other = balls_[j];
        if (ball.valid && other.valid) {
            // Both fall alike: d(t) = d + v t, touching when d(t)^2 = (r + r')^2. Pairs too far apart or parting are
            // done.
            const double t = roughly(other.start, now);
            const Vec3 d = position(other, t) - at, v = other.velocity + t * settings_.gravity - velocity;
            const double closing = -d.dot(v), reach = ball.radius + other.radius, c = d.squaredNorm() - reach * reach;
            if (!(closing > 0.0) || c > 2.0 * closing * horizon || closing * closing < v.squaredNorm() * c) continue;
        }
        if (flying || bodies[j].flying) consider(j);
    }
    if (f.event == BodyEvent::Event::leaves_box && f.met != CcdFraction::none && f.until <= f.boxed_until) {
        f.event = BodyEvent::Event::impact;
        f.partner = f.met;
        f.partner_version = events_[f.met].version;
        next = f.until;
    }
    // No event within the trajectory: World continues it at the end of the step, this class where a force begins or
    // ends.
    if (f.event == BodyEvent::Event::leaves_box && f.driven && f.until <= f.boxed_until &&
        f.until < EventTime{now.step + 1, 0.0}) {
        f.event = BodyEvent::Event::drives_on;
        queue_.set(i, f.until);
    } else if (f.event == BodyEvent::Event::leaves_box && (f.until <= f.boxed_until || next >= never))
        queue_.remove(i);
    else
        queue_.set(i, next);
}

std::int64_t EventDrivenMotion::run(std::vector<Body>& bodies, SleepMonitor& sleep, const ForceField& forces,
                                    std::int64_t until) {
    until_ = until;
    while (!queue_.empty() && queue_.first_moment() < EventTime{until_, 0.0}) {
        const std::uint32_t i = queue_.first();
        const EventTime now = queue_.first_moment();
        const BodyEvent& f = events_[i];
        if (f.event == BodyEvent::Event::leaves_box) box(i, bodies, now);
        if (f.event == BodyEvent::Event::drives_on) {
            bring(i, bodies, now);
            changed_.push_back(i);
            fly_changed(bodies, forces, now);
            predict_changed(bodies, now);
        } else if (f.event == BodyEvent::Event::impact && events_[f.partner].version == f.partner_version) {
            collide(i, f.partner, bodies, sleep, forces, now);
        } else {
            predict(i, bodies, now);
        }
    }
    return until_;
}

// An impact within a frame never has the time of the frame's start, which rounding could give it: it belongs to the
// frame that it changes.
ImpactTime EventDrivenMotion::impact_time(const EventTime& now) const {
    const std::int64_t frame = now.step / settings_.steps_per_frame, first = frame * settings_.steps_per_frame;
    const double begin = clock_.seconds(first), end = clock_.seconds(first + settings_.steps_per_frame);
    const double time = std::clamp(clock_.seconds(now), std::nextafter(begin, end), end);
    return {time, time < end ? frame : frame + 1, true};
}

// Counts the body's impacts in quick succession; a run longer than any motion has is an error.
void EventDrivenMotion::count_impact(std::uint32_t i, const std::vector<Body>& bodies, const EventTime& now) {
    BodyEvent& f = events_[i];
    f.since_impact = f.impacts_in_row > 0 ? clock_.between(f.last_impact, now) : h_;
    f.last_impact = now;
    f.impacts_in_row = f.since_impact < impact_row_interval ? f.impacts_in_row + 1 : 1;
    const std::int64_t frame = now.step / settings_.steps_per_frame;
    if (frame != frame_) {
        frame_ = frame;
        impacts_in_frame_ = 0;
    }
    const std::int64_t limit = tuning::impacts_in_frame * std::int64_t(bodies.size());
    if (++impacts_in_frame_ > limit)
        throw RunError(fmt::format(
            "frame {} (t = {:.9g} s): more than {} impacts, the last of body '{}'; try impacts = \"stepped\" "
            "for jammed bodies",
            frame, clock_.seconds(now), limit, safe_text(bodies[i].name)));
}

// Zeno limit: hops are followed down to a fixed duration; in a long run of impacts the limit increases, up to the step.
double EventDrivenMotion::zeno_limit(std::uint32_t i) const {
    const int excess = std::max(0, events_[i].impacts_in_row - impacts_before_zeno_growth) / 8;
    return std::min(h_, std::ldexp(shortest_hop, std::min(excess, 60)));
}

// True if the body's last hop was below the Zeno limit, for any cause of its return. Measured, because the formula of a
// contact's acceleration does not include edges that rotate against each other.
bool EventDrivenMotion::below_zeno_limit(std::uint32_t i, const std::vector<Body>& bodies, double speed) const {
    const BodyEvent& f = events_[i];
    return f.impacts_in_row > impacts_before_zeno_check && f.since_impact < zeno_limit(i) &&
           speed * f.since_impact < tuning::impact_touch * bodies[i].radius;
}

// Fast path for the most frequent impacts: two frictionless balls, or a ball and a fixed half-space, with no other body
// near. Eq. 20 with r x n = 0. Returns false for any other impact.
bool EventDrivenMotion::bounce_balls(std::uint32_t i, std::uint32_t j, const std::vector<Body>& bodies,
                                     const EventTime& now) {
    const Body &a = bodies[i], &b = bodies[j];
    const auto* ball = std::get_if<Ball>(&a.collider);
    const auto* other_ball = std::get_if<Ball>(&b.collider);
    const HalfSpaceFilter* plane = half_spaces_[j].valid ? &half_spaces_[j] : nullptr;
    if (!ball || !a.flying || events_[i].driven || pair_friction(a, b) > 0.0) return false;
    if (!plane && !(other_ball && b.flying && !events_[j].driven)) return false;
    const double ta = clock_.between(events_[i].start, now), tb = clock_.between(events_[j].start, now);
    const Vec3 at = events_[i].path.position(ta), va = events_[i].path.velocity(ta);
    const Vec3 vb = other_ball ? events_[j].path.velocity(tb) : Vec3(Vec3::Zero());
    const Vec3 n = other_ball ? Vec3((events_[j].path.position(tb) - at).normalized()) : Vec3(-plane->normal);
    const double v = n.dot(vb - va), e = pair_restitution(a, b);
    if (!(v < 0.0)) return false;
    const double press = plane ? -n.dot(a.fall(settings_.gravity)) : 0.0;
    if (press < 0.0 && -2.0 * e * v < -press * zeno_limit(i)) return false;  // this one switches to contact
    if (!alone(i, j, at, bodies, now) || (other_ball && !alone(j, i, events_[j].path.position(tb), bodies, now)))
        return false;
    const double impulse = -(1.0 + e) * v / (a.inverse_mass + b.inverse_mass);
    if (log_) {
        Contact contact;
        contact.a = i;
        contact.b = j;
        contact.normal = n;
        contact.arm_a = ball->radius * n;
        contact.arm_b = -(other_ball ? other_ball->radius : 0.0) * n;
        const double after = v + impulse * (a.inverse_mass + b.inverse_mass);
        const Vec3 there = other_ball ? events_[j].path.position(tb) : b.position;
        const auto struck = [&](std::uint32_t k, double t, const Vec3& place, const Vec3& velocity,
                                const Vec3& change) -> StruckBody {
            const Vec3& spin = bodies[k].angular_velocity;
            return {place, events_[k].path.orientation(t), velocity, velocity + change, spin, spin};
        };
        log_->add_entry({0, 0, v, after, e, impulse}, contact, at + contact.arm_a, bodies, impact_time(now),
                        struck(i, ta, at, va, -(a.inverse_mass * impulse) * n),
                        struck(j, tb, there, vb, (b.inverse_mass * impulse) * n));
        const auto deflect = [&](std::uint32_t k, const Vec3& place, const Vec3& velocity, const Vec3& change) {
            log_->end_flight(k, bodies[k], place, bodies[k].mass * velocity);
            log_->start_flight(k, bodies[k], place, bodies[k].mass * (velocity + change));
        };
        deflect(i, at, va, -(a.inverse_mass * impulse) * n);
        if (other_ball) deflect(j, events_[j].path.position(tb), vb, (b.inverse_mass * impulse) * n);
    }
    start(i, events_[i].path.deflected(ta, va - (a.inverse_mass * impulse) * n), now, never);
    changed_.push_back(i);
    if (other_ball) {
        start(j, events_[j].path.deflected(tb, vb + (b.inverse_mass * impulse) * n), now, never);
        changed_.push_back(j);
    }
    predict_changed(bodies, now);
    return true;
}

// True if no third body can touch the ball at `at`.
bool EventDrivenMotion::alone(std::uint32_t i, std::uint32_t but, const Vec3& at, const std::vector<Body>& bodies,
                              const EventTime& now) const {
    const double r = bodies[i].radius * (1.0 + tuning::touch);
    for (const std::uint32_t k : neighbor_boxes_.moving(i)) {
        if (k == but) continue;
        const double reach = r + bodies[k].radius * (1.0 + tuning::touch);
        const Ballistic& ball = balls_[k];
        const Vec3 there = ball.valid ? position(ball, roughly(ball.start, now))
                                      : events_[k].path.position(clock_.between(events_[k].start, now));
        if ((there - at).squaredNorm() <= reach * reach) return false;
    }
    for (const std::uint32_t k : neighbor_boxes_.fixed(i)) {
        if (k == but) continue;
        const Body& body = bodies[k];
        if (half_spaces_[k].valid) {
            if (half_spaces_[k].normal.dot(at) - half_spaces_[k].offset <= r) return false;
        } else if ((body.position - at).norm() <= r + body.radius) {
            return false;
        }
    }
    return true;
}

void EventDrivenMotion::collide(std::uint32_t i, std::uint32_t j, std::vector<Body>& bodies, SleepMonitor& sleep,
                                const ForceField& forces, const EventTime& now) {
    count_impact(i, bodies, now);
    if (bodies[j].dynamic()) count_impact(j, bodies, now);
    const ImpactCluster::Bring bring_body{[&](std::uint32_t k) { bring(k, bodies, now); },
                                          [&](std::uint32_t k) { return whereabouts(k, bodies, now); }};
    if (bounce_balls(i, j, bodies, now)) return;
    // Where bodies in contact meet, slow approaches do not bounce, as at a step.
    const bool meeting = meets(i, j, now);
    if (meeting)
        for (const std::uint32_t k : {i, j}) events_[k].meetings += bodies[k].dynamic();
    const double slow = tuning::restitution_threshold * settings_.gravity.norm() * h_, threshold = meeting ? slow : 0.0;
    const auto load = [&](const Contact& c, const Gap& gap) {
        if (bodies[c.a].flying || bodies[c.b].flying) return 0.0;
        return std::max(0.0, -h_ * pressing_acceleration(c, gap, bodies, free_motion(forces, now), supports_));
    };
    if (meeting) support_stepped(bodies);
    const BlowResult* blow = nullptr;
    ImpactCluster::Strike strike;
    if (strike_)
        strike = [&](const Island& island, const std::vector<Contact>& contacts, const ImpactSettings& settings) {
            return (blow = strike_(island, contacts, settings, impact_time(now))) != nullptr;
        };
    const bool changed =
        cluster_.resolve(i, j, bodies, neighbor_boxes_, bring_body, meeting ? ImpactCluster::LoadSpeed(load) : nullptr,
                         {.threshold = threshold,
                          .law = settings_.impact_law,
                          .resting = slow,
                          .friction = true,
                          .complete = true,
                          .span = h_},
                         log_ ? &trace_ : nullptr, strike);
    if (cluster_.broke()) return break_bodies(*blow, bodies, sleep, forces, now);
    if (log_ && changed)
        log_->add_impact(trace_, cluster_.contacts(), bodies, impact_time(now), cluster_.joint_impulses());
    if (!changed && meeting) {  // no more of these in this step
        events_[i].meetings = tuning::meetings_in_step;
        changed_.push_back(i);
        hold_receivers(bodies, forces, now);
        predict_changed(bodies, now);
        return;
    }
    if (!changed) {
        // Touching without approaching, by rounding: checked again after a while, which grows each time, but before a
        // harmful overlap is possible.
        BodyEvent& f = events_[i];
        f.event = BodyEvent::Event::recheck;
        const double harmless = harmless_time(moving_body(i, bodies, now), moving_body(j, bodies, now));
        queue_.set(i, later(now, std::min({h_, harmless, std::ldexp(shortest_hop, std::min(f.impacts_in_row, 60))})));
        return;
    }
    for (const std::uint32_t k : cluster_.impulse_receivers()) {
        if (bodies[k].asleep) wake(k, bodies, sleep, now);
        events_[k].spin = unknown;
        changed_.push_back(k);
    }
    if (meeting) changed_.push_back(i);  // its trajectory ends here, whether or not the impulse has reached it
    if (!groups_.empty()) end_group_flights(bodies, now);
    release_receivers(bodies, forces, now);
    switch_to_contact(bodies, forces, now);
    sort_unique(changed_);
    if (!groups_.empty()) fly_groups(bodies, forces, now);
    fly_changed(bodies, forces, now);
    hold_receivers(bodies, forces, now);
    predict_changed(bodies, now);
}

bool HalfSpaceFilter::stays_below(const Trajectory& path, double radius, double from, double horizon) const {
    if (!path.parabolic()) return false;
    const double height = normal.dot(path.position(from)) - offset - radius;
    const double rate = normal.dot(path.velocity(from)), acceleration = normal.dot(path.acceleration(from));
    if (!(height > tuning::touch * radius)) return false;
    if (acceleration > 0.0) return rate >= 0.0;
    return height + horizon * (rate + 0.5 * horizon * acceleration) > 0.0;
}

}  // namespace tumble
