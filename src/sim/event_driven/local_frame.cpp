#include "sim/event_driven/local_frame.h"

#include "sim/detection/spatial_sort.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

namespace tumble {
namespace {

// Differences below this share of the scene's size are rounding of its position and direction. Not fitted.
constexpr double same_place = 1e-9;

// Coordinate along a direction in which no two positions of a grid coincide.
double along(const Vec3& v) { return v.x() + std::sqrt(2.0) * v.y() + std::sqrt(3.0) * v.z(); }

// Sort key of bodies that are alike otherwise: the position first; then, for bodies at the same position, as planes
// often are, all other distinguishing values.
using Key = std::array<double, 12>;
Key key_of(const Body& body) {
    const auto* space = std::get_if<HalfSpace>(&body.collider);
    const Vec3 axis = space ? space->normal : Vec3(1.0, 1.0, 1.0);
    return {along(body.position),
            double(body.type),
            double(body.collider.index()),
            along(body.rotation * axis),
            space ? space->offset : body.radius,
            body.mass,
            body.restitution,
            body.friction,
            along(body.velocity),
            along(body.angular_velocity),
            along(body.principal_inertia),
            double(body.integrator)};
}

// A value on a fine grid, off common values such as 0 and 1.
double on_grid(double value, double grid) {
    return grid > 0.0 && std::isfinite(value) ? std::floor(value / grid + 0.387) : value;
}

// Sorts by values that do not depend on the world's axes, as far as rounding allows: height, distance from the middle
// of the moving bodies, size. A scene that is turned together with its gravity, or mirrored, so has the same order.
void sort_by_shape_of_scene(const std::vector<Body>& bodies, const Vec3& gravity, std::vector<std::uint32_t>& order) {
    Vec3 middle = Vec3::Zero();
    double count = 0.0, size = 0.0;
    for (const std::uint32_t i : order) {
        if (!bodies[i].dynamic()) continue;
        middle += bodies[i].position;
        count += 1.0;
    }
    if (count > 0.0) middle /= count;
    for (const Body& body : bodies)
        if (body.dynamic()) size = std::max(size, (body.position - middle).norm() + body.radius);
    const double grid = same_place * size, strength = gravity.norm();
    std::vector<std::array<double, 3>> keys;
    for (const Body& body : bodies) {
        const Vec3 from = body.position - middle;
        const double height = strength > 0.0 ? from.dot(gravity) / strength : 0.0;
        keys.push_back({on_grid(height, grid), on_grid(from.norm(), grid), on_grid(body.radius, grid)});
    }
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t l, std::uint32_t r) { return keys[l] < keys[r]; });
}

std::vector<std::uint32_t> put_in_order_of_place(std::vector<Body>& bodies, const Vec3& gravity) {
    std::vector<std::pair<Key, std::uint32_t>> places;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) places.push_back({key_of(bodies[i]), i});
    std::sort(places.begin(), places.end());
    std::vector<std::uint32_t> order;
    for (const auto& place : places) order.push_back(place.second);
    sort_by_shape_of_scene(bodies, gravity, order);
    std::vector<Body> ordered;
    ordered.reserve(bodies.size());
    for (const std::uint32_t i : order) ordered.push_back(std::move(bodies[i]));
    bodies = std::move(ordered);
    return order;
}

}  // namespace

Vec3 local_origin(const SceneDescription& scene) {
    Bounds places;
    bool any = false;
    for (const BodyDescription& body : scene.bodies) {
        if (body.type != BodyType::dynamic) continue;
        places.add(body.position);
        any = true;
    }
    return any ? places.center() : Vec3(Vec3::Zero());
}

SceneDescription seen_from(const SceneDescription& scene, const Vec3& origin) {
    SceneDescription local = scene;
    for (BodyDescription& body : local.bodies) {
        body.position -= origin;
        for (Keyframe& keyframe : body.keyframes) keyframe.position -= origin;
    }
    return local;
}

std::vector<std::uint32_t> put_in_exact_order(std::vector<Body>& bodies, const Vec3& gravity) {
    const std::vector<std::uint32_t> by_place = put_in_order_of_place(bodies, gravity);
    std::vector<std::uint32_t> order = put_in_memory_order(bodies, gravity);
    for (std::uint32_t& body : order) body = by_place[body];
    return order;
}

}  // namespace tumble
