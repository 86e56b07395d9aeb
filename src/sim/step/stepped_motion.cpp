#include "sim/step/stepped_motion.h"

#include "sim/checkpoint/archive.h"
#include "sim/dynamics/integrator.h"
#include "sim/dynamics/integrators/advance.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/dynamics/kinematic_body.h"
#include "sim/log/contact_log.h"
#include "sim/step/placed_bodies.h"
#include "sim/step/rolling_motion.h"
#include "sim/threads/thread_pool.h"

#include <algorithm>

namespace tumble {
namespace {

/// With time-stepped impacts, a bounce that would separate slower than this times |g| h, or times the load speed, does
/// not happen either: the hop would last two steps, and the body would stay in an overlap and be lifted out of it.
/// Related test: ContactEnergy.ABodyThatHardlyBouncesLandsAtTheSurface.
constexpr double restitution_rebound = 1.0;

// True if the body's rotation in flight is nonuniform, or too large for one tangent: if the body is clamped, its
// rotation is that of free rotation, which keeps the energy all along.
bool turns_freely(std::uint32_t i, const StepContext& step) {
    const Body& body = step.set.bodies[i];
    return body.dynamic() && !body.jointed && body.integrator != IntegratorKind::explicit_euler &&
           !step.forces.touched(i, body) && (!body.gyration.isZero(0.0) || turns_too_far(body, step.h));
}

BodyVelocity mean_of(const BodyVelocity& a, const BodyVelocity& b) {
    return {0.5 * (a.velocity + b.velocity), 0.5 * (a.angular_velocity + b.angular_velocity)};
}

double energy_of(const Body& body, const StepContext& step) {
    return body.kinetic_energy() - body.mass * body.fall(step.settings.gravity).dot(body.position);
}

// Energy (J) at the start of a flight, with the work that the log has for the step: that of the force at its start.
double energy_less_logged(std::uint32_t i, Body& body, const StepContext& step) {
    const BodyVelocity kicked{body.velocity, body.angular_velocity};
    body.derive();
    const BodyVelocity mean = mean_of(kicked, {body.velocity, body.angular_velocity});
    Wrench wrench = step.forces.wrench(i, body, step.start(), step.end());
    wrench.force -= body.mass * body.fall(step.settings.gravity);
    return energy_of(body, step) +
           step.h * (wrench.force.dot(mean.velocity) + wrench.torque.dot(mean.angular_velocity));
}

}  // namespace

SteppedMotion::SteppedMotion(const SceneDescription& scene, const BodySet& set, const StepClock& clock)
    : motions_(set.bodies), free_flights_(set.bodies.size(), scene.simulation.gravity, clock) {}

double SteppedMotion::rebound_share() const { return restitution_rebound; }

// Explicit Euler moves a pose by the velocities of the step's start, other methods by the velocities of its end; the
// rotation by their mean.
BodyVelocity SteppedMotion::motion(std::uint32_t i, const Body& body, const StepContext& step) const {
    if (body.placed) return step.placed.motion(i, step.set, step.h);
    const bool before = body.dynamic() && !body.jointed && body.integrator == IntegratorKind::explicit_euler;
    const BodyVelocity& old = step.set.old_velocities[i];
    BodyVelocity motion;
    motion.velocity = (before ? old.velocity : body.velocity) + body.correction_velocity;
    motion.angular_velocity = before ? old.angular_velocity : body.angular_velocity;
    if (!before && body.jointed) {
        motion.angular_velocity += gyration(body, step.h);
    } else if (!before && body.dynamic()) {
        const Vec3 mean = step.forces.touched(i, body)
                              ? mean_angular_velocity_in_contact(body, step.h, step.settings.rotation)
                              : mean_angular_velocity(body, step.h, step.settings.rotation);
        motion.angular_velocity = mean;  // through a named variable: see find_gyration()
    }
    motion.angular_velocity += body.correction_angular_velocity;
    return motion;
}

void SteppedMotion::advance(const StepContext& step, ContactDetection& detection) {
    BodySet& set = step.set;
    motions_.find(step, [&](std::uint32_t i, const Body& body) { return motion(i, body, step); });
    const auto& limits = motions_.limits(
        step, detection, [&]() -> const auto& { return detection.find_pairs(step); },
        [&](std::uint32_t i) { return turns_freely(i, step); });
    step.rolling.stop(step, limits);
    if (!step.forces.field().pairs().empty()) fly_pairs(limits, step);
    step.pool.for_bodies(set.awake, tuning::parallel_bodies, [&](std::uint32_t i) {
        move(i, limits[i], step);
        step.check.examine(i, set.bodies);
    });
}

// Bodies with forces between each other fly together. The flight of one that CCD stops is shorter.
void SteppedMotion::fly_pairs(const std::vector<CcdFraction>& limits, const StepContext& step) {
    const PairForces& pairs = step.forces.field().pairs();
    const auto index = pairs.bodies();
    std::vector<PairFlight::Member> members(index.size());
    std::vector<std::size_t> flying;
    for (std::size_t k = 0; k < index.size(); ++k) {
        const Body& body = step.set.bodies[index[k]];
        members[k] = {body.dynamic() && !body.asleep && !body.jointed && advances_whole_state(body.integrator) &&
                          !step.forces.touched(index[k], body),
                      body.integrator,
                      step.forces.start_of(index[k], body),
                      {body.velocity, body.angular_velocity}};
        if (members[k].flies) flying.push_back(k);
    }
    if (flying.empty()) return;
    ends_.resize(index.size());
    pair_flight_.start(step.set.bodies, std::move(members), step.forces.field(), step.start());
    for (const std::size_t k : flying) {
        const double share = limits[index[k]].share;
        ends_[k] = pair_flight_.at(share == 1.0 ? step.end() : step.start() + share * step.h)[k];
    }
}

void SteppedMotion::move(std::uint32_t i, const CcdFraction& limit, const StepContext& step) {
    Body& body = step.set.bodies[i];
    const ForceStage& forces = step.forces;
    const double share = limit.share, h = step.h;
    // Contact is solved for the velocities at the step's end: bodies in contact move by those, as in symplectic Euler.
    const bool in_contact = body.jointed || forces.touched(i, body);
    const bool flies = advances_whole_state(body.integrator) && !in_contact;
    if (body.flew != flies) body.flew = flies;  // all threads read the neighboring data: written only where it changes
    if (body.flew) {
        if (step.log) step.log->start_flight(i, body);
        forces.set_back(i, body);
        const bool books = step.log && forces.field().has_potential() && !forces.field().only_gravity(i);
        const double before = books ? energy_less_logged(i, body, step) : 0.0;
        const double end = step.start() + share * h;
        const PairForces& pairs = forces.field().pairs();
        if (const auto found = std::ranges::lower_bound(pairs.bodies(), i);
            found != pairs.bodies().end() && *found == i)
            set_state(body, ends_[std::size_t(found - pairs.bodies().begin())]);
        else if (body.integrator == IntegratorKind::exact)
            free_flights_.advance(i, body, forces.field(), step.index, share);
        else
            advance_one_step(body, body.integrator, forces.field(), i, step.start(), end);
        if (share < 1.0) advance_momenta(body, forces.field().ending(i, body, end, step.end()));
        // The forces of the step are logged as of its start: the flight's end gives the difference.
        if (step.log) {
            step.log->end_flight(i, body, false);
            if (books) {
                const double left = energy_of(body, step) - before;
                step.log->add_work(i, left);
                if (forces.field().has_water()) step.log->add_water_work(i, left);
            }
            if (share < 1.0) step.log->add_gravity(i, body, (1.0 - share) * h, body.position);
        }
    } else {
        const BodyVelocity& motion = step.set.motions[i];
        const double spin_before = spin(body);
        const Quat orientation = body.orientation;
        // Joints have changed the spin within the step, and a body that rolls has the momenta of its end.
        const bool freely = (share < 1.0 || turns_too_far(body, h)) && turns_freely(i, step);
        if (body.placed && share == 1.0) {
            set_state(body, step.placed.end(i));
        } else if (body.jointed || body.rolls())
            turn_exactly(body, motion.velocity, motion.angular_velocity, share * h);
        else
            advance_pose(body, motion.velocity, motion.angular_velocity, share * h, step.settings.rotation);
        body.correction_velocity.setZero();
        body.correction_angular_velocity.setZero();
        if (!in_contact && share < 1.0) forces.lose_time(i, body, share, false);
        body.derive();
        if (freely)
            turn_freely(body, orientation, share * h);
        else if (in_contact && !body.jointed && !body.rolls() && spin_grew(body, spin_before))
            limit_spin(body, spin_before);
        if (in_contact && !body.rolls() && share < 1.0) forces.lose_time(i, body, share, true);
    }
    if (limit.carrier != CcdFraction::none) carry_along(body, step.set.bodies[limit.carrier], share, h);
}

void SteppedMotion::save(CheckpointWriter& writer) const { visit(writer, *this); }
void SteppedMotion::restore(CheckpointReader& reader, std::int64_t) { visit(reader, *this); }

}  // namespace tumble
