#include "sim/world.h"

#include "core/check.h"
#include "sim/checkpoint/archive.h"
#include "sim/contact/contact_solver.h"
#include "sim/contact/model/free_motion.h"
#include "sim/contact/model/sleep.h"
#include "sim/detection/broad_phase.h"
#include "sim/detection/narrow_phase.h"
#include "sim/dynamics/kinematic_body.h"
#include "sim/impact/settings.h"
#include "sim/joints/joint_set.h"
#include "sim/joints/joint_structure.h"
#include "sim/log/contact_log.h"
#include "sim/notes/notes_method.h"
#include "sim/snapshot/measurement.h"
#include "sim/snapshot/snapshot_middle.h"
#include "sim/step/contact_detection.h"
#include "sim/step/event_driven_stage.h"
#include "sim/step/force_stage.h"
#include "sim/step/fracture_stage.h"
#include "sim/step/hit_stage.h"
#include "sim/step/impact_stage.h"
#include "sim/step/joined_motion.h"
#include "sim/step/placed_bodies.h"
#include "sim/step/rolling_motion.h"
#include "sim/step/step_context.h"
#include "sim/step/stepped_motion.h"
#include "sim/threads/thread_pool.h"

#include <algorithm>

namespace tumble {
namespace {

bool exact_impacts(const SceneDescription& scene) { return scene.simulation.impacts == ImpactMode::exact; }

SimulationSettings with_timing(SimulationSettings settings, const FrameTiming& timing) {
    settings.steps_per_frame = timing.steps_per_frame;
    return settings;
}

std::unique_ptr<MotionStage> make_motion_stage(const SceneDescription& scene, const SimulationSettings& settings,
                                               const BodySet& set, const StepClock& clock) {
    if (exact_impacts(scene)) return std::make_unique<EventDrivenStage>(set, settings, clock.fps);
    return std::make_unique<SteppedMotion>(scene, set, clock);
}

}  // namespace

struct World::State {
    SimulationSettings settings;
    StepClock clock;
    std::int64_t steps = 0;  // number of steps done; time is computed from it, never accumulated
    static constexpr std::int64_t most_steps = std::int64_t(1) << 53;  // that a double counts
    BodySet set;
    JointSet joints;
    JoinedMotion joined;
    RollingMotion rolling;
    PlacedBodies placed;
    std::vector<std::uint32_t> woken;  // by joints, in this step
    ForceStage forces;
    ContactDetection detection;
    FractureStage fracture;
    ImpactStage impacts;
    HitStage hits;
    ContactSolver contact_solver;
    std::unique_ptr<MotionStage> motion;
    SleepMonitor sleep;
    StateCheck check;
    std::unique_ptr<ContactLog> log;      // if asked for
    std::vector<ManifoldImpulse> totals;  // by manifold, of the last solve; for the log
    ContactRecords records;               // of the last frame
    std::unique_ptr<NotesMethod> notes;   // with method = "notes", instead of all stages
    struct Sleeper {
        std::uint32_t body;
        Vec3 place;  // m
    };
    double potential_at_start = 0.0;  // J, in fields, where the account of energies began
    double water_at_start = 0.0;      // J, the same of displaced water
    std::vector<Sleeper> asleep;      // at the start of skipped steps, for the log
    ThreadPool pool;

    State(const SceneDescription& scene, const FrameTiming& timing, int threads)
        : settings(with_timing(scene.simulation, timing)),
          clock{timing.fps, timing.steps_per_frame},
          set(scene),
          joints(scene, set.bodies, set.scene_index, set.origin),
          joined(sweep_rule(settings)),
          forces(scene, set),
          detection(scene.bodies.size(), threads,
                    exact_impacts(scene) ? NarrowPhase::Memory::off : NarrowPhase::Memory::on),
          fracture(scene, set, joints),
          contact_solver(scene.bodies.size(), settings.contact_solver,
                         exact_impacts(scene) ? ContactSolver::Effort::precisely : ContactSolver::Effort::balanced),
          sleep(scene.bodies.size()),
          pool(threads) {
        set.place_kinematic(clock, steps);
        joints.mark(set.bodies);
        detection.keep_apart(joints.apart());
        motion = make_motion_stage(scene, settings, set, clock);
        if (settings.method == SimulationMethod::notes) notes = std::make_unique<NotesMethod>(threads);
    }

