#include "sim/world.h"

#include "core/error.h"
#include "sim/body_builder.h"
#include "sim/broad_phase.h"
#include "sim/contact/impacts.h"
#include "sim/contact/islands.h"
#include "sim/contact/rest_solver.h"
#include "sim/contact/sleep.h"
#include "sim/flight/flights.h"
#include "sim/flight/free_flights.h"
#include "sim/flight/motion_limit.h"
#include "sim/forces.h"
#include "sim/integrator.h"
#include "sim/integrator/advance.h"
#include "sim/measurement.h"
#include "sim/narrow_phase.h"
#include "sim/thread_pool.h"
#include "sim/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {

struct World::State {
    SimulationSettings settings;
    double fps;
    double h;                         // s
    std::int64_t steps = 0;           // time is counted in these, never summed up
    ForceField forces;
    std::vector<Body> bodies;
    BroadPhase broad_phase;
    NarrowPhase narrow_phase;
    std::vector<Contact> contacts, previous_contacts;
    std::vector<Island> islands;      // of the awake bodies
    SleepMonitor sleep;
    std::unique_ptr<Flights> flights;   // with exact impacts
    FreeFlights free_flights;           // with exact motion between stepped ones
    MotionLimit motion_limit;
    std::vector<StepMotion> motions;
    std::vector<BroadPhase::Pair> pairs;
    ThreadPool pool;
    // Velocities before this step's forces: what explicit Euler moves by.
    std::vector<Vec3> old_velocity, old_angular_velocity;
    // Momenta before and after this step's forces: what the integrators of higher order begin with, and whether contact
    // has added anything since.
    struct Momenta {
        Vec3 momentum, angular_momentum;
        bool operator==(const Momenta&) const = default;
    };
    std::vector<Momenta> before_forces, after_forces;

    State(const SceneDescription& scene, int threads)
        : settings(scene.simulation), fps(scene.output.fps), h(scene.step()), forces(scene),
          // Exact energies want exact manifolds: points that lie a thousandth off make nanometres of height.
          narrow_phase(threads, NarrowPhase::Mode::step,
                       scene.simulation.impacts == ImpactMode::exact ? NarrowPhase::Memory::off : NarrowPhase::Memory::on),
          sleep(scene.bodies.size()),
          free_flights(scene.bodies.size(), scene.simulation.gravity, {fps, settings.steps_per_frame}), pool(threads), old_velocity(scene.bodies.size(), Vec3::Zero()),
          old_angular_velocity(scene.bodies.size(), Vec3::Zero()), before_forces(scene.bodies.size()),
          after_forces(scene.bodies.size()) {
        BodyBuilder builder;
        for (const BodyDescription& d : scene.bodies) bodies.push_back(builder.build(d, settings.integrator));
        place_kinematic_bodies();
        if (settings.impacts == ImpactMode::exact) flights = std::make_unique<Flights>(bodies, settings, fps);
    }

    double time(std::int64_t step) const { return double(step) / (fps * settings.steps_per_frame); }
    /// In the loop of the steps: neither asleep nor in exact flight.
    bool awake(const Body& body) const { return body.dynamic() && !body.asleep && !body.flying; }

    void advance(std::int64_t to);
    void step();
    void place_kinematic_bodies();
    void find_contacts();
    void resolve_collisions();
    void apply_forces();
    bool by_whole_state(const Body& body) const {
        return body.integrator == IntegratorKind::exact || steps_whole_state(body.integrator);
    }
    const std::vector<StepMotion>& step_motions();
    const std::vector<StepLimit>& held_limits();
    void carry(Body& body, const Body& carrier, double span) const;
    void solve_resting_contacts();
    void move();
    void fall_asleep();
    void check_finite() const;
};

void World::State::step() {
    find_contacts();            // pairs: broad phase, exact manifolds, islands
    resolve_collisions();       // v_rel < 0: impulses with restitution (notes eq. 20)
    apply_forces();             // F and tau at t_n change P and L
    solve_resting_contacts();   // non-penetration and friction
    move();                     // x and q to t_n+1; free flights from impact to impact
    fall_asleep();              // islands at rest leave the loop
    check_finite();
}

// Steps only while something has to be stepped: bodies in free flight need none.
void World::State::advance(std::int64_t to) {
    while (steps < to) {
        if (!flights || flights->stepping(bodies) || forces.ever_changes()) {
            step();
            continue;
        }
        steps = flights->run(bodies, sleep, forces, to);
        broad_phase.bodies_woke();   // some may have
        flights->place(bodies, steps);
        check_finite();
    }
}

