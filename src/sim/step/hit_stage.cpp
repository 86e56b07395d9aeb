#include "sim/step/hit_stage.h"

#include "sim/ccd/settings.h"
#include "sim/contact/model/contact_constraint.h"
#include "sim/contact/model/free_motion.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/geometry/contact_tolerance.h"
#include "sim/impact/impact_laws.h"
#include "sim/impact/settings.h"
#include "sim/log/contact_log.h"
#include "sim/step/contact_detection.h"
#include "sim/step/impact_stage.h"
#include "sim/step/step_context.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Calls `use` for each pair of bodies in the island, with the indices of its manifolds.
template <class Use>
void each_pair(const HitIsland& island, Use&& use) {
    for (std::size_t from = 0, to = 0; from < island.pairs.size(); from = to) {
        const BodyPair& pair = island.pairs[from];
        while (to < island.pairs.size() && island.pairs[to] == pair) ++to;
        use(pair, island.manifolds.subspan(from, to - from));
    }
}

bool ball(const Body& body) { return std::holds_alternative<Ball>(body.collider); }
bool curved(const Body& body) { return std::holds_alternative<std::shared_ptr<const CurvedBody>>(body.collider); }
bool solid(const Body& body) {
    return std::holds_alternative<std::shared_ptr<const Polyhedron>>(body.collider) || curved(body);
}
bool flat(const Body& body) { return std::holds_alternative<HalfSpace>(body.collider) && !body.moves(); }

// A hit is looked for where points have moved in the step by more than this share of the smaller radius.
constexpr double least_way = 0.002;
// It is resolved at its own time if its normal differs from the present one by an angle whose cosine is below 1 minus
// this: 1e-6 rad for curved surfaces, half a degree for faces.
constexpr double least_turn_of_curve = 1e-12;
constexpr double least_turn = 3.8e-5;
// Body pairs of an island, up to which balls hit edges at their own times. Limits the cost.
constexpr std::size_t most_pairs_of_edges = 16;
// Contacts of a hit, and hits of a step for each manifold of an island: they limit the cost. Beyond, the impact is that
// of the step's end.
constexpr std::size_t most_contacts = 64;
constexpr std::size_t most_hits_each = 4;

// Two bodies whose hits have their own times. In a crowd of bodies with faces the motion depends on many contacts: the
// impact at the end of the step costs less, and its error does not show.
bool takes_part(const Body& a, const Body& b, std::size_t pairs) {
    if (a.jointed || b.jointed || a.breakable || b.breakable || flat(a) || flat(b)) return false;
    if (ball(a) && ball(b)) return true;
    if (ball(a) || ball(b)) return pairs <= most_pairs_of_edges;
    // Faces without restitution stop at the surface.
    return pairs == 1 && solid(a) && solid(b) && pair_restitution(a, b) > 0.0;
}

// True if the pair is new in contact, overlaps, and came so far in the step that its normal may be out of date.
bool may_have_met(std::span<const std::uint32_t> pair, const std::vector<Manifold>& manifolds, const Body& a,
                  const Body& b, const StepContext& step, double threshold) {
    for (const std::uint32_t k : pair)
        if (normal_impulse(manifolds[k]) > 0.0) return false;
    const double touch = touch_distance(a.radius, b.radius), least = least_way * std::min(a.radius, b.radius);
    for (const std::uint32_t k : pair) {
        const Manifold& m = manifolds[k];
        for (int i = 0; i < m.count; ++i) {
            const ContactPoint& p = m.points[std::size_t(i)];
            if (p.separation >= -touch) continue;
            const double speed = -relative_velocity(p, m.normal, a, b);
            if (!(speed > threshold)) continue;
            const BodyVelocity &of_a = step.set.motions[m.a], &of_b = step.set.motions[m.b];
            const Vec3 motion = of_b.velocity + of_b.angular_velocity.cross(p.position - b.position) - of_a.velocity -
                                of_a.angular_velocity.cross(p.position - a.position);
            const double way = step.h * motion.norm();
            if (way > std::min(depth(a.collider), depth(b.collider))) return false;  // CCD stops it where they meet
            if (way > least && motion.dot(m.normal) < 0.0 &&
                speed > tuning::restitution_threshold * load_speed(m, i, a, b, step.free_motion()))
                return true;
        }
    }
    return false;
}

// True if a normal of the hit differs from the normal of the overlapped pose.
bool differ(const std::vector<Manifold>& then, const Manifold& now, bool of_curves) {
    const bool exactly = now.count == 1 && (now.corners == Corners::neither || of_curves);
    const double least = exactly ? least_turn_of_curve : least_turn;
    return std::any_of(then.begin(), then.end(),
                       [&](const Manifold& m) { return m.normal.dot(now.normal) < 1.0 - least; });
}