    StepContext context() {
        return {.settings = settings,
                .set = set,
                .forces = forces,
                .sleep = sleep,
                .check = check,
                .pool = pool,
                .clock = clock,
                .index = steps,
                .h = clock.seconds(1),
                .log = log.get(),
                .joints = joints,
                .placed = placed,
                .rolling = rolling,
                .fracture = fracture};
    }

    /// The log and its records are apart: a world without a log skips those of another.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [settings, clock, steps, set, joints, joined, rolling, placed, woken, forces, detection, fracture,
               impacts, hits, contact_solver, motion, sleep, check, log, totals, records, notes, potential_at_start,
               water_at_start, asleep, pool] = self;
        archive.rebuilt(settings, clock);
        archive.expect_bodies(set.bodies.size());
        archive.between(0, steps, most_steps);
        archive.keep(fracture);
        if constexpr (!std::is_const_v<Self>) self.fracture.rebuild(self.set, self.joints);
        archive.keep(set, joints, joined, forces, detection, impacts, hits, contact_solver, sleep, check);
        if (forces.field().has_potential()) archive.keep(potential_at_start, water_at_start);
        archive.require([&] { return self.sleep.sound(self.set.bodies); });
        if (notes) archive.keep(*notes);
        archive.scratch(rolling, placed, woken, motion, log, totals, records, asleep, pool);
    }

    void begin_frame();
    void end_frame(int length);
    void advance(std::int64_t to);
    void step();
    void run_stages(const StepContext& step);
    void begin_joints(const StepContext& step);
    void apply_forces(const StepContext& step);
    void solve_contacts(const StepContext& step);
    void close_joints(const StepContext& step);
    void list_asleep();
    void log_skipped(std::int64_t skipped);
    void fall_asleep();
    void resolve_hits();
    template <class Use>
    void with_present_contacts(Use&& use) const;
    void record(ContactLog::Detail detail);
    void finish_records(double duration);
    std::vector<JointState> joint_states() const;
};

void World::State::run_stages(const StepContext& step) {
    const std::uint64_t changes = sleep.changes() + joints.changes();
    forces.begin(step);
    forces.wake(step);
    if (fracture.blast(step, detection, *motion)) forces.begin(step);
    begin_joints(step);
    if (sleep.changes() + joints.changes() != changes) detection.out_of_date();
    detection.update(step, *motion);            // pairs: broad phase, exact manifolds, islands
    fracture.strike(step, detection, *motion);  // blows that break a body
    impacts.resolve(step, detection);           // v_rel < 0: impulses with restitution (notes eq. 20)
    placed.clear(set.bodies);
    joined.decide(step, detection);   // joined bodies: their way in this step; those that touch nothing move
    rolling.decide(step, detection);  // curved bodies on one point
    apply_forces(step);               // F and tau at t_n change P and L
    solve_contacts(step);             // non-penetration, friction and joints
    joints.end_step();
    motion->advance(step, detection);  // x and q to t_n+1; ballistic bodies from impact to impact
    detection.out_of_date();
    close_joints(step);
    joints.take_events();
}

// Joints that begin or end to hold in this step, or are driven in it, wake their bodies.
void World::State::begin_joints(const StepContext& step) {
    if (joints.empty()) return;
    const std::uint64_t changes = joints.changes();
    woken.clear();
    joints.begin_step(step.start(), step.end(), set.bodies, woken);
    for (const std::uint32_t i : woken) sleep.wake(i, set.bodies);
    if (joints.changes() == changes) return;
    joints.mark(set.bodies);
    detection.keep_apart(joints.apart());
}

void World::State::step() {
    if (notes)
        notes->step(context());
    else
        run_stages(context());
    ++steps;
    set.place_kinematic(clock, steps);
    stop_if_not_finite(context());
    fall_asleep();  // islands at rest are excluded from the simulation
    fracture.finish_events(context(), detection, *motion);
    fracture.yield(context(), detection, *motion);
    resolve_hits();
}

