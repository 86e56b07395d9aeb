#include "sim/dynamics/body_builder.h"

#include <map>
#include <string>
#include <utility>
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

// Bits of the layers of a scene in the order of their names. The lowest one is for bodies without a layer.
class Layers {
public:
    explicit Layers(const SceneDescription& scene) {
        std::uint64_t next = 2;
        for (const BodyDescription& body : scene.bodies)
            for (const std::string& name : body.layers) bits_.try_emplace(name, 0);
        for (auto& [name, bit] : bits_) bit = std::exchange(next, next << 1);
        all_ = next - 1;
    }

    void set(const BodyDescription& d, Body& body) const {
        body.layers = d.layers.empty() ? 1 : bits_of(d.layers);
        body.collides_with = d.collide_with ? bits_of(*d.collide_with) : all_;
    }

private:
    std::uint64_t bits_of(const std::vector<std::string>& names) const {
        std::uint64_t bits = 0;
        for (const std::string& name : names)
            if (const auto found = bits_.find(name); found != bits_.end()) bits |= found->second;
        return bits;
    }

    std::map<std::string, std::uint64_t> bits_;
    std::uint64_t all_ = 0;
};

}  // namespace

// A given center of mass may lie elsewhere than that of the shape, where its collision shape has its origin.
CollisionShape BodyBuilder::collider(const BodyDescription& d, const Vec3& center_of_mass) {
    const ColliderRequest request{d.type == BodyType::fixed, center_of_mass, d.density};
    if (!d.center_of_mass || std::holds_alternative<CompoundShape>(d.shape))
        return make_collider(d.shape, request, made_);
    const Vec3 middle = mass_properties(d.shape, d.density).center_of_mass;
    if (middle == center_of_mass) return make_collider(d.shape, request, made_);
    auto shifted = std::make_shared<Compound>();
    shifted->parts.push_back(
        {make_collider(d.shape, {false, middle, d.density}, made_), {middle - center_of_mass, Mat3::Identity()}});
    shifted->complete();
    return shifted;
}

void give_mass(Body& body, const MassProperties& mass, CollisionShape collider) {
    body.center_of_mass = mass.center_of_mass;
    body.collider = std::move(collider);
    body.radius = bounding_radius(body.collider);
    if (!body.dynamic()) return;
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

Body BodyBuilder::build(const BodyDescription& d, IntegratorKind integrator) {
    Body body;
    body.name = d.name;
    body.type = d.type;
    body.restitution = d.restitution_in_pair();
    body.friction = d.friction_in_pair();
    body.pair_rules = rules_;
    body.rolling_friction = d.rolling_friction_in_pair();
    body.spinning_friction = d.spinning_friction_in_pair();
    body.gravity_scale = d.gravity_scale;
    body.integrator = d.integrator.value_or(integrator);
    const MassProperties mass = mass_properties(d);
    give_mass(body, mass, collider(d, mass.center_of_mass));
    set_motion(body, d);
    return body;
}

std::vector<Body> build_bodies(const SceneDescription& scene) {
    BodyBuilder builder(scene.contact);
    const Layers layers(scene);
    std::vector<Body> bodies;
    bodies.reserve(scene.bodies.size());
    for (const BodyDescription& d : scene.bodies) {
        bodies.push_back(builder.build(d, scene.simulation.integrator));
        layers.set(d, bodies.back());
    }
    return bodies;
}

}  // namespace tumble
