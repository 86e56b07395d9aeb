#include "harness/shapes.h"

namespace tumble::bench {

Body box(const Vector& size, double mass, const Vector& position) {
    Body body;
    body.kind = Kind::box;
    body.size = size;
    body.mass = mass;
    body.position = position;
    return body;
}

Body sphere(double radius, double mass, const Vector& position) {
    Body body;
    body.kind = Kind::sphere;
    body.radius = radius;
    body.mass = mass;
    body.position = position;
    return body;
}

Body plane(const Vector& normal, double offset) {
    Body body;
    body.kind = Kind::plane;
    body.normal = normal;
    body.offset = offset;
    return body;
}

Body fixed_box(const Vector& size, const Vector& position) {
    Body body = box(size, 1.0, position);
    body.fixed = true;
    return body;
}

Body floor_box(double side) { return fixed_box({side, side, 2.0}, {0.0, 0.0, -1.0}); }

void add_pit(Scene& scene, double half_width, double height) {
    const double w = half_width;
    scene.bodies.push_back(floor_box(2.0 * w + 4.0));
    for (const double side : {-1.0, 1.0}) {
        scene.bodies.push_back(fixed_box({2.0, 2.0 * w + 4.0, height}, {side * (w + 1.0), 0.0, 0.5 * height}));
        scene.bodies.push_back(fixed_box({2.0 * w, 2.0, height}, {0.0, side * (w + 1.0), 0.5 * height}));
    }
}

void set_materials(Scene& scene, double friction, double restitution) {
    for (Body& body : scene.bodies) {
        body.friction = friction;
        body.restitution = restitution;
    }
}

}  // namespace tumble::bench