// In the event-driven mode bodies meet at events; the method of the notes has no times within a step.
void World::State::resolve_hits() {
    if (notes || settings.impacts != ImpactMode::stepped) return;
    const StepContext next = context();
    detection.update(next, *motion);
    if (hits.resolve(next, detection)) detection.out_of_date();
}

void World::State::begin_frame() {
    if (log) log->begin_frame(set.bodies);
    joints.begin_frame();
    fracture.begin_frame();
}

void World::State::end_frame(int length) {
    joints.end_frame(length, clock.seconds(1), set.bodies);
    if (log) finish_records(clock.seconds(length));
}

// Steps only while a body needs stepping: bodies in free flight do not.
void World::State::advance(std::int64_t to) {
    while (steps < to) {
        if (log) list_asleep();
        const std::int64_t reached = motion->skip_steps(context(), to);
        joints.take_events();
        if (reached == steps) {
            step();
        } else {
            if (log) log_skipped(reached - steps);
            steps = reached;
            fracture.finish_events(context(), detection, *motion);
            stop_if_not_finite(context());
        }
    }
}

// Gravity acts on sleeping bodies in skipped steps too, at the positions where they slept.
void World::State::list_asleep() {
    asleep.clear();
    for (std::uint32_t i = 0; i < set.bodies.size(); ++i)
        if (set.bodies[i].dynamic() && set.bodies[i].asleep) asleep.push_back({i, set.bodies[i].position});
}

void World::State::log_skipped(std::int64_t skipped) {
    const StepContext step = context();
    for (const Sleeper& s : asleep) forces.log_asleep(step, s.body, clock.seconds(skipped), s.place);
}

void World::State::apply_forces(const StepContext& step) {
    using OutOfDate = ForceStage::OutOfDate;
    if (forces.field().has_water()) forces.list_held(detection.manifolds(), set.bodies);
    // Ballistic bodies that are stepped from now on were moved to this position.
    forces.apply(step, motion->has_ballistic_bodies() ? OutOfDate::all
                       : impacts.any()                ? OutOfDate::velocities
                                                      : OutOfDate::none);
    impacts.hold_bounces(step);
    forces.apply_brief(step);
}

void World::State::solve_contacts(const StepContext& step) {
    const double threshold = ImpactStage::threshold(step), rebound = motion->rebound_share();
    const FreeMotion free = step.free_motion();
    const ContactProblem problem{set.bodies,
                                 detection.manifolds(),
                                 set.old_velocities,
                                 {step.h, threshold, rebound * step.gravity_speed(), &free,
                                  tuning::restitution_threshold, rebound, settings.impacts == ImpactMode::stepped},
                                 log ? &totals : nullptr,
                                 joints.empty() ? nullptr : &joints,
                                 joined.ways()};
    if (log) totals.assign(problem.manifolds.size(), {});
    contact_solver.solve(problem, detection.islands(), pool);
    placed.give_momenta(set.bodies);
    rolling.log_contacts(step, detection);
    if (log)
        for (std::size_t k = 0; k < detection.islands().size(); ++k)
            log->add_contacts(detection.islands().manifolds(k), problem, totals);
    impacts.limit_warm_start(step, detection);
}

// Joints are open where CCD has stopped joined bodies within the step, to second order in it, and after sweeps.
void World::State::close_joints(const StepContext& step) {
    if (joints.empty()) return;
    const ContactProblem problem{set.bodies, detection.manifolds(), set.old_velocities, {step.h, 0.0}, nullptr,
                                 &joints};
    for (const std::size_t k : motion->clamped_islands()) contact_solver.close_clamped(problem, detection.islands(), k);
    contact_solver.close_swept(problem, detection.islands(), pool);
}

void World::State::fall_asleep() {
    if (!settings.sleep || notes) return;
    const StepContext next = context();
    const std::uint64_t changes = sleep.changes();
    sleep.observe(detection.islands(), detection.manifolds(), set.bodies, next.h, next.gravity_speed(), &joints,
                  forces.field().has_water() ? &forces.field() : nullptr, next.start());
    if (sleep.changes() != changes) motion->bodies_fell_asleep(next);
}

