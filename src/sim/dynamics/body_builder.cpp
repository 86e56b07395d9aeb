#include "sim/dynamics/body_builder.h"

#include "core/deterministic_math.h"
#include "core/error.h"
#include "sim/math/mass_properties.h"

#include <fmt/format.h>

#include <vector>

namespace tumble {
namespace {

// Mean projected area of a convex body over all directions: a quarter of its surface (Cauchy 1832).
double mean_projected_area(const CollisionShape& collider) {
    if (const auto* ball = std::get_if<Ball>(&collider)) return pi * ball->radius * ball->radius;
    if (const auto* hull = std::get_if<std::shared_ptr<const Polyhedron>>(&collider))
        return 0.25 * (*hull)->surface_area();
    double sum = 0.0;  // of a compound: as if no part sheltered another from the wind
    if (const auto* compound = std::get_if<std::shared_ptr<const Compound>>(&collider))
        for (const Compound::Part& part : (*compound)->parts) sum += mean_projected_area(part.collider);
    return sum;
}

MassProperties mass_of_shape(const Shape& shape, double density) {
    if (const auto* box = std::get_if<BoxShape>(&shape)) return box_mass(box->size, density);
    if (const auto* sphere = std::get_if<SphereShape>(&shape)) return sphere_mass(sphere->radius, density);
    if (const auto* mesh = std::get_if<MeshShape>(&shape))
        return closedness(mesh->asset->mesh).closed() ? mesh_mass(mesh->asset->mesh, density) : MassProperties{};
    std::vector<MassProperties> parts;
    if (const auto* compound = std::get_if<CompoundShape>(&shape))
        for (const CompoundPart& part : *compound->parts)
            parts.push_back(
                placed(mass_of_shape(part.shape, part.density.value_or(density)), part.position, part.rotation));
    return sum_of_masses(parts);
}

MassProperties mass_of(const BodyDescription& d) {
    const MassProperties p = mass_of_shape(d.shape, d.density);
    return d.mass && p.mass > 0.0 ? with_mass(p, *d.mass) : p;
}

void set_motion(Body& body, const BodyDescription& d) {
    body.orientation = d.rotation;
    body.rotation = d.rotation.toRotationMatrix();
    body.position = d.position + body.rotation * body.center_of_mass;
    if (body.dynamic()) {
        body.momentum = body.mass * d.velocity;
        body.angular_momentum = body.rotation * (body.inertia_body * (body.rotation.transpose() * d.angular_velocity));
        body.derive();
    } else if (body.type == BodyType::kinematic && !d.keyframes.empty()) {
        body.track = std::make_shared<KeyframeTrack>(d.keyframes, d.interpolation);
    }
}

}  // namespace

CollisionShape BodyBuilder::mesh_collider(const MeshAsset& asset, bool as_triangles, const Vec3& origin) {
    Mesh& made = meshes_[&asset];
    try {
        if (as_triangles) {
            if (!made.surface) made.surface = std::make_shared<CollisionMesh>(make_collision_mesh(asset.mesh, origin));
            return made.surface;
        }
        if (!made.hull) made.hull = std::make_shared<Polyhedron>(make_hull(asset.mesh.vertices, origin));
        return made.hull;
    } catch (const InputError& error) {
        const std::string what = error.what();
        throw InputError(SourceLocation{asset.file, 0, 0}, what.substr(what.find("error: ") + 7));
    }
}

CollisionShape BodyBuilder::collider(const Shape& shape, bool meshes_as_triangles, const Vec3& origin) {
    if (const auto* plane = std::get_if<PlaneShape>(&shape)) return HalfSpace{plane->normal, plane->offset};
    if (const auto* sphere = std::get_if<SphereShape>(&shape)) return Ball{sphere->radius};
    if (const auto* box = std::get_if<BoxShape>(&shape)) {
        auto& made = boxes_[{box->size.x(), box->size.y(), box->size.z()}];
        if (!made) made = std::make_shared<const Polyhedron>(make_box(box->size));
        return made;
    }
    return mesh_collider(*std::get<MeshShape>(shape).asset, meshes_as_triangles, origin);
}

CollisionShape BodyBuilder::compound_collider(const CompoundShape& shape, double density, const Vec3& origin) {
    KnownCompound& known = compounds_[shape.parts.get()];
    if (known.made && known.origin == origin) return known.made;  // another density may move the center of mass
    auto compound = std::make_shared<Compound>();
    for (const CompoundPart& part : *shape.parts) {
        const Vec3 middle = mass_of_shape(part.shape, density).center_of_mass;  // origin of the collider
        compound->parts.push_back(
            {collider(part.shape, false, middle),
             {part.position + part.rotation * middle - origin, part.rotation.toRotationMatrix()}});
    }
    compound->complete();
    known = {origin, std::move(compound)};
    return known.made;
}

Body BodyBuilder::build(const BodyDescription& d, IntegratorKind integrator) {
    Body body;
    body.name = d.name;
    body.type = d.type;
    body.restitution = d.restitution_in_pair();
    body.friction = d.friction_in_pair();
    body.pair_rules = rules_;
    body.integrator = d.integrator.value_or(integrator);
    const MassProperties mass = mass_of(d);
    body.center_of_mass = mass.center_of_mass;
    if (const auto* compound = std::get_if<CompoundShape>(&d.shape))
        body.collider = compound_collider(*compound, d.density, mass.center_of_mass);
    else
        body.collider = collider(d.shape, d.type == BodyType::fixed, mass.center_of_mass);
    body.radius = bounding_radius(body.collider);
    if (d.type == BodyType::dynamic) {
        body.mass = mass.mass;
        body.inverse_mass = 1.0 / mass.mass;
        body.inertia_body = mass.inertia;
        body.inverse_inertia_body = mass.inertia.inverse();
        body.spherical_top = mass.inertia == Mat3(mass.inertia(0, 0) * Mat3::Identity());
        const PrincipalInertia principal = principal_inertia(mass.inertia);
        body.principal_inertia = principal.moments;
        body.principal_axes = principal.axes;
        body.drag_area = mean_projected_area(body.collider);
    }
    set_motion(body, d);
    return body;
}

std::vector<Body> build_bodies(const SceneDescription& scene) {
    BodyBuilder builder(scene.contact);
    std::vector<Body> bodies;
    bodies.reserve(scene.bodies.size());
    for (const BodyDescription& d : scene.bodies) bodies.push_back(builder.build(d, scene.simulation.integrator));
    return bodies;
}

}  // namespace tumble
