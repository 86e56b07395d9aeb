#include "sim/body_builder.h"

#include "core/elementary.h"
#include "core/error.h"
#include "sim/mass_properties.h"

#include <fmt/format.h>

namespace tumble {
namespace {

// Mean projected area of a convex body over all directions: a quarter of its surface (Cauchy 1832).
double mean_projected_area(const Collider& collider) {
    if (const auto* ball = std::get_if<Ball>(&collider)) return pi * ball->radius * ball->radius;
    if (const auto* hull = std::get_if<std::shared_ptr<const Polyhedron>>(&collider)) return 0.25 * (*hull)->surface_area();
    return 0.0;
}

MassProperties mass_of(const BodyDescription& d) {
    MassProperties p;
    if (const auto* box = std::get_if<BoxShape>(&d.shape)) p = box_mass(box->size, d.density);
    else if (const auto* sphere = std::get_if<SphereShape>(&d.shape)) p = sphere_mass(sphere->radius, d.density);
    else if (const auto* mesh = std::get_if<MeshShape>(&d.shape)) {
        if (closedness(mesh->asset->surface).closed()) p = mesh_mass(mesh->asset->surface, d.density);
    }
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

Collider BodyBuilder::mesh_collider(const MeshAsset& asset, bool as_surface, const Vec3& origin) {
    Mesh& made = meshes_[&asset];
    try {
        if (as_surface) {
            if (!made.surface) made.surface = std::make_shared<TriangleSurface>(make_surface(asset.surface, origin));
            return made.surface;
        }
        if (!made.hull) made.hull = std::make_shared<Polyhedron>(make_hull(asset.surface.vertices, origin));
        return made.hull;
    } catch (const InputError& error) {
        const std::string what = error.what();
        throw InputError(SourceLocation{asset.file, 0, 0}, what.substr(what.find("error: ") + 7));
    }
}

Body BodyBuilder::build(const BodyDescription& d, IntegratorKind integrator) {
    Body body;
    body.name = d.name;
    body.type = d.type;
    body.restitution = d.restitution;
    body.friction = d.friction;
    body.integrator = d.integrator.value_or(integrator);
    const MassProperties mass = mass_of(d);
    body.center_of_mass = mass.center_of_mass;
    if (const auto* plane = std::get_if<PlaneShape>(&d.shape)) body.collider = HalfSpace{plane->normal, plane->offset};
    else if (const auto* sphere = std::get_if<SphereShape>(&d.shape)) body.collider = Ball{sphere->radius};
    else if (const auto* box = std::get_if<BoxShape>(&d.shape))
        body.collider = std::make_shared<const Polyhedron>(make_box(box->size));
    else if (const auto* mesh = std::get_if<MeshShape>(&d.shape))
        body.collider = mesh_collider(*mesh->asset, d.type == BodyType::fixed, mass.center_of_mass);
    body.radius = bounding_radius(body.collider);
    if (d.type == BodyType::dynamic) {
        body.mass = mass.mass;
        body.inverse_mass = 1.0 / mass.mass;
        body.inertia_body = mass.inertia;
        body.inverse_inertia_body = mass.inertia.inverse();
        const PrincipalInertia principal = principal_inertia(mass.inertia);
        body.principal_inertia = principal.moments;
        body.principal_axes = principal.axes;
        body.drag_area = mean_projected_area(body.collider);
    }
    set_motion(body, d);
    return body;
}

}  // namespace tumble
