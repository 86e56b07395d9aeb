#include "sim/world.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "sim/ccd/ccd_clamp.h"
#include "sim/contact/contact_solver.h"
#include "sim/contact/model/sleep.h"
#include "sim/detection/broad_phase.h"
#include "sim/detection/narrow_phase.h"
#include "sim/detection/spatial_sort.h"
#include "sim/dynamics/body_builder.h"
#include "sim/dynamics/forces.h"
#include "sim/dynamics/integrator.h"
#include "sim/dynamics/integrators/advance.h"
#include "sim/dynamics/integrators/gyroscopic_correction.h"
#include "sim/dynamics/kinematic_body.h"
#include "sim/event_driven/event_driven_motion.h"
#include "sim/event_driven/free_flights.h"
#include "sim/event_driven/local_frame.h"
#include "sim/geometry/contact_tolerance.h"
#include "sim/impact/impacts.h"
#include "sim/impact/settings.h"
#include "sim/snapshot/measurement.h"
#include "sim/threads/settings.h"
#include "sim/threads/thread_pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace tumble {
namespace {

bool exact_impacts(const SceneDescription& scene) { return scene.simulation.impacts == ImpactMode::exact; }

}  // namespace

struct World::State {
    SimulationSettings settings;
    double fps;
    double h;                // s
    std::int64_t steps = 0;  // number of steps done; time is computed from it, never accumulated
    Vec3 origin;             // m, world: origin of the bodies' coordinates
    std::vector<Body> bodies;
    std::vector<std::uint32_t> order;  // by body: index in the scene
    ForceField forces;
    BroadPhase broad_phase;
    NarrowPhase narrow_phase;
    std::vector<Manifold>* manifolds = nullptr;  // of this step; owned by the narrow phase
    std::vector<Contact> contacts;               // points of the manifolds, where impulses are resolved one by one
    ContactIslands islands;                      // of the awake bodies
    std::pair<std::uint64_t, std::uint64_t> seen_by_islands{UINT64_MAX,
                                                            UINT64_MAX};  // change counters of manifolds and of sleep
    std::vector<Island> colliding;                                        // islands with impacts in this step
    std::vector<std::uint32_t> struck;                                    // indices of the manifolds of these islands
    std::vector<double> struck_impulses;  // N s, impulses of these manifolds before the step
    ContactSolver contact_solver;
    SleepMonitor sleep;
    std::uint64_t seen_sleep_changes = UINT64_MAX;
    std::vector<std::uint32_t> awake_bodies, moving_bodies,
        kinematic_bodies;                        // ascending; moving: the other two together
    std::unique_ptr<EventDrivenMotion> flights;  // with exact impacts
    FreeFlights free_flights;                    // for exact motion between stepped impacts
    CcdClamp motion_limit;
    std::vector<BodyVelocity> motions;
    std::atomic<bool> any_fast{false};                        // of the motions; set by each body's own thread
    std::atomic<std::uint32_t> first_not_finite{UINT32_MAX};  // index of a body
    std::vector<BroadPhase::Pair> pairs;
    ThreadPool pool;
    std::vector<BodyVelocity>
        old_velocities;  // at the start of the step, before its forces: explicit Euler moves bodies by them
    // Momenta before and after this step's forces: start of the higher-order integrators; they show any impulse of contact.
    struct Momenta {
        Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();
        bool operator==(const Momenta&) const = default;
    };
    struct alignas(64) ForceStep {
        Momenta before, after;
    };
    std::vector<ForceStep> force_steps;
    std::vector<Impulse> pulses;  // of this step's ending forces; by body, empty without forces at points

