// Event-driven mode (impacts = "exact"): impacts at their own times. Every body without contact moves on a trajectory
// in closed form; its next event is predicted, the earliest of all events is processed, and only the bodies that it
// concerns are predicted again (Mirtich 2000, "Timewarp rigid body simulation", each body on its own clock;
// Sigurgeirsson, Stuart, Wan 2001 for the queue). The cost of a scene scales with its impacts, not its steps.
//
// Bodies in contact are stepped by World and take part here with their motion through the step. A bounce below the Zeno
// limit switches to contact; a body that no contact holds any more is released. Groups of joined bodies fly, land and
// are released as a whole (group_flights.h).
#pragma once

#include "sim/ccd/ccd_clamp.h"
#include "sim/ccd/time_of_impact.h"
#include "sim/ccd/trajectory.h"
#include "sim/contact/contact_solver.h"
#include "sim/contact/model/contact.h"
#include "sim/contact/model/sleep.h"
#include "sim/contact/rolling/rolling_contact.h"
#include "sim/dynamics/forces.h"
#include "sim/event_driven/contact_transition.h"
#include "sim/event_driven/driven_flights.h"
#include "sim/event_driven/event_queue.h"
#include "sim/event_driven/event_time.h"
#include "sim/event_driven/group_flights.h"
#include "sim/event_driven/impact_cluster.h"
#include "sim/event_driven/neighbor_boxes.h"
#include "sim/fracture/blow.h"
#include "sim/impact/impacts.h"
#include "sim/snapshot/contact_records.h"

#include <limits>
#include <optional>
#include <vector>

namespace tumble::tuning {

/// Largest number of impacts in a frame per body: far beyond any clip (a million hits of each body per second). Not
/// fitted.
inline constexpr std::int64_t impacts_in_frame = 20000;

/// The box of a ballistic body in the neighbor search covers a displacement between these bounds, radii.
inline constexpr double shortest_box_displacement = 0.75;
inline constexpr double longest_box_displacement = 40.0;

}  // namespace tumble::tuning

namespace tumble {

class ContactLog;

/// A fixed half-space in the world frame: a quick test of ballistic bodies above it.
struct HalfSpaceFilter {
    Vec3 normal = Vec3::UnitY();
    double offset = 0.0;  // m: normal . p of its surface
    bool valid = false;   // otherwise this body is no half-space

    /// True if a ball of this radius (m) about the center of a body certainly stays above for `horizon` s from the
    /// trajectory's time `from` on: it is above at the start and at the end, and does not fall and rise again in
    /// between.
    bool stays_below(const Trajectory& path, double radius, double from, double horizon) const;
};

class EventDrivenMotion {
public:
    EventDrivenMotion(const std::vector<Body>& bodies, const SimulationSettings& settings, double fps);

