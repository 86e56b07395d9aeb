// Impacts at the moment they happen (impacts = "exact"). Every body that nothing holds flies on a path known in closed
// form; its next event is predicted, the earliest of all events happens, and only those it concerns are predicted again
// (Mirtich 2000, "Timewarp rigid body simulation", each body on its own clock; Sigurgeirsson, Stuart, Wan 2001 for the
// queue). A scene costs its impacts, not its steps.
//
// Bodies held by contacts are stepped by World and take part here with their way through the step. A bounce that has
// become too short to follow passes into contact ("landing"), a body that nothing holds any more takes off.
#pragma once

#include "sim/contact/model/contact.h"
#include "sim/contact/contact_solver.h"
#include "sim/event_driven/settings.h"
#include "sim/impact/impacts.h"
#include "sim/contact/model/sleep.h"
#include "sim/event_driven/event_queue.h"
#include "sim/event_driven/half_space_filter.h"
#include "sim/event_driven/impact_cluster.h"
#include "sim/event_driven/event_time.h"
#include "sim/ccd/ccd_clamp.h"
#include "sim/event_driven/neighbor_boxes.h"
#include "sim/ccd/trajectory.h"
#include "sim/ccd/time_of_impact.h"
#include "sim/dynamics/forces.h"

#include <limits>
#include <vector>

namespace tumble {

class EventDrivenMotion {
public:
    EventDrivenMotion(const std::vector<Body>& bodies, const SimulationSettings& settings, double fps);

    /// Stepped bodies that none of the contacts holds begin to fly at `step`. Returns whether any did.
    bool take_off(const std::vector<Contact>& contacts, std::vector<Body>& bodies, const ForceField& forces, std::int64_t step);
    /// Whether something has to be stepped: a body in contact, a moving kinematic one, one under forces that change.
    bool stepping(const std::vector<Body>& bodies) const;
    /// The ways of stepped and kinematic bodies through the step that begins. By body: `motions`, what stepped ones move with;
    /// `limits`, how much of the step they may go.
    void begin_step(std::vector<Body>& bodies, const std::vector<BodyVelocity>& motions, const std::vector<CcdFraction>& limits,
                    const ForceField& forces, std::int64_t step);
    /// What has fallen asleep lies where it is from `step` on, for as long as nothing wakes it: what flies meets it there, though
    /// nothing be stepped any more.
    void lay_down(const std::vector<Body>& bodies, std::int64_t step);
    /// All events up to the beginning of step `until`, or of the step after the first landing if that is earlier; returns
    /// which. Throws RunError when a frame holds more impacts than it can mean.
    std::int64_t run(std::vector<Body>& bodies, SleepMonitor& sleep, const ForceField& forces, std::int64_t until);
    /// Brings all moving bodies to where they are at the beginning of a step.
    void place(std::vector<Body>& bodies, std::int64_t step) const;

private:
    static constexpr double unknown = std::numeric_limits<double>::infinity();
    struct BodyEvent {
        Trajectory path;
        EventTime start;                 // of the path
        EventTime until;                 // the path is not known beyond; far away for free flights
        std::uint32_t version = 0;    // counts the paths
        bool driven = false;          // free, but under forces that are not constant
        bool pushed = false;          // this step's forces at points have acted on it already, up to the step's end
        Vec3 turn_from = Vec3::Zero(), turn_to = Vec3::Zero();   // L at the path's ends, of a driven body
        EventTime boxed_until;           // in its box of the neighbourhood up to then
        double box_way = tuning::shortest_box_way;   // radii, that the next box shall hold of its way
        // The next event.
        enum class Event { leaves_box, looks_again, impact, drives_on } event = Event::leaves_box;
        std::uint32_t partner = 0, partner_version = 0;
        EventTime last_impact;
        double since_impact = 0.0;    // s, between the last two
        int impacts_in_row = 0;
        std::uint32_t met = CcdFraction::none;   // whom a held body meets where its path ends, before the step does
        int meetings = 0;             // in this step
        double spin = unknown;        // J, twice the energy: of a held body that nothing has struck since its path began
    };

