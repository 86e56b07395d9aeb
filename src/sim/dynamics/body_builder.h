// Builds bodies at rest from their descriptions: mass, inertia tensor and collision shape.
#pragma once

#include "scene/description/description.h"
#include "sim/dynamics/body.h"
#include "sim/geometry/compound.h"

#include <array>
#include <map>
#include <memory>

namespace tumble {

/// Builds bodies. Equal boxes share one collider, and so do bodies of the same mesh or compound.
class BodyBuilder {
public:
    /// `rules`: of the scene.
    explicit BodyBuilder(PairRules rules = {}) : rules_(rules) {}
    /// `integrator` is the simulation's, for bodies without their own.
    Body build(const BodyDescription& description, IntegratorKind integrator);

private:
    struct Mesh {
        std::shared_ptr<const Polyhedron> hull;
        std::shared_ptr<const CollisionMesh> surface;
    };
    CollisionShape mesh_collider(const MeshAsset& asset, bool as_triangles, const Vec3& origin);
    CollisionShape collider(const Shape& shape, bool meshes_as_triangles, const Vec3& origin);
    CollisionShape compound_collider(const CompoundShape& shape, double density, const Vec3& origin);

    PairRules rules_;
    std::map<std::array<double, 3>, std::shared_ptr<const Polyhedron>>
        boxes_;  // by edge lengths: each shape takes 2 KB
    // Looked up only, never iterated: the order of addresses must not affect results.
    std::map<const MeshAsset*, Mesh> meshes_;
    struct KnownCompound {
        Vec3 origin = Vec3::Zero();
        std::shared_ptr<const Compound> made;
    };
    std::map<const void*, KnownCompound> compounds_;
};

/// All bodies of a scene, in the scene's order.
std::vector<Body> build_bodies(const SceneDescription& scene);

}  // namespace tumble
