// External forces and torques on a body (notes section 3): gravity, wind, and forces at points.
#pragma once

#include "scene/description/description.h"
#include "sim/dynamics/body.h"
#include "sim/math/wrench.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class ForceField {
public:
    /// `order`: the scene index of each body; without it, the scene's order.
    explicit ForceField(const SceneDescription& scene, std::span<const std::uint32_t> order = {});

    /// The sum of all forces on the body at time t (s), for its present state.
    Wrench at(std::size_t index, const Body& body, double time) const {
        return at(index, body, body.velocity, body.rotation, time);
    }
    /// The same for another velocity (m/s) and rotation: reads only constant properties of the body.
    Wrench at(std::size_t index, const Body& body, const Vec3& velocity, const Mat3& rotation, double time) const;

    /// Gravity and wind, for the body's present state.
    Wrench fields(const Body& body) const { return fields(body, body.velocity); }
    /// Gravity, wind and the forces at points that act throughout [from, to), for the body's present state.
    Wrench throughout(std::size_t index, const Body& body, double from, double to) const;
    /// The same without forces that end at some time: for the part of a step that a clamped body loses.
    Wrench endless(std::size_t index, const Body& body, double from, double to) const;
    /// The impulse within [from, to) of the forces at points that act in only a part of it. The body rotates freely
    /// from its present state at `from` to the middle of that part.
    Impulse brief(std::size_t index, const Body& body, double from, double to) const;
    /// The impulse within [from, to) of the forces at points that end at some time, brief or not: such a force has a
    /// total impulse.
    Impulse ending(std::size_t index, const Body& body, double from, double to) const;
    /// Gravity and wind alone: for spans in which the forces at points have been applied already.
    ForceField without_points() const;

    /// True if a point force on the body begins or ends within [from, to): such a body must be awake.
    bool changes(std::size_t index, double from, double to) const;
    /// The first time after `time` at which a point force on the body begins or ends; infinity when there is none.
    double next_change(std::size_t index, double time) const;
    /// True if only gravity acts on the body throughout [from, to): its motion is then known in closed form.
    bool constant(std::size_t index, double from, double to) const;
    /// True if no point force acts on the body at a time, so that it has no torque.
    bool torque_free(std::size_t index, double time) const;
    /// Rate of deceleration by drag: |dF/dv| / m per m/s of the speed relative to the air, 1/m.
    double drag_rate(const Body& body) const;
    /// The air's velocity, m/s.
    Vec3 wind() const { return wind_ ? wind_->velocity : Vec3(Vec3::Zero()); }

    const Vec3& gravity() const { return gravity_; }  // m/s^2

    /// True if nothing but gravity ever acts on the body; true if forces at points ever act on any body.
    bool only_gravity(std::size_t index) const { return !wind_ && at_points_[index].empty(); }
    bool ever_changes() const { return !pushed_.empty(); }
    /// Bodies with forces at points, ascending.
    std::span<const std::uint32_t> pushed() const { return pushed_; }

private:
    template <class Choose>
    void add_points(Wrench& sum, std::size_t index, const Body& body, const Mat3& rotation, const Choose& choose) const;
    template <class Choose>
    Impulse impulse(std::size_t index, const Body& body, double from, double to, const Choose& choose) const;
    Wrench fields(const Body& body, const Vec3& velocity) const;

    Vec3 gravity_;
    std::optional<WindDescription> wind_;
    std::vector<std::vector<ForceDescription>> at_points_;  // by body
    std::vector<std::uint32_t> pushed_;
};

}  // namespace tumble
