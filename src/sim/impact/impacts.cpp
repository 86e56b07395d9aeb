#include "sim/impact/impacts.h"

#include "sim/impact/active_set.h"
#include "sim/impact/impact_friction.h"

#include <algorithm>
#include <deque>
#include <utility>

namespace tumble {
namespace {

/// Largest number of products of an impact of joined bodies, contacts squared times the numbers of a group: about 30
/// ms. Beyond, the solver of contacts bounces them. Limits the cost.
constexpr double impact_joined_work = 3e7;

/// Rounds of friction with restitution for the contacts that friction makes approach again, and rounds in all. Not
/// fitted: bounds of the cost.
constexpr int friction_bounces = 4;
constexpr int friction_rounds = 12;

// Most steps of most islands have no impact: this is decided from the contacts alone.
bool may_collide(const Island& island, const std::vector<Contact>& contacts, const std::vector<Body>& bodies,
                 const ImpactSettings& settings) {
    for (const std::uint32_t k : island.contacts) {
        const Contact& c = contacts[k];
        if (!c.touching()) continue;
        const double u = relative_velocity(c, bodies[c.a], bodies[c.b]);
        if (settings.complete ? u < 0.0 : u < -least_impact(c, settings.threshold) && c.restitution > 0.0) return true;
    }
    return false;
}

bool approaching(const ImpactSystem& cluster) {
    for (std::size_t i = 0; i < cluster.size(); ++i)
        if (cluster.approaching(i)) return true;
    return false;
}

int resolve_normally(ImpactSystem& cluster, const ImpactSettings& settings) {
    const int passes = settings.law == ImpactLaw::propagating
                           ? propagate(cluster, settings.threshold, settings.slow, settings.resting)
                           : resolve_together(cluster, settings.threshold);
    if (!settings.complete || !approaching(cluster)) return passes;
    stop(cluster);
    return passes + 1;
}

// Friction changes the normal impulses as well: the change belongs to the contact's last pass. Where it would make that
// pass's impulse negative, the passes before share it.
void complete_trace(const ImpactSystem& cluster, ImpactTrace& trace) {
    for (std::size_t i = 0; i < cluster.contacts(); ++i) {
        double rest = cluster.impulse(i);
        ImpactTrace::Entry* last = nullptr;
        for (ImpactTrace::Entry& entry : trace.entries) {
            if (entry.contact != cluster.contact_index(i)) continue;
            rest -= entry.impulse;
            last = &entry;
        }
        if (!last && !(cluster.impulse(i) > 0.0)) continue;
        if (!last) {
            trace.entries.push_back({cluster.contact_index(i), trace.passes, 0.0, 0.0, 0.0, 0.0});
            last = &trace.entries.back();
        }
        if (last->impulse + rest != last->impulse) last->speed_after = cluster.speed(i);
        for (auto entry = trace.entries.rbegin(); entry != trace.entries.rend() && rest != 0.0; ++entry) {
            if (entry->contact != cluster.contact_index(i)) continue;
            const double change = std::max(rest, -entry->impulse);
            entry->impulse += change;
            rest -= change;
        }
    }
}

// Friction may rotate a body so that it approaches again: then the impact continues, with friction's disc enlarged
// accordingly. The rounds are bounded, the later ones are without restitution; at the end nothing approaches.
void add_friction(ImpactSystem& cluster, const ImpactSettings& settings, ImpactFriction& friction) {
    for (int round = 0; round < friction_rounds; ++round) {
        if (!friction.apply(cluster) || !approaching(cluster)) return;
        if (round < friction_bounces)
            resolve_normally(cluster, settings);
        else
            stop(cluster);
    }
}

}  // namespace

int resolve_impacts(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies,
                    const ImpactSettings& settings, ImpactTrace* trace, std::vector<JointImpulse>* joint_impulses) {
    if (!may_collide(island, contacts, bodies, settings)) return 0;
    ImpactSystem cluster(island, contacts, bodies, trace);
    if (!island.joints.empty() && cluster.work() > impact_joined_work) return too_large;
    const int passes = resolve_normally(cluster, settings);
    if (passes == 0) return 0;
    if (settings.friction) {
        ImpactFriction friction(
            cluster, settings.complete ? ImpactFriction::Precision::last_digits : ImpactFriction::Precision::step);
        // At a step, contacts that friction makes approach again are left to the solver of resting contact.
        if (settings.complete)
            add_friction(cluster, settings, friction);
        else
            friction.apply(cluster);
        friction.store(cluster, contacts);
    }
    std::vector<JointImpulse> of_joints = cluster.store(contacts, bodies);
    if (joint_impulses) *joint_impulses = std::move(of_joints);
    if (trace) complete_trace(cluster, *trace);
    return passes;
}

void hold_bounces(const Island& island, const std::vector<Contact>& contacts, std::vector<Body>& bodies,
                  double threshold) {
    Island bounced;
    for (const std::uint32_t k : island.contacts) {
        const Contact& c = contacts[k];
        // An impulse through a contact at rest may leave it parting by rounding, which is not a bounce.
        if (!(c.impact > 0.0 && c.bounce_velocity > 0.5 * c.restitution * least_impact(c, threshold) &&
              c.restitution > 0.0))
            continue;
        if (bodies[c.a].flew || bodies[c.b].flew) continue;
        bounced.contacts.push_back(k);
        for (const std::uint32_t i : {c.a, c.b})
            if (bodies[i].dynamic()) bounced.bodies.push_back(i);
    }
    if (bounced.contacts.empty()) return;
    if (!island.joints.empty()) {
        bounced.bodies = island.bodies;
        bounced.joints = island.joints;
        bounced.all_joints = island.all_joints;
    }
    std::sort(bounced.bodies.begin(), bounced.bodies.end());
    bounced.bodies.erase(std::unique(bounced.bodies.begin(), bounced.bodies.end()), bounced.bodies.end());
    ImpactSystem cluster(bounced, contacts, bodies);
    std::vector<ActiveSet::Demand> demands;
    std::vector<VelocityRow> rows = cluster.rows();
    std::vector<double> sign(cluster.contacts(), 1.0);
    std::deque<JoinedRow> joined;
    for (std::size_t i = 0; i < cluster.contacts(); ++i) {
        const double length = cluster.length(i), faster = cluster.speed(i) - cluster.contact(i).bounce_velocity;
        if (faster > cluster.rounding()) {  // from a ceiling
            sign[i] = -1.0;
            rows[i].on_a = -rows[i].on_a;
            rows[i].on_b = -rows[i].on_b;
            if (rows[i].joined) {
                joined.push_back(*rows[i].joined);
                joined.back().sign = -1.0;
                rows[i].joined = &joined.back();
            }
        }
        demands.push_back({std::uint32_t(i), sign[i] * faster / length, cluster.rounding() / length});
    }
    std::vector<double> lambda;
    ActiveSet(rows, cluster.bodies()).solve(demands, lambda);
    if (!island.joints.empty()) {
        for (std::size_t i = 0; i < cluster.contacts(); ++i)
            if (lambda[i] > 0.0) cluster.apply(i, sign[i] * lambda[i]);
        for (const JointImpulse& impulse : cluster.store_velocities(bodies)) apply_joint_impulse(impulse, bodies);
    }
    for (std::size_t i = 0; i < cluster.contacts(); ++i) {
        const Contact& c = cluster.contact(i);
        if (lambda[i] > 0.0)
            add_impulse(c, sign[i] * lambda[i] / cluster.length(i) * c.normal, bodies[c.a], bodies[c.b]);
    }
    for (const std::uint32_t i : bounced.bodies) bodies[i].derive_velocities();
}

}  // namespace tumble
