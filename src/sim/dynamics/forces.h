// External forces and torques on a body (notes section 3): gravity, wind, fields, forces between bodies, forces at
// points, and water.
//
// A body that moves freely in water takes some of the water along: its forces are then those that are left for itself.
// Bodies in contact and bodies in joints take the whole forces, so that loads at rest are exact.
#pragma once

#include "scene/description/description.h"
#include "sim/dynamics/body.h"
#include "sim/dynamics/flight_point.h"
#include "sim/fields/explosions.h"
#include "sim/fields/pair_forces.h"
#include "sim/math/wrench.h"
#include "sim/water/water_forces.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace tumble {

/// kg, for PairForces: infinity of a body that no force moves; 0 of an absent one.
inline double pair_mass(const Body& body) { return body.absent ? 0.0 : body.dynamic() ? body.mass : infinity; }

class ForceField {
public:
    /// `order`: the scene index of each body; without it, the scene's order. `origin`: m, world, of the coordinates.
    explicit ForceField(const SceneDescription& scene, std::span<const std::uint32_t> order = {},
                        const Vec3& origin = Vec3::Zero());

    const PairForces& pairs() const { return pairs_; }
    /// See PairForces::break_up().
    void break_pairs(std::span<const BodyInPieces> broken) {
        pairs_.break_up(broken);
        held_.assign(pairs_.bodies().size(), Wrench());
    }
    /// Takes the forces between the bodies at their present places as those of the step [from, to).
    void hold_pairs(const std::vector<Body>& bodies, double from, double to);
    /// Turns the explosions in [from, to), the step that begins, into forces at points of the bodies at their present
    /// poses. They end with the step.
    void light_explosions(const std::vector<Body>& bodies, double from, double to);
    /// The forces at points of a body (m, body frame, from its origin) act on other bodies with the same frame: on that
    /// which `to` names.
    void move_points(std::size_t from, const std::function<std::uint32_t(const Vec3& point)>& to);
    /// Calls `use` for each force at a point of the body at a time, s.
    void each_point(std::size_t index, double time, const std::function<void(const ForceDescription&)>& use) const;
    const Explosions& explosions() const { return explosions_; }
    bool has_potential() const { return !place_.empty() || !pairs_.empty() || water_; }
    /// J, in fields and in forces between bodies.
    double potential(const std::vector<Body>& bodies) const;
    bool has_water() const { return water_ != nullptr; }
    /// The body, a piece of another one, has another shape from now on.
    void reshape(std::size_t index, const Body& body) {
        if (water_) water_->reshape(index, body.collider);
    }
    /// J, of the water that bodies displace. Zero with waves, whose forces have no potential.
    double water_potential(const std::vector<Body>& bodies) const;
    /// The forces of the water alone in throughout().
    Wrench water(std::size_t index, const Body& body, double from, double to, bool flies) const;
    /// True if water at rest carries a part of the body's weight; true if moving water keeps it in motion.
    bool afloat(std::size_t index, const Body& body) const;
    bool stirred(std::size_t index, const Body& body, double time) const;

    /// The sum of all forces on the body at time t (s), for its present state.
    Wrench at(std::size_t index, const Body& body, double time) const {
        return at(index, body, body.position, {body.velocity, body.angular_velocity}, body.rotation, time);
    }
    /// The same for another place (m), other velocities and another rotation: reads only constant properties of the
    /// body. Forces between bodies are those held.
    Wrench at(std::size_t index, const Body& body, const Vec3& position, const BodyVelocity& velocity,
              const Mat3& rotation, double time) const;
    /// Times (s) of a part of a flight within which no force begins or ends: its middle, and the start of the span.
    struct FlightTime {
        double middle, start;
    };
    /// The sum of all forces on a body that moves freely. `pull`: of the forces between bodies.
    Wrench in_flight(std::size_t index, const Body& body, const FlightPoint& at, const FlightTime& time,
                     const Wrench& pull) const;
    /// The forces between bodies that are held.
    Wrench held(std::size_t index) const;

