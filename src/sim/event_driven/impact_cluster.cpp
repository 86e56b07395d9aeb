#include "sim/event_driven/impact_cluster.h"

#include "sim/ccd/settings.h"
#include "sim/geometry/settings.h"
#include "sim/impact/joint_strength.h"

#include <algorithm>
#include <numeric>

namespace tumble {
namespace {

template <class T>
bool contains(const std::vector<T>& list, const T& value) {
    return std::find(list.begin(), list.end(), value) != list.end();
}

template <class T>
bool add_once(std::vector<T>& list, const T& value) {
    if (contains(list, value)) return false;
    list.push_back(value);
    return true;
}

// Contact tolerance (m) of two bodies in an impact. Bodies that rest on each other have gaps within the slop of resting
// contact.
double touch_distance(const Body& a, const Body& b) {
    const double size = std::min(a.radius, b.radius);
    const double place = std::min(a.position.cwiseAbs().maxCoeff(), b.position.cwiseAbs().maxCoeff());
    const bool held = (a.dynamic() && !a.flying) || (b.dynamic() && !b.flying);
    return (held ? tuning::touch : tuning::impact_touch) * size + 16.0 * tuning::impact_position_rounding * place;
}

// Rounding of v_rel (m/s), from the speeds whose difference it is.
double rounding(const Contact& c, const Body& a, const Body& b) {
    const auto speed = [](const Body& body, const Vec3& arm) {
        return body.velocity.norm() + body.angular_velocity.norm() * arm.norm();
    };
    return tuning::impact_speed_rounding * (speed(a, c.arm_a) + speed(b, c.arm_b));
}

}  // namespace

void ImpactCluster::touch(std::uint32_t i, std::uint32_t j, std::vector<Body>& bodies, const Bring& bring) {
    const auto pair = std::minmax(i, j);
    if (!add_once(pairs_, {pair.first, pair.second})) return;
    const Body &a = bodies[pair.first], &b = bodies[pair.second];
    if (!contains(brought_, j)) {
        if (const auto there = bring.roughly(j)) {
            const double most = a.radius + b.radius + (1.0 + widening_) * tuning::touch * std::min(a.radius, b.radius);
            if ((there->center - bodies[i].position).norm() > most + there->radius) return;
        }
        brought_.push_back(j);
        bring(j);
    }
    const double near = widening_ * touch_distance(a, b),
                 margin = std::max(near, tuning::touch * std::min(a.radius, b.radius));
    const double reach = a.radius + b.radius + margin;
    if ((b.position - a.position).squaredNorm() > reach * reach && std::isfinite(reach)) return;
    const std::size_t first = manifolds_.size();
    scratch_.reduced.clear();
    tumble::collide(a.collider, b.collider, {a.pose(), b.pose(), margin, scratch_, manifolds_});
    // Faces that meet at a negligible angle meet at once: otherwise, corner after corner, that angle alone would decide
    // their motion.
    const auto apart = [&](const Manifold& m) {
        return std::all_of(m.points.begin(), m.points.begin() + m.count,
                           [&](const ContactPoint& p) { return p.separation > near; });
    };
    manifolds_.erase(std::remove_if(manifolds_.begin() + std::ptrdiff_t(first), manifolds_.end(), apart),
                     manifolds_.end());
    for (std::size_t k = first; k < manifolds_.size(); ++k) {
        manifolds_[k].a = pair.first;
        manifolds_[k].b = pair.second;
    }
}

void ImpactCluster::expand(std::uint32_t body, std::vector<Body>& bodies, const NeighborBoxes& neighbor_boxes,
                           const Bring& bring) {
    const std::uint32_t group = groups_.group(body);
    if (group == GroupFlights::none) return expand_body(body, bodies, neighbor_boxes, bring);
    for (const std::uint32_t k : groups_.groups()[group].bodies)
        if (!contains(expanded_, k)) expand_body(k, bodies, neighbor_boxes, bring);
}

void ImpactCluster::expand_body(std::uint32_t body, std::vector<Body>& bodies, const NeighborBoxes& neighbor_boxes,
                                const Bring& bring) {
    expanded_.push_back(body);
    if (add_once(brought_, body)) bring(body);
    if (!bodies[body].dynamic()) return;
    for (const std::uint32_t other : neighbor_boxes.moving(body)) touch(body, other, bodies, bring);
    for (const std::uint32_t other : neighbor_boxes.fixed(body)) touch(body, other, bodies, bring);
}

void ImpactCluster::note_reach(const std::vector<Body>& bodies) {
    reach_.clear();
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        const Contact& c = contacts_[i];
        const Body &a = bodies[c.a], &b = bodies[c.b];
        const double least = rounding(c, a, b);
        const bool by_impulse = c.impact > 0.0 || before_[i] < -least;
        const bool by_motion = std::abs(relative_velocity(c, a, b) - before_[i]) > least;
        reach_.push_back(by_impulse ? Reach::impulse : by_motion ? Reach::motion : Reach::none);
    }
}

