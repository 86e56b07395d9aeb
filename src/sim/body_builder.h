// From a body's description to a body at rest in the simulation: its mass, inertia tensor and collision shape.
#pragma once

#include "scene/description.h"
#include "sim/body.h"

#include <map>
#include <memory>

namespace tumble {

/// Builds bodies, making the hull, surface and mass integrals of a shared mesh once.
class BodyBuilder {
public:
    /// `integrator` is the simulation's, for bodies that name none of their own.
    Body build(const BodyDescription& description, IntegratorKind integrator);

private:
    struct Mesh {
        std::shared_ptr<const Polyhedron> hull;
        std::shared_ptr<const TriangleSurface> surface;
    };
    Collider mesh_collider(const MeshAsset& asset, bool as_surface, const Vec3& origin);

    // Looked up only, never iterated: the order of addresses decides nothing.
    std::map<const MeshAsset*, Mesh> meshes_;
};

}  // namespace tumble
