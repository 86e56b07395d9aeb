// Scenes of random bodies of every kind, none of which overlap at the start.
#pragma once

#include "random_shapes.h"
#include "support/scenes.h"

#include <variant>

namespace tumble::testing {

/// A closed mesh: the hull of random points, its faces split into fans. Its origin differs from its center of mass.
inline std::shared_ptr<const MeshAsset> random_mesh(Random& random, int points, double size) {
    std::vector<Vec3> cloud;
    const Vec3 off = random.vector(0.3 * size);
    for (int i = 0; i < points; ++i) cloud.push_back(size * random.direction() * random(0.6, 1.0) + off);
    const Polyhedron hull = make_hull(cloud, Vec3::Zero());
    TriangleMesh mesh;
    mesh.vertices = hull.vertices;
    for (const auto& face : hull.faces)
        for (std::size_t i = 2; i < face.vertices.size(); ++i)
            mesh.triangles.push_back({face.vertices[0], face.vertices[i - 1], face.vertices[i]});
    return asset_of(mesh);
}

struct SceneKind {
    int bodies = 8;
    double speed = 3.0;  // m/s, at most along each axis
    double spin = 5.0;   // rad/s
    double restitution_low = 0.0, restitution_high = 1.0;
    double friction_high = 2.0;
    double heaviest = 20.0;  // kg; the lightest is 1
    int steps_per_frame = 16;
};

/// Bodies of radius up to 0.45 m in cells of 1 m over the ground y = 0 (body 0), with a fixed box or mesh among them.
inline SceneDescription random_scene(Random& random, const SceneKind& kind) {
    SceneDescription scene = ground_scene(random(kind.restitution_low, kind.restitution_high),
                                          random(0.0, kind.friction_high), kind.steps_per_frame);
    for (int i = 0; i < kind.bodies; ++i) {
        const Vec3 at(i % 3 + random(-0.04, 0.04), 0.5 + i / 9 + random(0.0, 0.04), (i / 3) % 3 + random(-0.04, 0.04));
        const double r = random(0.2, 0.45);  // m, bounding radius, so that rotation cannot make them overlap
        BodyDescription* body = nullptr;
        const int shape = random.below(4);
        if (shape == 0)
            body = &add_sphere(scene, r, at);
        else if (shape == 3)
            body = &add_body(scene, MeshShape{random_mesh(random, 6 + random.below(20), 0.75 * r)}, at);
        else {
            const Vec3 size(random(0.2, 1.0), random(0.2, 1.0), random(0.2, 1.0));
            body = &add_box(scene, 2.0 * r / size.norm() * size, at);
        }
        body->mass = random(1.0, kind.heaviest);
        body->rotation = random.turn();
        body->velocity = random.vector(kind.speed);
        body->angular_velocity = random.vector(kind.spin);
        body->restitution = random(kind.restitution_low, kind.restitution_high);
        body->friction = random(0.0, kind.friction_high);
        if (i == 4) {
            body->type = BodyType::fixed;
            body->velocity.setZero();
            body->angular_velocity.setZero();
        }
    }
    return scene;
}

/// Lowest point of a body, m.
inline double lowest_point(const BodyDescription& d, const BodyState& s) {
    if (const auto* sphere = std::get_if<SphereShape>(&d.shape)) return s.origin.y() - sphere->radius;
    std::vector<Vec3> vertices;
    if (const auto* box = std::get_if<BoxShape>(&d.shape))
        vertices = make_box(box->size).vertices;
    else if (const auto* mesh = std::get_if<MeshShape>(&d.shape))
        vertices = mesh->asset->mesh.vertices;
    double y = 1e300;
    for (const Vec3& v : vertices) y = std::min(y, (s.origin + s.orientation * v).y());
    return y;
}

/// J: the bodies' weight times one meter plus their kinetic energy.
inline double energy_scale(const SceneDescription& scene, const World& world) {
    double scale = world.measure().kinetic;
    for (const BodyDescription& d : scene.bodies)
        if (d.type == BodyType::dynamic) scale += *d.mass * scene.simulation.gravity.norm() * 1.0;
    return scale;
}

}  // namespace tumble::testing