    /// The joints of the coming step. All must outlive the run.
    void join(JointSet& joints, std::vector<Body>& bodies, const ForceField& forces);
    /// Groups of joined bodies end their flights of the step.
    void end_flights() { groups_.end_all(); }
    /// Stepped bodies that no contact holds become ballistic at `step`.
    void take_off(const std::vector<Contact>& contacts, const std::vector<Gap>& gaps, std::vector<Body>& bodies,
                  const ForceField& forces, std::int64_t step);
    /// True if any body needs stepping: one in contact, a moving kinematic one, one under varying forces.
    bool stepping(const std::vector<Body>& bodies) const;
    /// Starts the trajectories of stepped and kinematic bodies through the coming step. By body: `motions`, of stepped
    /// bodies; `limits`, the fraction of the step for which they may move.
    void begin_step(std::vector<Body>& bodies, const std::vector<BodyVelocity>& motions,
                    const std::vector<CcdFraction>& limits, const ForceField& forces, std::int64_t step);
    /// Keeps bodies that have fallen asleep at their positions from `step` on, until something wakes them: ballistic
    /// bodies meet them there, even if no body is stepped.
    void lay_down(const std::vector<Body>& bodies, std::int64_t step);
    /// Processes all events up to the start of step `until`, or of the step after the first switch to contact if that
    /// is earlier; returns that step. Throws RunError when a frame has too many impacts to be physical.
    std::int64_t run(std::vector<Body>& bodies, SleepMonitor& sleep, const ForceField& forces, std::int64_t until);
    /// Where impacts and the contacts of landings are recorded; null: nowhere. It must outlive the last run().
    void record_in(ContactLog* log) { log_ = log; }
    /// Blows that break a body, at the time of an impact; null without breakable bodies. The result is that of the last
    /// one. Both must outlive the last run().
    using Strike = std::function<const BlowResult*(const Island&, const std::vector<Contact>&, const ImpactSettings&,
                                                   const ImpactTime&)>;
    void break_by(Strike strike) { strike_ = std::move(strike); }
    /// Bodies have vanished or appeared at the start of a step.
    void exchange(const std::vector<Body>& bodies, std::span<const std::uint32_t> changed, const EventTime& now);
    /// Bodies have other shapes than those that it was built with; no body has another motion.
    void measure(const std::vector<Body>& bodies);
    /// True if all events before the step have been processed, and none after it.
    bool stands_at(std::int64_t step) const {
        return until_ == step && (queue_.empty() || !(queue_.first_moment() < EventTime{step, 0.0}));
    }
    /// The velocities of kinematic bodies at the start of the step, by body. They must outlive the last run().
    void start_from(const std::vector<BodyVelocity>& velocities) { at_start_ = &velocities; }
    /// Moves all moving bodies to their poses at the start of a step.
    void place(std::vector<Body>& bodies, std::int64_t step) const;

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [settings, clock, h, events, balls, half_spaces, movers, neighbor_boxes, queue, search, groups, driven,
               cluster, log, trace, totals, ccd_clamp, motions, islands, contact_solver, alone, contact_manifolds,
               velocities_before, impacts_in_frame, frame, until, taken_off, changed, was_asleep, rolled, supports,
               at_start, strike] = self;
        archive.rebuilt(settings, clock, h, half_spaces, movers, log, motions, islands, at_start, strike);
        archive.keep_each(balls);
        archive.by_body(events);
        archive.by_body(velocities_before);
        archive.keep(neighbor_boxes, queue, search, cluster, ccd_clamp, contact_solver);
        archive.count(impacts_in_frame, frame);
        archive.between(0, until, EventTime::last_step);
        archive.bodies(taken_off);
        archive.bodies(changed);
        archive.scratch(groups, driven, trace, totals, alone, contact_manifolds, was_asleep, rolled, supports);
    }

private:
    static constexpr double unknown = std::numeric_limits<double>::infinity();
    static inline const Bounds everywhere{Vec3::Constant(-infinity), Vec3::Constant(infinity)};
    struct BodyEvent {
        Trajectory path;
        EventTime start;            // start of the trajectory
        EventTime until;            // end of the trajectory's validity; far away for free flights
        std::uint32_t version = 0;  // number of the trajectory
        bool driven = false;        // without contact, but under varying forces
        bool pushed = false;        // this step's forces at points are applied already, up to its end
        bool solved = false;        // in contact since the start of the last step: its solve knows the loads
        Vec3 turn_from = Vec3::Zero(), turn_to = Vec3::Zero();  // L at the trajectory's ends, of a driven body
        Bounds swept = everywhere;                              // m, world: holds the body throughout the trajectory
        EventTime boxed_until;  // time until which the body stays in its box of NeighborBoxes
        double box_displacement = tuning::shortest_box_displacement;  // in radii, length of trajectory in the next box
        // The next event.
        enum class Event { leaves_box, recheck, impact, drives_on } event = Event::leaves_box;
        std::uint32_t partner = 0, partner_version = 0;
        EventTime last_impact;
        double since_impact = 0.0;  // s, between the last two impacts
        int impacts_in_row = 0;
        // body that a body in contact meets at the end of its trajectory, before the step ends
        std::uint32_t met = CcdFraction::none;
        int meetings = 0;  // number of meetings in this step
        double spin =
            unknown;  // J, twice the energy: of a body in contact without impacts since the start of its trajectory
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [path, start, until, version, driven, pushed, solved, turn_from, turn_to, swept, boxed_until,
                   box_displacement, event, partner, partner_version, last_impact, since_impact, impacts_in_row, met,
                   meetings, spin] = self;
            archive.keep(path, start, until, driven, pushed, solved, turn_from, turn_to, swept, boxed_until,
                         box_displacement, last_impact, since_impact);
            archive.unbounded(spin);
            archive.enumeration(event, Event::drives_on);
            archive.body(partner);
            archive.body_or(CcdFraction::none, met);
            archive.any(version, partner_version);
            archive.count(impacts_in_row, meetings);
        }
    };

    void start(std::uint32_t i, const Trajectory& path, const EventTime& now, const EventTime& until);
    void fly(std::uint32_t i, std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    void drive(std::uint32_t i, Body& body, const EventTime& now, const EventTime& end);
    /// True if the body has states of its flight that are more exact than its trajectory.
    bool flies_driven(std::uint32_t i, const std::vector<Body>& bodies) const {
        return bodies[i].flying && events_[i].driven;
    }
    void fly_pairs(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    void fly_changed(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    /// True if the body flies with a group of joined bodies.
    bool flies_joined(std::uint32_t i, const std::vector<Body>& bodies) const {
        return bodies[i].flying && groups_.group(i) != GroupFlights::none;
    }
    bool fly_group(std::uint32_t group, std::vector<Body>& bodies, const EventTime& now);
    void take_off_groups(std::vector<Body>& bodies, const ForceField& forces, std::int64_t step);
    void land_group(std::uint32_t group, std::vector<Body>& bodies);
    /// Whereabouts of a body that flies with a group; none for others.
    std::optional<ImpactCluster::Whereabouts> whereabouts(std::uint32_t i, const std::vector<Body>& bodies,
                                                          const EventTime& now) const;
    TimeOfImpact refine(std::uint32_t i, std::uint32_t j, const TimeOfImpact& found, const std::vector<Body>& bodies,
                        const EventTime& now, double limit);
    void end_group_flights(std::vector<Body>& bodies, const EventTime& now);
    void fly_groups(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    void release_groups(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    bool roll_rest(std::uint32_t k, std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    void solve_rest(const std::vector<std::uint32_t>& landed, std::vector<Body>& bodies, const ForceField& forces,
                    const EventTime& now);
    void give_rest_of_step(std::uint32_t k, std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    EventTime drive_end(std::uint32_t i, double rate, const EventTime& now) const;
    void bring(std::uint32_t i, std::vector<Body>& bodies, const EventTime& now);
    void show(std::uint32_t i, std::vector<Body>& bodies, const EventTime& now) const;
    void box(std::uint32_t i, const std::vector<Body>& bodies, const EventTime& now);
    void predict(std::uint32_t i, const std::vector<Body>& bodies, const EventTime& now);
    void predict_changed(const std::vector<Body>& bodies, const EventTime& now);
    void support_stepped(const std::vector<Body>& bodies);
    void release_receivers(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    void switch_to_contact(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    void hold_receivers(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    /// True if the body's trajectory ends now, at the other body.
    bool meets(std::uint32_t i, std::uint32_t other, const EventTime& now) const {
        return events_[i].met == other && events_[i].until <= now;
    }
    void hold(std::uint32_t i, const BodyVelocity& motion, const CcdFraction& limit, const std::vector<Body>& bodies,
              const EventTime& now);
    void wake(std::uint32_t i, std::vector<Body>& bodies, SleepMonitor& sleep, const EventTime& now);
    void collide(std::uint32_t i, std::uint32_t j, std::vector<Body>& bodies, SleepMonitor& sleep,
                 const ForceField& forces, const EventTime& now);
    bool bounce_balls(std::uint32_t i, std::uint32_t j, const std::vector<Body>& bodies, const EventTime& now);
    bool alone(std::uint32_t i, std::uint32_t but, const Vec3& at, const std::vector<Body>& bodies,
               const EventTime& now) const;
    void break_bodies(const BlowResult& blow, std::vector<Body>& bodies, SleepMonitor& sleep, const ForceField& forces,
                      const EventTime& now);
    void list_movers(const std::vector<Body>& bodies);
    void count_impact(std::uint32_t i, const std::vector<Body>& bodies, const EventTime& now);
    bool below_zeno_limit(std::uint32_t i, const std::vector<Body>& bodies, double speed) const;
    double zeno_limit(std::uint32_t i) const;
    FreeMotion free_motion(const ForceField& forces, const EventTime& now) const {
        return {forces, *at_start_, clock_.seconds(now), clock_.seconds(now.step + 1), h_};
    }
    ImpactTime impact_time(const EventTime& now) const;
    EventTime later(const EventTime& now, double seconds) const;
    MovingBody moving_body(std::uint32_t i, const std::vector<Body>& bodies, const EventTime& now) const;

    // Data of a ball under gravity alone that its neighbors need, close together in memory: with many balls they
    // dominate the cost of the search.
    struct Ballistic {
        Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();  // at start
        EventTime start;
        double radius = 0.0;
        bool valid = false;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [position, velocity, start, radius, valid] = self;
            archive.rebuilt(radius);
            archive.keep(position, velocity, start, valid);
        }
    };
    /// The time between two event times without the last digit, for deciding whether to compute exactly.
    double roughly(const EventTime& from, const EventTime& to) const {
        return double(to.step - from.step) * h_ + (to.offset - from.offset);
    }
    Vec3 position(const Ballistic& ball, double t) const {
        return ball.position + t * (ball.velocity + 0.5 * t * settings_.gravity);
    }

    SimulationSettings settings_;
    StepClock clock_;
    double h_;
    std::vector<BodyEvent> events_;
    std::vector<Ballistic> balls_;              // by body
    std::vector<HalfSpaceFilter> half_spaces_;  // by body: fixed half-spaces, world frame
    std::vector<std::uint32_t> movers_;         // dynamic bodies and moving kinematic ones
    NeighborBoxes neighbor_boxes_;
    EventQueue queue_;
    ImpactSearch search_;
    GroupFlights groups_;
    DrivenFlights driven_;
    ImpactCluster cluster_{groups_};
    ContactLog* log_ = nullptr;
    ImpactTrace trace_;                    // of the last impact, for the log
    std::vector<ManifoldImpulse> totals_;  // of a landing, for the log
    CcdClamp ccd_clamp_;                 // for bodies after a switch to contact or an impact, to the end of their step
    std::vector<BodyVelocity> motions_;  // by body, for ccd_clamp_; zero in between
    ContactIslands islands_;
    ContactSolver contact_solver_;
    ThreadPool alone_{1};
    std::vector<Manifold> contact_manifolds_;
    std::vector<BodyVelocity> velocities_before_;
    std::int64_t impacts_in_frame_ = 0, frame_ = 0;
    std::int64_t until_ = 0;                                       // of the current run
    std::vector<std::uint32_t> taken_off_, changed_, was_asleep_;  // bodies with new trajectories
    std::vector<RolledContact> rolled_;                            // bodies that have landed in the event at hand
    Supports supports_;
    const std::vector<BodyVelocity>* at_start_ = nullptr;
    Strike strike_;
};

}  // namespace tumble