void set_pose(Body& body, const Vec3& position, const Quat& orientation) {
    body.position = position;
    body.orientation = orientation;
    body.rotation = orientation.toRotationMatrix();
    if (body.dynamic()) body.derive();
}

// The body `lag` s before the end of the step, on its way.
void go_back(Body& body, const BodyVelocity& way, double lag) {
    if (!body.moves()) return;
    set_pose(body, body.position - lag * way.velocity,
             (from_rotation_vector(-lag * way.angular_velocity) * body.orientation).normalized());
}

bool loaded(std::uint32_t body, const HitIsland& island, const std::vector<Manifold>& manifolds) {
    return std::any_of(island.manifolds.begin(), island.manifolds.end(), [&](std::uint32_t k) {
        const Manifold& m = manifolds[k];
        return (m.a == body || m.b == body) && normal_impulse(m) > 0.0;
    });
}

// Impulse of the forces in the last `lag` s. The path of the Euler methods is a polygon on the parabola of the flight:
// its velocity is that of the middle of the step.
Impulse late_forces(std::uint32_t k, const StepContext& step, double lag) {
    const Body& body = step.set.bodies[k];
    const Wrench wrench = step.forces.field().throughout(k, body, step.clock.seconds(step.index - 1), step.start());
    const double span = body.flew ? lag : lag - 0.5 * step.h;
    return {span * wrench.force, span * wrench.torque};
}

}  // namespace

bool HitStage::resolve(const StepContext& step, ContactDetection& detection) {
    const ContactIslands& islands = detection.islands();
    bool any = false;
    for (std::size_t k = 0; k < islands.size(); ++k)
        if (resolve_island({islands.pairs(k), islands.manifolds(k), islands.touching_pairs(k)}, detection.manifolds(),
                           step))
            any = true;
    return any;
}

// Resolves the hits of an island in the order of their times.
bool HitStage::resolve_island(const HitIsland& island, const std::vector<Manifold>& manifolds,
                              const StepContext& step) {
    const std::vector<Body>& bodies = step.set.bodies;
    const double threshold = ImpactStage::threshold(step);
    movers_.clear();
    hits_.clear();
    each_pair(island, [&](const BodyPair& m, std::span<const std::uint32_t> pair) {
        const Body &a = bodies[m.a], &b = bodies[m.b];
        if (!takes_part(a, b, island.touching_pairs) || !may_have_met(pair, manifolds, a, b, step, threshold)) return;
        const auto hit = next_hit(m.a, m.b, step);
        if (!hit || !(hit->lag < step.h)) return;
        find_touch(*hit, step);
        if (differ(found_, manifolds[pair[0]], curved(a) || curved(b))) hits_.push_back(*hit);
    });
    const std::size_t most = most_hits_each * island.manifolds.size();
    for (std::size_t count = 0; count < most && !hits_.empty(); ++count) {
        const auto first =
            std::max_element(hits_.begin(), hits_.end(), [](const Hit& x, const Hit& y) { return x.lag < y.lag; });
        const Hit hit = *first;
        hits_.erase(first);
        if (!strike(hit, island, manifolds, step)) continue;
        const auto moved = [&](std::uint32_t body) {
            return std::any_of(cluster_.begin(), cluster_.end(),
                               [&](const Member& member) { return member.struck && member.body == body; });
        };
        std::erase_if(hits_, [&](const Hit& h) { return moved(h.a) || moved(h.b); });
        each_pair(island, [&](const BodyPair& m, std::span<const std::uint32_t>) {
            if ((!moved(m.a) && !moved(m.b)) || !takes_part(bodies[m.a], bodies[m.b], island.touching_pairs)) return;
            if (const auto next = next_hit(m.a, m.b, step)) hits_.push_back(*next);
        });
    }
    return !movers_.empty();
}

HitStage::Mover HitStage::mover(std::uint32_t body, const StepContext& step) const {
    for (const Mover& m : movers_)
        if (m.body == body) return m;
    return {body, step.h, step.set.motions[body]};
}