    State(const SceneDescription& scene, const FrameTiming& timing, int threads)
        : settings(scene.simulation),
          fps(timing.fps),
          h(timing.step()),
          origin(exact_impacts(scene) ? local_origin(scene) : Vec3(Vec3::Zero())),
          bodies(build_bodies(origin.isZero(0.0) ? scene : seen_from(scene, origin))),
          order(exact_impacts(scene) ? put_in_exact_order(bodies, settings.gravity)
                                     : put_in_memory_order(bodies, settings.gravity)),
          forces(scene, order),
          // Exact energies need exact manifolds: points a thousandth off make nanometers of height.
          narrow_phase(threads, NarrowPhase::Mode::step,
                       exact_impacts(scene) ? NarrowPhase::Memory::off : NarrowPhase::Memory::on),
          islands(scene.bodies.size()),
          contact_solver(scene.bodies.size(), scene.simulation.contact_solver,
                         exact_impacts(scene) ? ContactSolver::Effort::precisely : ContactSolver::Effort::balanced),
          sleep(scene.bodies.size()),
          free_flights(scene.bodies.size(), scene.simulation.gravity, {fps, timing.steps_per_frame}),
          motion_limit(bodies),
          pool(threads),
          old_velocities(scene.bodies.size()),
          force_steps(scene.bodies.size()),
          pulses(forces.ever_changes() ? scene.bodies.size() : 0) {
        settings.steps_per_frame = timing.steps_per_frame;
        for (std::uint32_t i = 0; i < bodies.size(); ++i)
            if (bodies[i].track) kinematic_bodies.push_back(i);
        motions.resize(bodies.size());
        place_kinematic_bodies();
        if (settings.impacts == ImpactMode::exact) flights = std::make_unique<EventDrivenMotion>(bodies, settings, fps);
    }

    double time(std::int64_t step) const { return double(step) / (fps * settings.steps_per_frame); }
    double gravity_step() const { return settings.gravity.norm() * h; }  // m/s, change of speed by gravity in a step

    void advance(std::int64_t to);
    void step();
    void list_awake();
    void wake_where_forces_change();
    bool collides(std::size_t island) const;
    void place_kinematic_bodies();
    void find_contacts();
    void resolve_collisions();
    void apply_forces();
    void apply_brief_forces();
    bool by_whole_state(const Body& body) const {
        return body.integrator == IntegratorKind::exact || steps_whole_state(body.integrator);
    }
    // Whether contact has added anything to the effect of the step's forces.
    bool touched(std::uint32_t i) const {
        const Body& body = bodies[i];
        return force_steps[i].after != Momenta{body.momentum, body.angular_momentum} ||
               !body.push_velocity.isZero(0.0) || !body.push_angular_velocity.isZero(0.0);
    }
    // Whether the body's rotation in flight is nonuniform, or too large for one tangent: if the body is clamped, its
    // rotation is that of free rotation, which keeps the energy all along.
    bool turns_freely(std::uint32_t i) const {
        const Body& body = bodies[i];
        return body.dynamic() && body.integrator != IntegratorKind::explicit_euler && !touched(i) &&
               (!body.gyration.isZero(0.0) || turns_too_far(body, h));
    }
    void step_motions();
    const std::vector<CcdFraction>& held_limits();
    void lose_time(std::uint32_t i, double share, bool in_contact);
    void solve_resting_contacts();
    void forget_blows();
    void move();
    void fall_asleep();
    void look_at_numbers(std::uint32_t i);
    void stop_if_not_finite() const;
    void check_finite();
};

void World::State::step() {
    find_contacts();           // pairs: broad phase, exact manifolds, islands
    resolve_collisions();      // v_rel < 0: impulses with restitution (notes eq. 20)
    apply_forces();            // F and tau at t_n change P and L
    solve_resting_contacts();  // non-penetration and friction
    move();                    // x and q to t_n+1; ballistic bodies from impact to impact
    fall_asleep();             // islands at rest are excluded from the simulation
}

// Steps only while a body needs stepping: bodies in free flight do not.
void World::State::advance(std::int64_t to) {
    while (steps < to) {
        if (!flights || flights->stepping(bodies) || forces.ever_changes()) {
            step();
            continue;
        }
        steps = flights->run(bodies, sleep, forces, to);
        flights->place(bodies, steps);
        check_finite();
    }
}

void World::step() { state_->advance(state_->steps + 1); }
void World::advance_frame() { state_->advance(state_->steps + state_->settings.steps_per_frame); }

void World::State::place_kinematic_bodies() {
    for (const std::uint32_t i : kinematic_bodies)
        old_velocities[i] = place_on_track(bodies[i], time(steps), time(steps + 1), h);
}

