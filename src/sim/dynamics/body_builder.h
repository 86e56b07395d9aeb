// Builds bodies at rest from their descriptions: mass, inertia tensor and collision shape.
#pragma once

#include "scene/description/description.h"
#include "sim/dynamics/body.h"
#include "sim/geometry/shapes/shape.h"

#include <vector>

namespace tumble {

/// Builds bodies. Equal boxes share one collider, and so do bodies of the same mesh or compound.
class BodyBuilder {
public:
    /// `rules`: of the scene.
    explicit BodyBuilder(PairRules rules = {}) : rules_(rules) {}
    /// `integrator` is the simulation's, for bodies without their own.
    Body build(const BodyDescription& description, IntegratorKind integrator);

private:
    CollisionShape collider(const BodyDescription& description, const Vec3& center_of_mass);

    PairRules rules_;
    ColliderCache made_;
};

/// Mass and collision shape, which has its origin in the center of mass, and the quantities that follow from them. A
/// body that is not dynamic has no mass.
void give_mass(Body& body, const MassProperties& mass, CollisionShape collider);

/// All bodies of a scene, in the scene's order.
std::vector<Body> build_bodies(const SceneDescription& scene);

}  // namespace tumble
