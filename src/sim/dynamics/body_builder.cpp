#include "sim/dynamics/body_builder.h"

#include <vector>

namespace tumble {
namespace {

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

Body BodyBuilder::build(const BodyDescription& d, IntegratorKind integrator) {
    Body body;
    body.name = d.name;
    body.type = d.type;
    body.restitution = d.restitution_in_pair();
    body.friction = d.friction_in_pair();
    body.pair_rules = rules_;
    body.integrator = d.integrator.value_or(integrator);
    const MassProperties mass = mass_properties(d);
    body.center_of_mass = mass.center_of_mass;
    body.collider = make_collider(d.shape, {d.type == BodyType::fixed, mass.center_of_mass, d.density}, made_);
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