void World::step() { state_->advance(state_->steps + 1); }
void World::advance_frame() { state_->advance(state_->steps + state_->settings.steps_per_frame); }

// Kinematic bodies go where their keyframes say; during the step they have the constant velocity that takes them there.
void World::State::place_kinematic_bodies() {
    for (Body& body : bodies) {
        if (!body.track) continue;
        const auto now = body.track->at(time(steps)), next = body.track->at(time(steps + 1));
        body.orientation = now.rotation;
        body.rotation = now.rotation.toRotationMatrix();
        body.position = now.position + body.rotation * body.center_of_mass;
        const Vec3 target = next.position + next.rotation * body.center_of_mass;
        body.velocity = (target - body.position) / h;
        body.angular_velocity = rotation_vector(next.rotation * now.rotation.conjugate()) / h;
    }
}

void World::State::find_contacts() {
    previous_contacts.swap(contacts);
    const auto& manifolds = narrow_phase.find(broad_phase.update(bodies, h), bodies, h, pool);
    make_contacts(manifolds, bodies, previous_contacts, contacts);
    if (sleep.wake_touched(contacts, bodies)) {
        // The woken ones need the contacts among themselves too, which were not looked for.
        broad_phase.bodies_woke();
        make_contacts(narrow_phase.find(broad_phase.update(bodies, h), bodies, h, pool), bodies, previous_contacts, contacts);
    }
    if (flights && flights->take_off(contacts, bodies, forces, steps))
        std::erase_if(contacts, [&](const Contact& c) { return bodies[c.a].flying || bodies[c.b].flying; });
    islands = find_islands(contacts, bodies);
}

void World::State::resolve_collisions() {
    const ImpactSettings impacts{.threshold = tuning::restitution_threshold * settings.gravity.norm() * h,
                                 .law = settings.impact_law};
    pool.for_each(islands.size(), tuning::parallel_grain,
                  [&](std::size_t i, std::size_t) { resolve_impacts(islands[i], contacts, bodies, impacts); });
    // Eqs. 9 and 10: the impulses' share of P and L, equal and opposite to the last bit.
    for (const Contact& c : contacts)
        if (c.impact > 0.0) add_impulse(c, c.impact * c.normal, bodies[c.a], bodies[c.b]);
}

void World::State::apply_forces() {
    const double now = time(steps);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        Body& body = bodies[i];
        if (body.asleep && forces.changes(i, now, time(steps + 1))) {
            sleep.wake(std::uint32_t(i), bodies);
            broad_phase.bodies_woke();
        }
        if (!awake(body)) continue;
        body.derive();
        old_velocity[i] = body.velocity;
        old_angular_velocity[i] = body.angular_velocity;
        const Wrench wrench = forces.at(i, body, now);
        before_forces[i] = {body.momentum, body.angular_momentum};
        advance_momenta(body, wrench.force, wrench.torque, h);
        after_forces[i] = {body.momentum, body.angular_momentum};
        body.derive();
    }
}

void World::State::solve_resting_contacts() {
    const double gravity_step = settings.gravity.norm() * h;
    const RestSettings rest{h, tuning::restitution_threshold * gravity_step,
                            std::max(tuning::solver_floor, tuning::solver_tolerance * gravity_step)};
    pool.for_each(islands.size(), tuning::parallel_grain,
                  [&](std::size_t i, std::size_t) { solve_rest(islands[i], contacts, bodies, rest); });
    for (const Contact& c : contacts) {
        const Vec3 impulse = c.impulse * c.normal + c.friction_impulse;
        if (!impulse.isZero(0.0)) add_impulse(c, impulse, bodies[c.a], bodies[c.b]);
    }
}

// The velocities that poses are moved with.
const std::vector<StepMotion>& World::State::step_motions() {
    motions.assign(bodies.size(), {});
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Body& body = bodies[i];
        if (body.asleep || body.flying || !body.moves()) continue;
        // Between exact flights all held bodies move by the velocities they are solved for.
        const bool before = !flights && body.dynamic() && body.integrator == IntegratorKind::explicit_euler;
        motions[i].velocity = (before ? old_velocity[i] : body.velocity) + body.push_velocity;
        motions[i].angular_velocity = (before ? old_angular_velocity[i] : body.angular_velocity) + body.push_angular_velocity;
    }
    return motions;
}