// Contacts of the present poses, not of the last step, by detectors and a thread of its own: nothing is changed.
template <class Use>
void World::State::with_present_contacts(Use&& use) const {
    ThreadPool alone(1);
    BroadPhase broad_phase(BroadPhase::Pairs::all);
    broad_phase.keep_apart(joints.apart());
    NarrowPhase narrow_phase(alone.size(), NarrowPhase::Mode::measure);
    const double h = clock.seconds(1);
    use(narrow_phase.find(broad_phase.update(set.bodies, h), set.bodies, h, alone));
}

void World::State::finish_records(double duration) {
    for (const Joint& joint : joints.joints()) {
        const JointAccount::Span& frame = joint.account.frame;
        if (!joint.gear()) {
            log->add_joint(joint.a, joint.b, {frame.reaction.force, frame.reaction.moment}, frame.work_a, frame.work_b);
            continue;
        }
        const Joint &first = joints.joints()[joint.description.geared[0]],
                    &second = joints.joints()[joint.description.geared[1]];
        log->add_joint(first.a, first.b, {frame.reaction.force, frame.reaction.moment}, frame.work_a, frame.work_b);
        log->add_joint(second.a, second.b, {frame.second_reaction.force, frame.second_reaction.moment},
                       frame.second_work_a, frame.second_work_b);
    }
    const auto finish = [&](const std::vector<Manifold>& found) {
        records = log->finish_frame(set.bodies, forces.field(), found, duration);
    };
    if (log->has_records())
        with_present_contacts(finish);
    else
        finish({});
    // Fields give energy to the bodies out of their potential, which is no work.
    if (forces.field().has_potential())
        records.energy.work += forces.field().potential(set.bodies) - potential_at_start;
    if (forces.field().has_water())
        records.energy.water_loss -= forces.field().water_potential(set.bodies) - water_at_start;
    if (joints.empty()) return;
    if (log->has_records()) records.joints = joint_states();
    const JointEnergies energy = joints.energies(set.bodies);
    records.energy.work += energy.motors + energy.carriers;
    records.energy.impact_loss += energy.impacts;
    records.energy.friction_loss += energy.heat;
    records.energy.motor_work = energy.motors;
    records.energy.joint_heat = energy.heat;
}

World::World(const SceneDescription& scene, int threads) : World(scene, scene.timing(), threads) {}
World::World(const SceneDescription& scene, const FrameTiming& timing, int threads)
    : state_(std::make_unique<State>(scene, timing, std::max(1, threads))) {}
World::~World() = default;
World::World(World&&) noexcept = default;

void World::step() { state_->advance(state_->steps + 1); }
void World::advance_frame(std::optional<int> other) {
    const int steps = other.value_or(state_->settings.steps_per_frame);
    state_->begin_frame();
    state_->advance(state_->steps + steps);
    state_->end_frame(steps);
}

Snapshot World::advance_frame_by_middle(std::optional<int> other) {
    State& s = *state_;
    const int steps = other.value_or(s.settings.steps_per_frame);
    s.begin_frame();
    s.advance(s.steps + steps / 2);
    Snapshot middle = snapshot();
    if (steps % 2 != 0) {
        s.advance(s.steps + 1);
        middle = middle_of(middle, snapshot());
    }
    s.advance(s.steps + steps / 2);
    s.end_frame(steps);
    return middle;
}

void World::State::record(ContactLog::Detail detail) {
    log = std::make_unique<ContactLog>(set.scene_index, set.origin, settings.gravity, detail);
    log->begin_frame(set.bodies);
    joints.begin_frame();
    joints.start_account(set.bodies);
    potential_at_start = forces.field().potential(set.bodies);
    water_at_start = forces.field().water_potential(set.bodies);
    finish_records(0.0);
}

void World::record_contacts() { state_->record(ContactLog::Detail::records); }
void World::record_energy() { state_->record(ContactLog::Detail::energy); }

