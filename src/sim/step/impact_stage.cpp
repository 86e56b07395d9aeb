#include "sim/step/impact_stage.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/contact/model/free_motion.h"
#include "sim/contact/model/settings.h"
#include "sim/dynamics/integrators/advance.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/geometry/contact_tolerance.h"
#include "sim/impact/joint_strength.h"
#include "sim/impact/settings.h"
#include "sim/joints/joint_set.h"
#include "sim/log/contact_log.h"
#include "sim/step/contact_detection.h"
#include "sim/step/step_context.h"
#include "sim/threads/thread_pool.h"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// Approaches below this share of the restitution threshold, a quarter of gravity's g h, take no part in impacts of
/// more contacts than that. In a heap a sixth of the approaching contacts is left, in small groups that are solved
/// exactly. Related test: ContactEnergy.BouncesInAHeapPushNoBodyAlong.
constexpr double impact_slow = 0.125;

// True if touching points with restitution approach faster than resting contact does.
bool collides(std::size_t island, ContactDetection& detection, const StepContext& step, double threshold) {
    const std::vector<Body>& bodies = step.set.bodies;
    const auto touching = detection.islands().pairs(island);
    for (std::size_t k = 0; k < touching.size(); ++k) {
        const Body &a = bodies[touching[k].a], &b = bodies[touching[k].b];
        if (pair_restitution(a, b) <= 0.0) continue;
        const Manifold& m = detection.manifolds()[detection.islands().manifolds(island)[k]];
        const double touch = touch_distance(a.radius, b.radius);
        for (int i = 0; i < m.count; ++i) {
            const ContactPoint& p = m.points[std::size_t(i)];
            if (p.separation > touch) continue;
            const double speed = relative_velocity(p, m.normal, a, b);
            if (speed < -threshold &&
                speed < -tuning::restitution_threshold * load_speed(m, i, a, b, step.free_motion()))
                return true;
        }
    }
    return false;
}

}  // namespace

Island island_of(std::size_t k, const ContactIslands& islands, JointSet& joints) {
    Island island;
    island.bodies.assign(islands.bodies(k).begin(), islands.bodies(k).end());
    island.all_joints = joints.joints();
    for (const std::uint32_t j : islands.joints(k)) {
        Joint& joint = joints.joints()[joints.active()[j]];
        if (!joint.broken) island.joints.push_back(&joint);
    }
    return island;
}

double ImpactStage::threshold(const StepContext& step) { return tuning::restitution_threshold * step.gravity_speed(); }

void ImpactStage::resolve(const StepContext& step, ContactDetection& detection) {
    std::vector<Body>& bodies = step.set.bodies;
    struck_.clear();
    colliding_.clear();
    contacts_.clear();
    for (std::size_t k = 0; k < detection.islands().size(); ++k)
        if (collides(k, detection, step, threshold(step))) add_island(k, step, detection);
    if (struck_.empty()) return;
    traces_.assign(step.log ? colliding_.size() : 0, {});
    joint_impulses_.assign(colliding_.size(), {});
    step.pool.for_each(colliding_.size(), tuning::parallel_grain,
                       [&](std::size_t i, std::size_t) { resolve_island(step, i); });
    for (std::size_t i = 0; i < traces_.size(); ++i)
        step.log->add_impact(traces_[i], contacts_, bodies, step.impact_time(), joint_impulses_[i]);
    // Eqs. 9 and 10: the contribution of the impulses to P and L, equal and opposite to the last bit.
    for (const Contact& c : contacts_)
        if (c.impact > 0.0) add_impact(c, bodies[c.a], bodies[c.b]);
    for (const std::vector<JointImpulse>& joint_impulses : joint_impulses_)
        for (const JointImpulse& impulse : joint_impulses) apply_joint_impulse(impulse, bodies);
}

void ImpactStage::add_island(std::size_t k, const StepContext& step, ContactDetection& detection) {
    const ContactIslands& islands = detection.islands();
    const std::vector<Manifold>& manifolds = detection.manifolds();
    Island& island = colliding_.emplace_back(island_of(k, islands, step.joints));
    const std::size_t first = contacts_.size(), first_struck = struck_.size();
    for (const std::uint32_t m : islands.manifolds(k)) {
        Struck& struck = struck_.emplace_back(Struck{m, normal_impulse(manifolds[m]), 0.0});
        add_contacts_under_load(manifolds[m], step, struck);
    }
    if (!spread_load(first, first_struck, step)) {
        contacts_.resize(first);
        struck_.resize(first_struck);
        colliding_.pop_back();
        return;
    }
    for (std::size_t i = first; i < contacts_.size(); ++i) island.contacts.push_back(std::uint32_t(i));
}