// Between exact flights: of bodies held by contacts, which meet each other and what is fixed by steps. The flying ones
// find their impacts themselves.
const std::vector<StepLimit>& World::State::held_limits() {
    pairs = broad_phase.update(bodies, h);
    std::erase_if(pairs, [&](const BroadPhase::Pair& pair) { return bodies[pair.a].flying || bodies[pair.b].flying; });
    return motion_limit.limits(pairs, contacts, bodies, step_motions(), h);
}

// What a kinematic body has run into goes along with it for the rest of the step.
void World::State::carry(Body& body, const Body& carrier, double span) const {
    const Vec3 arm = body.position - carrier.position;
    body.position += span * carrier.point_velocity(arm);
}

void World::State::move() {
    if (flights) {
        flights->begin_step(bodies, held_limits(), forces, steps);
        steps = flights->run(bodies, sleep, forces, steps + 1);
        broad_phase.bodies_woke();   // some may have
        flights->place(bodies, steps);
        place_kinematic_bodies();
        return;
    }
    const auto& limits = motion_limit.limits(broad_phase.update(bodies, h), contacts, bodies, step_motions(), h);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        Body& body = bodies[i];
        if (!awake(body)) continue;
        const double share = limits[i].share;
        // Contact is solved for the velocities at the step's end: bodies in it move by those, symplectic Euler's way.
        const bool touched = after_forces[i] != Momenta{body.momentum, body.angular_momentum} ||
                             !body.push_velocity.isZero(0.0) || !body.push_angular_velocity.isZero(0.0);
        if (by_whole_state(body) && !touched) {
            body.momentum = before_forces[i].momentum;
            body.angular_momentum = before_forces[i].angular_momentum;
            if (body.integrator == IntegratorKind::exact) free_flights.advance(i, body, forces, steps, share);
            else advance_one_step(body, body.integrator, forces, i, time(steps), time(steps) + share * h);
        } else {
            advance_pose(body, motions[i].velocity, motions[i].angular_velocity, share * h, settings.rotation);
            body.push_velocity.setZero();
            body.push_angular_velocity.setZero();
            body.derive();
        }
        if (limits[i].carrier != StepLimit::none) carry(body, bodies[limits[i].carrier], (1.0 - share) * h);
    }
    ++steps;
    place_kinematic_bodies();
}

void World::State::fall_asleep() {
    if (settings.sleep) sleep.observe(islands, contacts, bodies, h);
}

void World::State::check_finite() const {
    for (const Body& body : bodies) {
        if (!body.dynamic() || body.asleep) continue;
        // One number that is none makes the sum none.
        if (std::isfinite(body.position.sum() + body.orientation.coeffs().sum() + body.momentum.sum() + body.angular_momentum.sum()))
            continue;
        throw RunError(fmt::format("step {} (t = {:.6g} s): the state of body '{}' is no longer finite; "
                                   "a smaller step (steps_per_frame, now {}) may hold it",
                                   steps, time(steps), body.name, settings.steps_per_frame));
    }
}

World::World(const SceneDescription& scene, int threads) : state_(std::make_unique<State>(scene, std::max(1, threads))) {}
World::~World() = default;
World::World(World&&) noexcept = default;

Snapshot World::snapshot() const {
    const State& s = *state_;
    Snapshot snapshot;
    snapshot.frame = s.steps / s.settings.steps_per_frame;
    snapshot.time = s.time(s.steps);
    snapshot.bodies.reserve(s.bodies.size());
    for (const Body& body : s.bodies) {
        BodyState state{body.origin(), body.position, body.orientation, body.velocity, body.angular_velocity};
        if (body.track) {   // the path's own velocity at this moment, not the mean over the coming step
            const auto motion = body.track->at(snapshot.time);
            state.angular_velocity = motion.angular_velocity;
            state.velocity = motion.velocity + motion.angular_velocity.cross(body.position - motion.position);
        }
        snapshot.bodies.push_back(state);
    }
    return snapshot;
}

Measurement World::measure() const {
    State& s = *state_;
    // Contacts of the poses as they are now, not of the step that led here.
    Measurement m = measure_motion(s.bodies, s.settings.gravity);
    BroadPhase broad_phase(BroadPhase::Pairs::all);
    NarrowPhase narrow_phase(s.pool.size(), NarrowPhase::Mode::measure);
    measure_contacts(narrow_phase.find(broad_phase.update(s.bodies, s.h), s.bodies, s.h, s.pool), s.bodies, m);
    return m;
}

BodyReport World::report(std::size_t index) const { return describe(state_->bodies[index]); }

}  // namespace tumble