// Lists of awake bodies. All loops of a step run over these, so its cost scales with the awake bodies.
void World::State::list_awake() {
    if (sleep.changes() == seen_sleep_changes) return;
    seen_sleep_changes = sleep.changes();
    broad_phase.bodies_woke();
    awake_bodies.clear();
    moving_bodies.clear();
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i].dynamic() && !bodies[i].asleep) awake_bodies.push_back(i);
        if (bodies[i].moves() && !bodies[i].asleep)
            moving_bodies.push_back(i);
        else
            motions[i] = {};
    }
}

void World::State::wake_where_forces_change() {
    for (const std::uint32_t i : forces.pushed())
        if (bodies[i].asleep && forces.changes(i, time(steps), time(steps + 1))) sleep.wake(i, bodies);
}

void World::State::find_contacts() {
    wake_where_forces_change();
    const auto find = [&] {
        list_awake();
        manifolds = &narrow_phase.find(broad_phase.update(bodies, h, &pool), bodies, h, pool);
    };
    find();
    // Woken bodies need the contacts among themselves too, which were not searched.
    if (sleep.wake_touched(*manifolds, bodies, h, gravity_step())) find();
    if (flights) {
        make_contacts(*manifolds, bodies, contacts);
        flights->take_off(contacts, bodies, forces, steps);
    }
    // The same pairs and the same awake bodies give the same islands. Ballistic bodies may take part again at any time.
    const std::pair now(narrow_phase.changes(), sleep.changes());
    if (!flights && now == seen_by_islands) return;
    seen_by_islands = now;
    if (!flights) return islands.find(narrow_phase.touching(), bodies, awake_bodies);
    std::vector<std::uint32_t> stepped;
    for (const std::uint32_t i : awake_bodies)
        if (!bodies[i].flying) stepped.push_back(i);
    islands.find(narrow_phase.touching(), bodies, stepped);
}

// Whether touching points with restitution approach faster than resting contact does.
bool World::State::collides(std::size_t island) const {
    const double threshold = tuning::restitution_threshold * gravity_step();
    const auto touching = islands.pairs(island);
    for (std::size_t k = 0; k < touching.size(); ++k) {
        const Body &a = bodies[touching[k].a], &b = bodies[touching[k].b];
        if (pair_restitution(a, b) <= 0.0) continue;
        const Manifold& m = (*manifolds)[islands.manifolds(island)[k]];
        const double touch = touch_distance(a.radius, b.radius);
        for (int i = 0; i < m.count; ++i) {
            const ContactPoint& p = m.points[std::size_t(i)];
            if (p.separation <= touch && relative_velocity(p, m.normal, a, b) < -threshold) return true;
        }
    }
    return false;
}

void World::State::resolve_collisions() {
    struck.clear();
    struck_impulses.clear();
    colliding.clear();
    contacts.clear();
    for (std::size_t k = 0; k < islands.size(); ++k) {
        if (!collides(k)) continue;
        Island& island = colliding.emplace_back();
        island.bodies.assign(islands.bodies(k).begin(), islands.bodies(k).end());
        for (const std::uint32_t m : islands.manifolds(k)) {
            struck.push_back(m);
            struck_impulses.push_back(normal_impulse((*manifolds)[m]));
            const auto first = std::uint32_t(contacts.size());
            add_contacts((*manifolds)[m], bodies, contacts);
            for (std::uint32_t i = first; i < contacts.size(); ++i) island.contacts.push_back(i);
        }
    }
    if (struck.empty()) return;
    const double threshold = tuning::restitution_threshold * gravity_step();
    const ImpactSettings impacts{
        .threshold = threshold, .slow = tuning::impact_slow * threshold, .law = settings.impact_law, .friction = true};
    pool.for_each(colliding.size(), tuning::parallel_grain,
                  [&](std::size_t i, std::size_t) { resolve_impacts(colliding[i], contacts, bodies, impacts); });
    std::size_t next = 0;
    for (const std::uint32_t k : struck) {
        for (int i = 0; i < (*manifolds)[k].count; ++i) {
            const Contact& c = contacts[next++];
            // Eqs. 9 and 10: the contribution of the impulses to P and L, equal and opposite to the last bit.
            if (c.impact > 0.0) add_impact(c, bodies[c.a], bodies[c.b]);
        }
    }
}