// True if the body has an approaching contact now: then it takes part.
bool ImpactCluster::approaches(std::uint32_t body, std::vector<Body>& bodies, const NeighborBoxes& neighbor_boxes,
                               const Bring& bring) {
    const std::size_t pairs = pairs_.size(), first = manifolds_.size(), expanded = expanded_.size();
    expand(body, bodies, neighbor_boxes, bring);
    own_.clear();
    for (std::size_t m = first; m < manifolds_.size(); ++m) add_contacts(manifolds_[m], bodies, own_);
    for (const Contact& c : own_)
        if (relative_velocity(c, bodies[c.a], bodies[c.b]) < -rounding(c, bodies[c.a], bodies[c.b])) return true;
    pairs_.resize(pairs);  // undo the query
    manifolds_.resize(first);
    expanded_.resize(expanded);
    return false;
}

// Adds all contacts of a body if
// - the body got an impulse or had an impact, even if others took all of the impulse in the end; or
// - the body is ballistic, has another impact at this time, and a body that it touches has changed its velocity.
bool ImpactCluster::grow(std::vector<Body>& bodies, const NeighborBoxes& neighbor_boxes, const Bring& bring) {
    bool grown = false;
    for (std::size_t i = 0; i < contacts_.size(); ++i)
        for (const std::uint32_t k : {contacts_[i].a, contacts_[i].b}) {
            if (reach_[i] == Reach::none || !bodies[k].dynamic() || contains(expanded_, k)) continue;
            if (reach_[i] == Reach::impulse)
                expand(k, bodies, neighbor_boxes, bring);
            else if (!bodies[k].flying || !add_once(examined_, k) || !approaches(k, bodies, neighbor_boxes, bring))
                continue;
            grown = true;
        }
    return grown;
}

// The bodies brought so far, with all others of their groups and the joints.
Island ImpactCluster::island(std::vector<Body>& bodies, const Bring& bring) {
    Island island;
    std::vector<std::uint32_t> groups;
    for (std::size_t i = 0; i < brought_.size(); ++i) {
        const std::uint32_t group = groups_.group(brought_[i]);
        if (group == GroupFlights::none || !add_once(groups, group)) continue;
        for (const std::uint32_t k : groups_.groups()[group].bodies)
            if (add_once(brought_, k)) bring(k);
    }
    if (!groups.empty()) island.all_joints = groups_.joints().joints();
    std::sort(groups.begin(), groups.end());
    for (const std::uint32_t group : groups)
        for (const std::uint32_t k : groups_.groups()[group].joints) {
            Joint& joint = groups_.joints().joints()[k];
            if (!joint.broken) island.joints.push_back(&joint);
        }
    for (const std::uint32_t k : brought_)
        if (bodies[k].dynamic()) island.bodies.push_back(k);
    std::sort(island.bodies.begin(), island.bodies.end());
    island.contacts.resize(contacts_.size());
    std::iota(island.contacts.begin(), island.contacts.end(), 0u);
    return island;
}

