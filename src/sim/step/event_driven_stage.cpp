#include "sim/step/event_driven_stage.h"

#include "sim/checkpoint/archive.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/step/fracture_stage.h"
#include "sim/step/placed_bodies.h"
#include "sim/step/rolling_motion.h"

namespace tumble {

std::int64_t EventDrivenStage::run_events(const StepContext& step, std::int64_t until) {
    std::vector<Body>& bodies = step.set.bodies;
    events_.record_in(step.log);
    events_.start_from(step.set.old_velocities);
    events_.join(step.joints, bodies, step.forces.field());
    if (!step.fracture.empty())
        events_.break_by(
            [&](const Island& island, const std::vector<Contact>& contacts, const ImpactSettings& settings,
                const ImpactTime& when) { return step.fracture.strike(island, contacts, settings, when, step); });
    const std::int64_t reached = events_.run(bodies, step.sleep, step.forces.field(), until);
    events_.place(bodies, reached);
    step.check.examine(step.set.awake, bodies, step.pool);
    return reached;
}

std::int64_t EventDrivenStage::skip_steps(const StepContext& step, std::int64_t to) {
    // Bodies that can break are examined at each step: rotation and weight load them too.
    if (events_.stepping(step.set.bodies) || step.forces.field().ever_begins() || !step.fracture.empty())
        return step.index;
    return run_events(step, to);
}

std::span<const std::uint32_t> EventDrivenStage::choose_stepped(const StepContext& step,
                                                                const std::vector<Manifold>& manifolds) {
    std::vector<Body>& bodies = step.set.bodies;
    make_contacts(manifolds, bodies, contacts_);
    make_gaps(manifolds, bodies, gaps_);
    auto contact = contacts_.begin();
    for (const Manifold& m : manifolds)
        for (int i = 0; i < m.count; ++i) (contact++)->load_speed = last_load(m, i, bodies[m.a], bodies[m.b]);
    events_.record_in(step.log);
    events_.start_from(step.set.old_velocities);
    events_.join(step.joints, bodies, step.forces.field());
    step.forces.hold_pairs(step);
    events_.take_off(contacts_, gaps_, bodies, step.forces.field(), step.index);
    stepped_.clear();
    for (const std::uint32_t i : step.set.awake)
        if (!bodies[i].flying) stepped_.push_back(i);
    return stepped_;
}

void EventDrivenStage::advance(const StepContext& step, ContactDetection& detection) {
    BodySet& set = step.set;
    motions_.find(step, [&](std::uint32_t i, const Body& body) {
        BodyVelocity motion;
        if (body.flying) return motion;
        if (body.placed) return step.placed.motion(i, set, step.h);
        // All bodies in contact move by the velocities of the solve, whatever their integrator.
        motion.velocity = body.velocity + body.correction_velocity;
        motion.angular_velocity = body.angular_velocity;
        if (body.dynamic()) motion.angular_velocity += gyration(body, step.h);
        motion.angular_velocity += body.correction_angular_velocity;
        return motion;
    });
    // Only stepped bodies are clamped: ballistic bodies find their impacts themselves.
    const auto find_pairs = [&]() -> const std::vector<BroadPhase::Pair>& {
        pairs_ = detection.find_pairs(step);
        std::erase_if(pairs_, [&](const BroadPhase::Pair& pair) {
            return set.bodies[pair.a].flying || set.bodies[pair.b].flying;
        });
        return pairs_;
    };
    const auto& limits = motions_.limits(step, detection, find_pairs);
    step.rolling.stop(step, limits);
    for (const std::uint32_t i : set.awake) {
        Body& body = set.bodies[i];
        if (!body.flying && !body.rolls() && limits[i].share < 1.0)
            step.forces.lose_time(i, body, limits[i].share, step.forces.touched(i, body));
    }
    events_.begin_step(set.bodies, set.motions, limits, step.forces.field(), step.index);
    run_events(step, step.index + 1);
    events_.end_flights();
}

void EventDrivenStage::exchange(const StepContext& step, std::span<const std::uint32_t> changed) {
    motions_.measure(step.set.bodies, changed);
    events_.exchange(step.set.bodies, changed, {step.index, 0.0});
}

void EventDrivenStage::measure(const std::vector<Body>& bodies) {
    motions_.measure(bodies);
    events_.measure(bodies);
}

void EventDrivenStage::save(CheckpointWriter& writer) const { visit(writer, *this); }
void EventDrivenStage::restore(CheckpointReader& reader, std::int64_t step) {
    visit(reader, *this);
    reader.require([&] { return events_.stands_at(step); });
}

}  // namespace tumble