void World::State::apply_forces() {
    const double now = time(steps), next = time(steps + 1);
    pool.for_bodies(awake_bodies, tuning::parallel_bodies, [&](std::uint32_t i) {
        Body& body = bodies[i];
        if (body.flying) return;
        if (flights)
            body.derive();  // possibly moved here from a flight
        else if (!struck.empty())
            body.derive_velocities();  // impacts have changed momenta
        old_velocities[i] = {body.velocity, body.angular_velocity};
        const Wrench wrench = forces.throughout(i, body, now, next);
        force_steps[i].before = {body.momentum, body.angular_momentum};
        advance_momenta(body, wrench.force, wrench.torque, h);
        force_steps[i].after.momentum = body.momentum;
        force_steps[i].after.angular_momentum = body.angular_momentum;
        body.derive_velocities();
        if (body.integrator != IntegratorKind::explicit_euler) find_gyration(body, h);
    });
}

// Forces at points for the fraction of the step in which they act. After the bounces, which keep their speed against
// the forces that act throughout: a bounce must not cancel a brief force.
void World::State::apply_brief_forces() {
    const double now = time(steps), next = time(steps + 1);
    for (const std::uint32_t i : forces.pushed()) {
        Body& body = bodies[i];
        pulses[i] = {};
        if (body.asleep || body.flying) continue;
        pulses[i] = forces.ending(i, body, now, next);
        if (!forces.changes(i, now, next)) continue;
        const Impulse blow = forces.brief(i, body, now, next);
        advance_momenta(body, blow);
        force_steps[i].after.momentum += blow.linear;
        force_steps[i].after.angular_momentum += blow.angular;
        if (body.integrator != IntegratorKind::explicit_euler) find_gyration(body, h);
    }
}

void World::State::solve_resting_contacts() {
    const double threshold = tuning::restitution_threshold * gravity_step();
    pool.for_each(colliding.size(), tuning::parallel_grain, [&](std::size_t i, std::size_t) {
        hold_bounces(colliding[i], contacts, bodies, threshold);
        // No contact holds a body that only bounces: it rotates as in flight, which adds nothing to its spin.
        for (const std::uint32_t k : colliding[i].bodies) {
            if (!by_whole_state(bodies[k])) force_steps[k].after = {bodies[k].momentum, bodies[k].angular_momentum};
            if (bodies[k].integrator != IntegratorKind::explicit_euler) find_gyration(bodies[k], h);
        }
    });
    apply_brief_forces();
    const double least_rebound = flights ? 0.0 : tuning::restitution_rebound * gravity_step();
    contact_solver.solve({bodies, *manifolds, old_velocities, {h, threshold, least_rebound}}, islands, pool);
    forget_blows();
}

// An impulse that stopped an impact in this step is a bad initial guess for the next: a contact may keep at most twice
// its last value, or twice the weight of the lighter body.
void World::State::forget_blows() {
    for (std::size_t k = 0; k < struck.size(); ++k) {
        Manifold& m = (*manifolds)[struck[k]];
        double lighter = std::numeric_limits<double>::infinity();
        for (const std::uint32_t i : {m.a, m.b})
            if (bodies[i].dynamic()) lighter = std::min(lighter, bodies[i].mass);
        const double sum = normal_impulse(m), most = 2.0 * std::max(struck_impulses[k], lighter * gravity_step());
        if (sum > most) scale_impulses(m, most / sum);
    }
}

// Velocities for moving the poses. All must be finite before CCD.
void World::State::step_motions() {
    any_fast = false;
    pool.for_bodies(moving_bodies, tuning::parallel_bodies, [&](std::uint32_t i) {
        const Body& body = bodies[i];
        motions[i] = {};
        look_at_numbers(i);
        if (body.flying) return;
        // With event-driven motion all bodies in contact move by the velocities of the solve.
        const bool before = !flights && body.dynamic() && body.integrator == IntegratorKind::explicit_euler;
        motions[i].velocity = (before ? old_velocities[i].velocity : body.velocity) + body.push_velocity;
        motions[i].angular_velocity = before ? old_velocities[i].angular_velocity : body.angular_velocity;
        if (flights && body.dynamic())
            motions[i].angular_velocity += gyration(body, h);
        else if (!before && body.dynamic()) {
            const Vec3 mean = touched(i) ? mean_angular_velocity_in_contact(body, h, settings.rotation)
                                         : mean_angular_velocity(body, h, settings.rotation);
            motions[i].angular_velocity = mean;  // through a named variable: see find_gyration()
        }
        motions[i].angular_velocity += body.push_angular_velocity;
        if (motion_limit.fast(i, motions[i], h) && !any_fast) any_fast = true;
    });
    stop_if_not_finite();
}