const ContactRecords& World::contact_records() const { return state_->records; }
const std::vector<BreakRecord>& World::breaks() const { return state_->fracture.breaks(); }
bool World::records_contacts() const { return state_->log && state_->log->has_records(); }

Snapshot World::snapshot() const {
    const State& s = *state_;
    const BodySet& set = s.set;
    Snapshot snapshot;
    snapshot.frame = s.steps / s.settings.steps_per_frame;
    snapshot.time = s.clock.seconds(s.steps);
    snapshot.bodies.resize(set.bodies.size());
    for (std::uint32_t i = 0; i < set.bodies.size(); ++i) {
        const Body& body = set.bodies[s.fracture.bodies().mover_of(i)];
        BodyState state{set.origin + body.origin(), set.origin + body.position, body.orientation, body.velocity,
                        body.angular_velocity};
        state.asleep = body.asleep;
        if (body.dynamic()) {
            state.mass = body.mass;
            state.momentum = body.momentum;
            state.angular_momentum = body.angular_momentum;
        }
        s.fracture.bodies().describe(i, body, state);
        if (body.track) {  // the path's own velocity at this time, not the mean over the coming step
            const BodyVelocity now = velocity_on_track(body, snapshot.time);
            state.velocity = now.velocity;
            state.angular_velocity = now.angular_velocity;
        }
        snapshot.bodies[set.scene_index[i]] = state;
    }
    return snapshot;
}

std::vector<JointState> World::State::joint_states() const {
    std::vector<JointState> states = joints.states(set.bodies);
    for (JointState& joint : states) {
        joint.point += set.origin;
        joint.mean_moment += set.origin.cross(joint.mean_force);
    }
    return states;
}

std::vector<JointState> World::joint_states() const { return state_->joint_states(); }

JointReport World::joint_report() const {
    return describe_joints(state_->joints, state_->set.bodies, sweep_rule(state_->settings));
}

Measurement World::measure() const {
    const State& s = *state_;
    Measurement m = measure_motion(s.set.bodies, s.settings.gravity, s.set.origin);
    m.potential += s.forces.field().potential(s.set.bodies) + s.forces.field().water_potential(s.set.bodies);
    m.elastic = s.joints.elastic(s.set.bodies);
    const double rotors = s.joints.rotor_energy(s.set.bodies);
    m.kinetic += rotors;
    m.kinetic_angular += rotors;
    s.with_present_contacts([&](const std::vector<Manifold>& found) { measure_contacts(found, s.set.bodies, m); });
    return m;
}

std::vector<Overlap> World::overlaps() const {
    const State& s = *state_;
    std::vector<Overlap> overlaps;
    s.with_present_contacts(
        [&](const std::vector<Manifold>& found) { overlaps = overlaps_of(found, s.set.bodies, s.set.scene_index); });
    return overlaps;
}

BodyReport World::report(std::size_t index) const {
    const BodySet& set = state_->set;
    BodyReport report = describe(set.bodies[set.of_scene[index]]);
    state_->fracture.bodies().describe(set.of_scene[index], report);
    return report;
}

void World::save(CheckpointWriter& writer) const {
    const State& s = *state_;
    State::visit(writer, s);
    s.motion->save(writer);
    writer.keep(records_contacts());
    if (records_contacts()) writer.keep(*s.log, s.records);
}

void World::restore(CheckpointReader& reader) {
    State& s = *state_;
    TUMBLE_CHECK_EQ(s.steps, 0);
    const bool records = s.log != nullptr;
    State::visit(reader, s);
    s.motion->restore(reader, s.steps);
    s.fracture.restored(s.context(), *s.motion);
    bool recorded = false;
    reader.keep(recorded);
    if (records && !recorded)
        CheckpointReader::fail("has no records of contacts: give the tables to simulate --checkpoints too");
    if (!recorded) return;
    ContactLog unused({}, Vec3::Zero(), Vec3::Zero(), ContactLog::Detail::records);
    ContactRecords unused_records;
    reader.keep(records ? *s.log : unused, records ? s.records : unused_records);
}

}  // namespace tumble