    void start(std::uint32_t i, const Trajectory& path, const EventTime& now, const EventTime& until);
    void fly(std::uint32_t i, std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    EventTime drive_end(std::uint32_t i, const ForceField& forces, const EventTime& now) const;
    void bring(std::uint32_t i, std::vector<Body>& bodies, const EventTime& now) const;
    void show(std::uint32_t i, std::vector<Body>& bodies, const EventTime& now) const;
    void box(std::uint32_t i, const std::vector<Body>& bodies, const EventTime& now);
    void predict(std::uint32_t i, const std::vector<Body>& bodies, const EventTime& now);
    void predict_changed(const std::vector<Body>& bodies, const EventTime& now);
    void release_struck(std::vector<Body>& bodies);
    void land(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    void hold_struck(std::vector<Body>& bodies, const ForceField& forces, const EventTime& now);
    /// Whether the body's path ends now, at the other body.
    bool meets(std::uint32_t i, std::uint32_t other, const EventTime& now) const { return fliers_[i].met == other && fliers_[i].until <= now; }
    void hold(std::uint32_t i, const BodyVelocity& motion, const CcdFraction& limit, const std::vector<Body>& bodies, const EventTime& now);
    void wake(std::uint32_t i, std::vector<Body>& bodies, SleepMonitor& sleep, const EventTime& now);
    void collide(std::uint32_t i, std::uint32_t j, std::vector<Body>& bodies, SleepMonitor& sleep, const ForceField& forces, const EventTime& now);
    bool bounce_balls(std::uint32_t i, std::uint32_t j, const std::vector<Body>& bodies, const EventTime& now);
    bool alone(std::uint32_t i, std::uint32_t but, const Vec3& at, const std::vector<Body>& bodies, const EventTime& now) const;
    void count_impact(std::uint32_t i, const std::vector<Body>& bodies, const EventTime& now);
    bool stutters(std::uint32_t i, const std::vector<Body>& bodies, double speed) const;
    double landing_time(std::uint32_t i) const;
    EventTime later(const EventTime& now, double seconds) const;
    Traveller traveller(std::uint32_t i, const std::vector<Body>& bodies, const EventTime& now) const;

    // Of a ball in flight under gravity alone, what its neighbours ask for, close together in memory: with many balls the
    // search is made of little else.
    struct Ballistic {
        Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();   // at start
        EventTime start;
        double radius = 0.0;
        bool valid = false;
    };
    /// The time between two moments without the last digit, for what only decides whether to look closer.
    double roughly(const EventTime& from, const EventTime& to) const { return double(to.step - from.step) * h_ + (to.offset - from.offset); }
    Vec3 position(const Ballistic& ball, double t) const { return ball.position + t * (ball.velocity + 0.5 * t * settings_.gravity); }

    SimulationSettings settings_;
    StepClock clock_;
    double h_;
    std::vector<BodyEvent> fliers_;
    std::vector<Ballistic> balls_;        // by body
    std::vector<HalfSpaceFilter> grounds_;         // by body: fixed half-spaces, world frame
    std::vector<std::uint32_t> movers_;   // dynamic and kinematically moving bodies
    NeighborBoxes neighbourhood_;
    EventQueue queue_;
    ImpactSearch search_;
    ImpactCluster cluster_;
    CcdClamp motion_limit_;            // of what has landed or was struck, to the end of its step
    std::vector<BodyVelocity> motions_;   // by body, for that; zero in between
    ContactIslands islands_;
    ContactSolver contact_solver_;
    ThreadPool alone_{1};
    std::vector<Manifold> landing_manifolds_;
    std::vector<BodyVelocity> velocities_before_;
    std::int64_t impacts_in_frame_ = 0, frame_ = 0;
    std::int64_t until_ = 0;              // of the run under way
    std::vector<std::uint32_t> taken_off_, changed_, was_asleep_;   // whose paths are new
    std::vector<bool> held_;
};

}  // namespace tumble