// With event-driven motion: of bodies in contact, which meet each other and fixed bodies by steps. Ballistic bodies
// find their impacts themselves.
const std::vector<CcdFraction>& World::State::held_limits() {
    const auto find_pairs = [&]() -> const std::vector<BroadPhase::Pair>& {
        pairs = broad_phase.update(bodies, h, &pool);
        std::erase_if(pairs,
                      [&](const BroadPhase::Pair& pair) { return bodies[pair.a].flying || bodies[pair.b].flying; });
        return pairs;
    };
    step_motions();
    return motion_limit.limits(find_pairs, touch_depth(*manifolds, bodies), bodies, motions, h, any_fast);
}

// Removes the effect of the lost part of a step from a clamped body. In contact the work of the forces along the lost
// displacement is removed; else the forces have acted for as long as it moved. Forces at points that end at some time
// give all of their impulse.
void World::State::lose_time(std::uint32_t i, double share, bool in_contact) {
    Body& body = bodies[i];
    const Momenta &before = force_steps[i].before, &after = force_steps[i].after;
    const Impulse pulse = pulses.empty() ? Impulse{} : pulses[i];
    const Vec3 push = after.momentum - before.momentum - pulse.linear;
    const Vec3 turn = after.angular_momentum - before.angular_momentum - pulse.angular;
    if (in_contact) return return_work(body, push, turn, share);
    body.momentum = before.momentum + share * push + pulse.linear;
    body.angular_momentum = before.angular_momentum + share * turn + pulse.angular;
    body.derive_velocities();
}

void World::State::move() {
    if (flights) {
        const auto& limits = held_limits();
        for (const std::uint32_t i : awake_bodies)
            if (!bodies[i].flying && limits[i].share < 1.0) lose_time(i, limits[i].share, touched(i));
        flights->begin_step(bodies, motions, limits, forces, steps);
        steps = flights->run(bodies, sleep, forces, steps + 1);
        flights->place(bodies, steps);
        place_kinematic_bodies();
        check_finite();
        return;
    }
    const auto find_pairs = [&]() -> const std::vector<BroadPhase::Pair>& {
        return broad_phase.update(bodies, h, &pool);
    };
    const auto in_free_rotation = [&](std::uint32_t i) { return turns_freely(i); };
    step_motions();
    const auto& limits = motion_limit.limits(find_pairs, touch_depth(*manifolds, bodies), bodies, motions, h, any_fast,
                                             in_free_rotation);
    pool.for_bodies(awake_bodies, tuning::parallel_bodies, [&](std::uint32_t i) {
        Body& body = bodies[i];
        const double share = limits[i].share;
        // Contact is solved for the velocities at the step's end: bodies in contact move by those, as in symplectic
        // Euler.
        const bool in_contact = touched(i);
        const bool flies = by_whole_state(body) && !in_contact;
        if (body.flew != flies)
            body.flew = flies;  // all threads read the neighboring data: written only where it changes
        if (body.flew) {
            body.momentum = force_steps[i].before.momentum;
            body.angular_momentum = force_steps[i].before.angular_momentum;
            if (body.integrator == IntegratorKind::exact)
                free_flights.advance(i, body, forces, steps, share);
            else
                advance_one_step(body, body.integrator, forces, i, time(steps), time(steps) + share * h);
            if (share < 1.0) advance_momenta(body, forces.ending(i, body, time(steps) + share * h, time(steps + 1)));
        } else {
            const double spin_before = spin(body);
            const Quat orientation = body.orientation;
            const bool freely = (share < 1.0 || turns_too_far(body, h)) && turns_freely(i);
            advance_pose(body, motions[i].velocity, motions[i].angular_velocity, share * h, settings.rotation);
            body.push_velocity.setZero();
            body.push_angular_velocity.setZero();
            if (!in_contact && share < 1.0) lose_time(i, share, false);
            body.derive();
            if (freely)
                turn_freely(body, orientation, share * h);
            else if (in_contact && spin_grew(body, spin_before))
                limit_spin(body, spin_before);
            if (in_contact && share < 1.0) lose_time(i, share, true);
        }
        if (limits[i].carrier != CcdFraction::none) carry_along(body, bodies[limits[i].carrier], share, h);
        look_at_numbers(i);
    });
    ++steps;
    stop_if_not_finite();
    place_kinematic_bodies();
}