// An impact of too much work is one of the bodies without their joints, which answer in the next step.
void ImpactCluster::resolve_island(Island& island, std::vector<Body>& bodies, const ImpactSettings& settings,
                                   ImpactTrace* trace) {
    joint_impulses_.clear();
    broken_.clear();
    if (trace) *trace = {};
    if (island.joints.empty()) {
        resolve_impacts(island, contacts_, bodies, settings, trace);
        return;
    }
    if (resolve_breaking(island, contacts_, bodies, settings, trace, joint_impulses_, broken_) != too_large) return;
    island.joints.clear();
    resolve_impacts(island, contacts_, bodies, settings, trace);
}

bool ImpactCluster::resolve(std::uint32_t a, std::uint32_t b, std::vector<Body>& bodies,
                            const NeighborBoxes& neighbor_boxes, const Bring& bring, const LoadSpeed& load,
                            const ImpactSettings& settings, ImpactTrace* trace, const Strike& strike) {
    receivers_.clear();
    broken_.clear();
    broke_ = false;
    // If the manifold misses the contact that the search found, a wider margin finds it.
    for (widening_ = 1.0; widening_ <= 1e4 && receivers_.empty(); widening_ *= 1e2) {
        brought_.clear();
        expanded_.clear();
        examined_.clear();
        pairs_.clear();
        manifolds_.clear();
        expand(a, bodies, neighbor_boxes, bring);
        expand(b, bodies, neighbor_boxes, bring);
        Island reached;
        for (bool grown = true; grown;) {
            std::sort(manifolds_.begin(), manifolds_.end(), [](const Manifold& l, const Manifold& r) {
                return std::tie(l.a, l.b, l.part) < std::tie(r.a, r.b, r.part);
            });
            make_contacts(manifolds_, bodies, contacts_);
            make_gaps(manifolds_, bodies, gaps_);
            if (load)
                for (std::size_t i = 0; i < contacts_.size(); ++i)
                    contacts_[i].load_speed = load(contacts_[i], gaps_[i]);
            reached = island(bodies, bring);
            before_.clear();
            for (const Contact& c : contacts_) before_.push_back(relative_velocity(c, bodies[c.a], bodies[c.b]));
            resolve_island(reached, bodies, settings, trace);
            note_reach(bodies);
            for (const std::uint32_t k : reached.bodies) bodies[k].derive();  // the velocities before the impact
            grown = grow(bodies, neighbor_boxes, bring);
        }
        if (strike && strike(reached, contacts_, settings)) return broke_ = true;
        for (const Contact& c : contacts_) {
            if (c.impact <= 0.0) continue;
            add_impact(c, bodies[c.a], bodies[c.b]);
            for (const std::uint32_t k : {c.a, c.b})
                if (bodies[k].dynamic()) add_once(receivers_, k);
        }
        for (const JointImpulse& impulse : joint_impulses_) {
            if (impulse.force.isZero(0.0) && impulse.torque.isZero(0.0)) continue;
            apply_joint_impulse(impulse, bodies);
            for (const std::uint32_t k : {impulse.at->a, impulse.at->b})
                if (k != Joint::world && bodies[k].dynamic()) add_once(receivers_, k);
        }
    }
    if (!groups_.empty())
        for (std::size_t i = 0; i < receivers_.size(); ++i) {
            const std::uint32_t group = groups_.group(receivers_[i]);
            if (group == GroupFlights::none) continue;
            for (const std::uint32_t k : groups_.groups()[group].bodies) add_once(receivers_, k);
        }
    for (Joint* joint : broken_) joint->broken = true;
    std::sort(receivers_.begin(), receivers_.end());
    for (const std::uint32_t k : brought_)
        if (bodies[k].dynamic()) bodies[k].derive();
    return !receivers_.empty();
}

}  // namespace tumble
