#include "sim/step/force_stage.h"

#include "sim/ccd/ccd_clamp.h"
#include "sim/dynamics/integrator.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/log/contact_log.h"
#include "sim/step/step_context.h"
#include "sim/threads/thread_pool.h"

namespace tumble {
namespace {

BodyVelocity mean_velocity(const BodyVelocity& before, const Body& body) {
    return {0.5 * (before.velocity + body.velocity), 0.5 * (before.angular_velocity + body.angular_velocity)};
}

// Where the step's forces act, for the balance of angular momentum about a fixed point: explicit Euler moves the body
// by the old velocity, as if they acted at the end of the step.
Vec3 place_of_forces(std::uint32_t i, const StepContext& step) {
    const Body& body = step.set.bodies[i];
    if (body.integrator != IntegratorKind::explicit_euler) return body.position;
    return body.position + step.h * step.set.old_velocities[i].velocity;
}

}  // namespace

ForceStage::ForceStage(const SceneDescription& scene, const BodySet& set)
    : field_(scene, set.scene_index, set.origin),
      effects_(set.bodies.size()),
      ending_(field_.pushed().empty() ? 0 : set.bodies.size()) {}

void ForceStage::begin(const StepContext& step) { field_.light_explosions(step.set.bodies, step.start(), step.end()); }

// Forces between bodies change with the motion of the others.
void ForceStage::wake(const StepContext& step) const {
    for (const std::uint32_t i : field_.pairs().bodies())
        if (step.set.bodies[i].asleep) step.sleep.wake(i, step.set.bodies);
    if (field_.fields_change(step.start(), step.end()))
        for (std::uint32_t i = 0; i < step.set.bodies.size(); ++i)
            if (step.set.bodies[i].asleep) step.sleep.wake(i, step.set.bodies);
    for (const std::uint32_t i : field_.pushed())
        if (step.set.bodies[i].asleep && field_.changes(i, step.start(), step.end()))
            step.sleep.wake(i, step.set.bodies);
}

void ForceStage::hold_pairs(const StepContext& step) { field_.hold_pairs(step.set.bodies, step.start(), step.end()); }

void ForceStage::apply(const StepContext& step, OutOfDate derived) {
    const double now = step.start(), next = step.end(), h = step.h;
    BodySet& set = step.set;
    hold_pairs(step);
    step.pool.for_bodies(set.awake, tuning::parallel_bodies, [&](std::uint32_t i) {
        Body& body = set.bodies[i];
        if (body.flying) return;
        if (derived == OutOfDate::all)
            body.derive();
        else if (derived == OutOfDate::velocities)
            body.derive_velocities();
        set.old_velocities[i] = {body.velocity, body.angular_velocity};
        const Wrench pushes = wrench(i, body, now, next);
        Wrench of_water;
        if (step.log && field_.has_water()) of_water = field_.water(i, body, now, next, flies(i));
        effects_[i].before = {body.momentum, body.angular_momentum};
        advance_momenta(body, pushes.force, pushes.torque, h);
        effects_[i].after.momentum = body.momentum;
        effects_[i].after.angular_momentum = body.angular_momentum;
        body.derive_velocities();
        if (step.log) log_forces(step, i, pushes, of_water);
        if (body.integrator != IntegratorKind::explicit_euler) find_gyration(body, h);
    });
    if (!step.log) return;
    for (std::uint32_t i = 0; i < set.bodies.size(); ++i)
        if (set.bodies[i].dynamic() && set.bodies[i].asleep) log_asleep(step, i, h, set.bodies[i].position);
}

void ForceStage::log_asleep(const StepContext& step, std::uint32_t i, double span, const Vec3& place) const {
    const Body& body = step.set.bodies[i];
    step.log->add_gravity(i, body, span, place);
    if (field_.only_gravity(i)) return;
    const Wrench wrench = field_.throughout(i, body, step.start(), step.end());
    step.log->add_external(
        i, {span * (wrench.force - body.mass * body.fall(step.settings.gravity)), span * wrench.torque}, place, {});
}

void ForceStage::log_forces(const StepContext& step, std::uint32_t i, const Wrench& wrench,
                            const Wrench& of_water) const {
    const Body& body = step.set.bodies[i];
    const Vec3 place = place_of_forces(i, step);
    step.log->add_gravity(i, body, step.h, place);
    if (field_.only_gravity(i)) return;
    const BodyVelocity mean = mean_velocity(step.set.old_velocities[i], body);
    step.log->add_external(
        i, {step.h * (wrench.force - body.mass * body.fall(step.settings.gravity)), step.h * wrench.torque}, place,
        mean);
    step.log->add_water_work(i,
                             step.h * (of_water.force.dot(mean.velocity) + of_water.torque.dot(mean.angular_velocity)));
}

void ForceStage::list_held(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies) {
    held_.assign(bodies.size(), 0);
    for (const Manifold& m : manifolds) held_[m.a] = held_[m.b] = 1;
    for (std::size_t i = 0; i < bodies.size(); ++i)
        if (bodies[i].jointed) held_[i] = 1;
}

void ForceStage::apply_brief(const StepContext& step) {
    const double now = step.start(), next = step.end();
    for (const std::uint32_t i : field_.pushed()) {
        Body& body = step.set.bodies[i];
        ending_[i] = {};
        if (body.asleep || body.flying) continue;
        ending_[i] = field_.ending(i, body, now, next);
        if (!field_.changes(i, now, next)) continue;
        const Impulse brief = field_.brief(i, body, now, next);
        const BodyVelocity before{body.velocity, body.angular_velocity};
        advance_momenta(body, brief);
        if (step.log) step.log->add_external(i, brief, place_of_forces(i, step), mean_velocity(before, body));
        effects_[i].after.momentum += brief.linear;
        effects_[i].after.angular_momentum += brief.angular;
        if (body.integrator != IntegratorKind::explicit_euler) find_gyration(body, step.h);
    }
}

void ForceStage::accept(std::uint32_t i, const BodySet& set) {
    effects_[i].after = {set.bodies[i].momentum, set.bodies[i].angular_momentum};
}

void ForceStage::set_back(std::uint32_t i, Body& body) const {
    body.momentum = effects_[i].before.momentum;
    body.angular_momentum = effects_[i].before.angular_momentum;
}

void ForceStage::lose_time(std::uint32_t i, Body& body, double share, bool in_contact) const {
    const Momenta &before = effects_[i].before, &after = effects_[i].after;
    const Impulse ending = ending_.empty() ? Impulse{} : ending_[i];
    const Vec3 push = after.momentum - before.momentum - ending.linear;
    const Vec3 turn = after.angular_momentum - before.angular_momentum - ending.angular;
    if (in_contact) return return_work(body, push, turn, share);
    body.momentum = before.momentum + share * push + ending.linear;
    body.angular_momentum = before.angular_momentum + share * turn + ending.angular;
    body.derive_velocities();
}

}  // namespace tumble