// A load reaches contacts of its island that carried none in the last step. Returns whether any still collides.
bool ImpactStage::spread_load(std::size_t first, std::size_t first_struck, const StepContext& step) {
    double most = 0.0;
    for (std::size_t i = first_struck; i < struck_.size(); ++i) most = std::max(most, struck_[i].load_speed);
    const double least = tuning::load_left * most;
    if (tuning::restitution_threshold * least <= threshold(step)) return true;
    for (std::size_t i = first_struck; i < struck_.size(); ++i)
        struck_[i].load_speed = std::max(struck_[i].load_speed, least);
    bool any = false;
    for (std::size_t i = first; i < contacts_.size(); ++i) {
        Contact& c = contacts_[i];
        if (!c.touching()) continue;
        c.load_speed = std::max(c.load_speed, least);
        const double speed = relative_velocity(c, step.set.bodies[c.a], step.set.bodies[c.b]);
        any = any || (c.restitution > 0.0 && speed < -least_impact(c, threshold(step)));
    }
    return any;
}

void ImpactStage::add_contacts_under_load(const Manifold& m, const StepContext& step, Struck& struck) {
    const std::vector<Body>& bodies = step.set.bodies;
    const FreeMotion free = step.free_motion();
    const std::size_t first = contacts_.size();
    add_contacts(m, bodies, contacts_);
    for (std::size_t i = first; i < contacts_.size(); ++i) {
        Contact& c = contacts_[i];
        if (!c.touching()) continue;
        c.load_speed = load_speed(m, int(i - first), bodies[c.a], bodies[c.b], free);
        struck.load_speed = std::max(struck.load_speed, c.load_speed);
    }
}

ImpactSettings ImpactStage::settings(const StepContext& step) {
    return {.threshold = threshold(step),
            .slow = impact_slow * threshold(step),
            .law = step.settings.impact_law,
            .resting = impact_slow * threshold(step),
            .friction = true,
            .span = step.h};
}

// Impacts of too much work are left to the contact solver.
void ImpactStage::resolve_island(const StepContext& step, std::size_t index) {
    const ImpactSettings impacts = settings(step);
    Island& island = colliding_[index];
    ImpactTrace* trace = step.log ? &traces_[index] : nullptr;
    if (island.joints.empty()) {
        resolve_impacts(island, contacts_, step.set.bodies, impacts, trace);
        return;
    }
    std::vector<Joint*> broken;
    resolve_breaking(island, contacts_, step.set.bodies, impacts, trace, joint_impulses_[index], broken);
    for (Joint* joint : broken) {
        joint->broken = true;
        joint->broken_at = step.end();
        std::erase(island.joints, joint);
    }
    drop_loose_gears(island);
}

void ImpactStage::hold_bounces(const StepContext& step) {
    std::vector<Body>& bodies = step.set.bodies;
    step.pool.for_each(colliding_.size(), tuning::parallel_grain, [&](std::size_t i, std::size_t) {
        tumble::hold_bounces(colliding_[i], contacts_, bodies, threshold(step));
        // No contact holds a body that only bounces: it rotates as in flight, which adds nothing to its spin.
        for (const std::uint32_t k : colliding_[i].bodies) {
            if (!advances_whole_state(bodies[k].integrator)) step.forces.accept(k, step.set);
            if (bodies[k].integrator != IntegratorKind::explicit_euler) find_gyration(bodies[k], step.h);
        }
    });
}

void ImpactStage::limit_warm_start(const StepContext& step, ContactDetection& detection) const {
    const std::vector<Body>& bodies = step.set.bodies;
    for (const Struck& struck : struck_) {
        Manifold& m = detection.manifolds()[struck.manifold];
        double lighter = std::numeric_limits<double>::infinity();
        for (const std::uint32_t i : {m.a, m.b})
            if (bodies[i].dynamic()) lighter = std::min(lighter, bodies[i].mass);
        const double speed = std::max(struck.load_speed, step.gravity_speed());
        const double sum = normal_impulse(m), most = 2.0 * std::max(struck.impulse_before, lighter * speed);
        if (sum > most) scale_impulses(m, most / sum);
    }
}

}  // namespace tumble