void World::State::fall_asleep() {
    if (!settings.sleep) return;
    const std::uint64_t changes = sleep.changes();
    sleep.observe(islands, *manifolds, bodies, h, gravity_step());
    if (flights && sleep.changes() != changes) flights->lay_down(bodies, steps);
}

// Reports the first body in order, whichever thread finds it.
void World::State::look_at_numbers(std::uint32_t i) {
    const Body& body = bodies[i];
    // One value that is not finite makes the sum not finite.
    if (std::isfinite(body.position.sum() + body.orientation.coeffs().sum() + body.momentum.sum() +
                      body.angular_momentum.sum() + body.push_velocity.sum() + body.push_angular_velocity.sum()))
        return;
    for (std::uint32_t known = first_not_finite; i < known && !first_not_finite.compare_exchange_weak(known, i);) {
    }
}

void World::State::check_finite() {
    pool.for_bodies(awake_bodies, tuning::parallel_bodies, [&](std::uint32_t i) { look_at_numbers(i); });
    stop_if_not_finite();
}

void World::State::stop_if_not_finite() const {
    const std::uint32_t first = first_not_finite;
    if (first == UINT32_MAX) return;
    throw RunError(
        fmt::format("step {} (t = {:.6g} s): the state of body '{}' is not finite; "
                    "try a smaller step: more than {} steps_per_frame",
                    steps, time(steps), safe_text(bodies[first].name), settings.steps_per_frame));
}

World::World(const SceneDescription& scene, int threads) : World(scene, scene.timing(), threads) {}
World::World(const SceneDescription& scene, const FrameTiming& timing, int threads)
    : state_(std::make_unique<State>(scene, timing, std::max(1, threads))) {}
World::~World() = default;
World::World(World&&) noexcept = default;

Snapshot World::snapshot() const {
    const State& s = *state_;
    Snapshot snapshot;
    snapshot.frame = s.steps / s.settings.steps_per_frame;
    snapshot.time = s.time(s.steps);
    snapshot.bodies.resize(s.bodies.size());
    for (std::size_t i = 0; i < s.bodies.size(); ++i) {
        const Body& body = s.bodies[i];
        BodyState state{s.origin + body.origin(), s.origin + body.position, body.orientation, body.velocity,
                        body.angular_velocity};
        if (body.track) {  // the path's own velocity at this time, not the mean over the coming step
            const BodyVelocity now = velocity_on_track(body, snapshot.time);
            state.velocity = now.velocity;
            state.angular_velocity = now.angular_velocity;
        }
        snapshot.bodies[s.order[i]] = state;
    }
    return snapshot;
}

Measurement World::measure() const {
    State& s = *state_;
    // Contacts of the present poses, not of the last step.
    Measurement m = measure_motion(s.bodies, s.settings.gravity, s.origin);
    BroadPhase broad_phase(BroadPhase::Pairs::all);
    NarrowPhase narrow_phase(s.pool.size(), NarrowPhase::Mode::measure);
    measure_contacts(narrow_phase.find(broad_phase.update(s.bodies, s.h), s.bodies, s.h, s.pool), s.bodies, m);
    return m;
}

BodyReport World::report(std::size_t index) const {
    const auto place = std::find(state_->order.begin(), state_->order.end(), index) - state_->order.begin();
    return describe(state_->bodies[std::size_t(place)]);
}

}  // namespace tumble