// The next hit of two bodies after their last ones.
std::optional<HitStage::Hit> HitStage::next_hit(std::uint32_t a, std::uint32_t b, const StepContext& step) {
    const Mover on_a = mover(a, step), on_b = mover(b, step);
    const double lag = std::min(on_a.lag, on_b.lag);
    Body then_a = step.set.bodies[a], then_b = step.set.bodies[b];
    go_back(then_a, on_a.way, lag);
    go_back(then_b, on_b.way, lag);
    const Trajectory way_a = Trajectory::uniform(then_a, on_a.way.velocity, on_a.way.angular_velocity),
                     way_b = Trajectory::uniform(then_b, on_b.way.velocity, on_b.way.angular_velocity);
    const TimeOfImpact touch = search_.find({&then_a, &way_a, 0.0}, {&then_b, &way_b, 0.0}, lag);
    if (touch.kind != TimeOfImpact::Kind::impact) return std::nullopt;
    return Hit{a, b, lag - touch.time};
}

// Manifolds of the bodies as they met, in found_.
void HitStage::find_touch(const Hit& hit, const StepContext& step) {
    Body a = step.set.bodies[hit.a], b = step.set.bodies[hit.b];
    go_back(a, mover(hit.a, step).way, hit.lag);
    go_back(b, mover(hit.b, step).way, hit.lag);
    found_.clear();
    scratch_.reduced.clear();
    tumble::collide(a.collider, b.collider, {a.pose(), b.pose(), touch_distance(a.radius, b.radius), scratch_, found_});
    for (Manifold& m : found_) {
        m.a = hit.a;
        m.b = hit.b;
    }
}

// Adds a body to a hit, at its pose then.
void HitStage::join(std::uint32_t k, double lag, const HitIsland& island, const std::vector<Manifold>& manifolds,
                    const StepContext& step) {
    Body& body = step.set.bodies[k];
    Member& member = cluster_.emplace_back();
    member.body = k;
    member.position = body.position;
    member.orientation = body.orientation;
    member.rotation = body.rotation;
    member.momentum = body.momentum;
    member.angular_momentum = body.angular_momentum;
    if (!body.moves()) return;
    const BodyVelocity way = mover(k, step).way;
    if (body.dynamic()) {
        if (!loaded(k, island, manifolds)) member.late = late_forces(k, step, lag);
        body.momentum -= member.late.linear;
        body.angular_momentum -= member.late.angular;
    } else {
        member.velocity = {body.velocity, body.angular_velocity};
        body.velocity = way.velocity;
        body.angular_velocity = way.angular_velocity;
    }
    go_back(body, way, lag);
    member.momentum_then = body.momentum;
    member.angular_momentum_then = body.angular_momentum;
}

void HitStage::leave(const Member& member, std::vector<Body>& bodies) {
    Body& body = bodies[member.body];
    if (!body.moves()) return;
    body.momentum = member.momentum;
    body.angular_momentum = member.angular_momentum;
    body.position = member.position;
    body.orientation = member.orientation;
    body.rotation = member.rotation;
    if (body.dynamic()) {
        body.derive();
    } else {
        body.velocity = member.velocity.velocity;
        body.angular_velocity = member.velocity.angular_velocity;
    }
}

// Goes on for the rest of the step after a hit, but not so far that it could pass a body that is not in its island.
void HitStage::go_on(const Member& member, double rest, const StepContext& step) {
    Body& body = step.set.bodies[member.body];
    const Quat from = body.orientation;
    body.momentum += member.late.linear;
    body.derive_velocities();
    const double speed = body.velocity.norm() + (ball(body) ? 0.0 : body.radius * body.angular_velocity.norm());
    const double far = tuning::fast_share * depth(body.collider), lag = rest * speed > far ? far / speed : rest;
    body.position += lag * body.velocity;
    turn_freely(body, from, lag);
    body.angular_momentum += member.late.angular;
    body.derive();
    const Vec3 turn =
        lag > 0.0 ? Vec3(rotation_vector(body.orientation * from.conjugate()) / lag) : body.angular_velocity;
    std::erase_if(movers_, [&](const Mover& m) { return m.body == member.body; });
    movers_.push_back({member.body, lag, {body.velocity, turn}});
}

// Contacts of two bodies at a hit. Returns whether there are any.
bool HitStage::add_touching(std::uint32_t a, std::uint32_t b, std::span<const std::uint32_t> pair,
                            const std::vector<Manifold>& manifolds, const StepContext& step) {
    const std::vector<Body>& bodies = step.set.bodies;
    const Body &on_a = bodies[a], &on_b = bodies[b];
    const double near = touch_distance(on_a.radius, on_b.radius), reach = on_a.radius + on_b.radius + near;
    if (std::isfinite(reach) && (on_b.position - on_a.position).squaredNorm() > reach * reach) return false;
    found_.clear();
    scratch_.reduced.clear();
    tumble::collide(on_a.collider, on_b.collider, {on_a.pose(), on_b.pose(), near, scratch_, found_});
    double load = 0.0;
    for (const std::uint32_t k : pair)
        for (int i = 0; i < manifolds[k].count; ++i)
            load = std::max(load, load_speed(manifolds[k], i, on_a, on_b, step.free_motion()));
    for (Manifold& m : found_) {
        m.a = a;
        m.b = b;
        add_contacts(m, bodies, contacts_);
    }
    for (Contact& c : std::span(contacts_).last(contacts_.size() - first_of_pair_)) c.load_speed = load;
    first_of_pair_ = contacts_.size();
    return !found_.empty();
}

