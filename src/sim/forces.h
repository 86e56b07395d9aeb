// External forces and torques on a body (notes section 3): gravity, wind, and forces at points.
#pragma once

#include "scene/description.h"
#include "sim/body.h"
#include "sim/wrench.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class ForceField {
public:
    /// `order`: which of the scene's bodies each index stands for; without, the same one.
    explicit ForceField(const SceneDescription& scene, std::span<const std::uint32_t> order = {});

    /// The sum of all that acts on the body at time t (s), for its present state.
    Wrench at(std::size_t index, const Body& body, double time) const {
        return at(index, body, body.velocity, body.rotation, time);
    }
    /// The same for another velocity (m/s) and rotation: of the body only what does not move is looked at.
    Wrench at(std::size_t index, const Body& body, const Vec3& velocity, const Mat3& rotation, double time) const;

    /// Whether a point force on the body begins or ends within [from, to): such a body must be awake.
    bool changes(std::size_t index, double from, double to) const;
    /// The first time after `time` at which a point force on the body begins or ends; infinity when there is none.
    double next_change(std::size_t index, double time) const;
    /// Whether only gravity acts on the body throughout [from, to): its motion is then known in closed form.
    bool constant(std::size_t index, double from, double to) const;
    /// Whether no point force acts on the body at a time: nothing turns it.
    bool torque_free(std::size_t index, double time) const;
    /// How fast drag slows the body down: |dF/dv| / m per m/s of its speed through the air, 1/m.
    double drag_rate(const Body& body) const;
    /// The air's velocity, m/s.
    Vec3 wind() const { return wind_ ? wind_->velocity : Vec3(Vec3::Zero()); }

    /// Whether nothing but gravity ever acts on the body; on any body, forces at points come and go.
    bool only_gravity(std::size_t index) const { return !wind_ && at_points_[index].empty(); }
    bool ever_changes() const { return changes_; }

private:
    Vec3 gravity_;
    std::optional<WindDescription> wind_;
    std::vector<std::vector<ForceDescription>> at_points_;   // by body
    bool changes_ = false;
};

}  // namespace tumble