    /// Gravity, wind and fields in [from, to), for the body's present state.
    Wrench fields(std::size_t index, const Body& body, double from, double to) const;
    /// The same and the forces at points that act throughout [from, to), for the body's present state. `flies`: no
    /// contact and no joint holds it.
    Wrench throughout(std::size_t index, const Body& body, double from, double to, bool flies = false) const;
    /// The same without forces that end at some time: for the part of a step that a clamped body loses.
    Wrench endless(std::size_t index, const Body& body, double from, double to) const;
    /// The impulse within [from, to) of the forces at points that act in only a part of it. The body rotates freely
    /// from its present state at `from` to the middle of that part.
    Impulse brief(std::size_t index, const Body& body, double from, double to) const;
    /// The impulse within [from, to) of the forces at points that end at some time, brief or not: such a force has a
    /// total impulse.
    Impulse ending(std::size_t index, const Body& body, double from, double to) const;
    bool has_points(std::size_t index) const { return !at_points_[index].empty(); }
    /// Without the forces at points of these bodies: for spans in which they have been applied already.
    ForceField without_points(std::span<const std::uint32_t> bodies) const;

    /// True if a point force on the body begins or ends within [from, to): such a body must be awake.
    bool changes(std::size_t index, double from, double to) const;
    /// True if a field begins or ends within [from, to): then all bodies must be awake.
    bool fields_change(double from, double to) const { return !place_.empty() && place_.changes(from, to); }
    /// The first time after `time` at which a point force on the body begins or ends; infinity when there is none.
    double next_change(std::size_t index, double time) const;
    /// True if only gravity acts on the body throughout [from, to): its motion is then known in closed form.
    bool constant(std::size_t index, double from, double to) const;
    /// True if neither a point force nor a dipole acts on the body at a time, so that it has no torque.
    bool torque_free(std::size_t index, double time) const;
    /// Rate of deceleration by drag: |dF/dv| / m per m/s of the speed relative to the air, 1/m.
    double drag_rate(const Body& body) const;
    /// Fastest rate at which fields and water change the motion at a time, 1/s.
    double field_rate(std::size_t index, const Body& body, const FlightPoint& at, double time) const {
        return (place_.empty() ? 0.0 : place_.rate({body.mass, at.position, at.velocity}, time)) +
               (water_ ? water_rate(index, body, at, time) : 0.0);
    }
    /// Fastest rate at which a body passes centers of fields, and bodies with forces between each other pass, 1/s.
    double passing_rate(const Body& body, double time) const {
        return place_.empty() ? 0.0 : place_.passing_rate({body.mass, body.position, body.velocity}, time);
    }
    double pair_rate(const std::vector<Body>& bodies, double time) const;
    /// Number of parts of a span in which a body in water neither bobs, nor is braked, nor gets wet within one.
    double parts_in_water(std::size_t index, const Body& body, const FlightPoint& at, double from, double to) const;
    double water_rate(std::size_t index, const Body& body, const FlightPoint& at, double time) const;
    /// The air's velocity, m/s.
    Vec3 wind() const { return wind_ ? wind_->velocity : Vec3(Vec3::Zero()); }

    const Vec3& gravity() const { return gravity_; }  // m/s^2

    /// True if nothing but gravity acts on the body: ever, but for explosions of other steps.
    bool only_gravity(std::size_t index) const { return plain(index) && at_points_[index].empty(); }
    /// True if some force can begin while all bodies are at rest.
    bool ever_begins() const { return !pushed_.empty() || !place_.empty() || !pairs_.empty(); }
    /// Bodies with forces at points, and with explosions all dynamic bodies; ascending.
    std::span<const std::uint32_t> pushed() const { return pushed_; }

private:
    template <class Choose>
    void add_points(Wrench& sum, std::size_t index, const Body& body, const Mat3& rotation, const Choose& choose) const;
    template <class Choose>
    Impulse impulse(std::size_t index, const Body& body, double from, double to, const Choose& choose) const;
    bool plain(std::size_t index) const {
        return !wind_ && !water_ && place_.empty() && (pairs_.empty() || !pairs_.has(std::uint32_t(index)));
    }
    Wrench weather(const Body& body, const Vec3& velocity) const;
    Wrench alone(std::size_t index, const Body& body, const MassPoint& point, const Mat3& rotation, double time) const;
    Wrench dry_fields(std::size_t index, const Body& body, double from, double to) const;
    Wrench throughout_dry(std::size_t index, const Body& body, double from, double to) const;
    void add_water(Wrench& sum, std::size_t index, const Body& body, double time, double h, bool flies) const;

    Vec3 gravity_;
    std::optional<WindDescription> wind_;
    std::vector<std::vector<ForceDescription>> at_points_;  // by body
    std::vector<std::uint32_t> pushed_;
    PositionForces place_;
    Explosions explosions_;
    std::vector<std::uint32_t> blasted_;  // bodies with forces of explosions, which stand last in at_points_
    PairForces pairs_;
    std::vector<Wrench> held_;            // in the order of PairForces::bodies()
    std::shared_ptr<WaterForces> water_;  // null: none
};

}  // namespace tumble