// The bodies that touch one of the cluster, and their contacts. Returns false for more bodies than an impact should
// have.
bool HitStage::gather(const Hit& hit, const HitIsland& island, const std::vector<Manifold>& manifolds,
                      const StepContext& step) {
    cluster_.clear();
    contacts_.clear();
    first_of_pair_ = 0;
    join(hit.a, hit.lag, island, manifolds, step);
    join(hit.b, hit.lag, island, manifolds, step);
    const std::vector<Body>& bodies = step.set.bodies;
    const auto joined = [&](std::uint32_t body) {
        return std::any_of(cluster_.begin(), cluster_.end(), [&](const Member& m) { return m.body == body; });
    };
    const auto grows = [&](std::uint32_t body) { return bodies[body].dynamic() && joined(body); };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> seen;
    for (bool more = true; more;) {
        more = false;
        each_pair(island, [&](const BodyPair& m, std::span<const std::uint32_t> pair) {
            const std::uint32_t a = m.a, b = m.b;
            if ((!grows(a) && !grows(b)) || std::find(seen.begin(), seen.end(), std::pair(a, b)) != seen.end()) return;
            seen.push_back({a, b});
            const bool new_a = !joined(a), new_b = !joined(b);
            if (new_a) join(a, hit.lag, island, manifolds, step);
            if (new_b) join(b, hit.lag, island, manifolds, step);
            if (add_touching(a, b, pair, manifolds, step)) {
                more = more || new_a || new_b;
            } else if (new_a || new_b) {
                leave(cluster_.back(), step.set.bodies);
                cluster_.pop_back();
            }
        });
        if (contacts_.size() > most_contacts) return false;
    }
    return std::none_of(cluster_.begin(), cluster_.end(), [&](const Member& m) { return bodies[m.body].jointed; });
}

// Resolves the impact of a hit. Returns whether it was one; otherwise the bodies stay as they are.
bool HitStage::strike(const Hit& hit, const HitIsland& island, const std::vector<Manifold>& manifolds,
                      const StepContext& step) {
    std::vector<Body>& bodies = step.set.bodies;
    const double threshold = ImpactStage::threshold(step);
    const bool curved = ball(bodies[hit.a]) || ball(bodies[hit.b]);
    const bool whole = gather(hit, island, manifolds, step);
    const ImpactSettings settings{.threshold = threshold,
                                  .law = step.settings.impact_law,
                                  .resting = threshold,
                                  .friction = true,
                                  .complete = curved,
                                  .span = step.h};
    const auto approaches = [&](const Contact& c) {
        return c.a == hit.a && c.b == hit.b &&
               relative_velocity(c, bodies[c.a], bodies[c.b]) < -least_impact(c, threshold);
    };
    Island impact;
    for (const Member& member : cluster_)
        if (bodies[member.body].dynamic()) impact.bodies.push_back(member.body);
    std::sort(impact.bodies.begin(), impact.bodies.end());
    for (std::uint32_t i = 0; i < contacts_.size(); ++i) impact.contacts.push_back(i);
    ImpactTrace trace;
    const bool any = whole && std::any_of(contacts_.begin(), contacts_.end(), approaches) &&
                     resolve_impacts(impact, contacts_, bodies, settings, step.log ? &trace : nullptr) > 0;
    if (any && step.log) step.log->add_impact(trace, contacts_, bodies, step.time_before_start(hit.lag));
    if (any)
        for (const Contact& c : contacts_)
            if (c.impact > 0.0) add_impact(c, bodies[c.a], bodies[c.b]);
    for (Member& member : cluster_) {
        Body& body = bodies[member.body];
        member.struck = body.dynamic() && (body.momentum != member.momentum_then ||
                                           body.angular_momentum != member.angular_momentum_then);
        if (member.struck)
            go_on(member, hit.lag, step);
        else
            leave(member, bodies);
    }
    return any;
}

}  // namespace tumble
