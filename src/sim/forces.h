// External forces and torques on a body (notes section 3): gravity, wind, and forces at points.
#pragma once

#include "scene/description.h"
#include "sim/body.h"

#include <vector>

namespace tumble {

struct Wrench {
    Vec3 force = Vec3::Zero();    // N
    Vec3 torque = Vec3::Zero();   // N m, about the centre of mass
};

class ForceField {
public:
    explicit ForceField(const SceneDescription& scene);

    /// The sum of all that acts on the body at time t (s), for its present state.
    Wrench at(std::size_t index, const Body& body, double time) const;

    /// Whether a point force on the body begins or ends within [from, to): such a body must be awake.
    bool changes(std::size_t index, double from, double to) const;

private:
    Vec3 gravity_;
    std::optional<WindDescription> wind_;
    std::vector<std::vector<ForceDescription>> at_points_;   // by body
};

}  // namespace tumble
