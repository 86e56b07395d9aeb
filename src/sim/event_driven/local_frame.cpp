#include "sim/event_driven/local_frame.h"

#include "sim/detection/spatial_sort.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

namespace tumble {
namespace {

// Coordinate along a direction in which no two places of a grid coincide.
double along(const Vec3& v) { return v.x() + std::sqrt(2.0) * v.y() + std::sqrt(3.0) * v.z(); }

// Sort key: the place first; then, for bodies at the same place, as planes often are, all other distinguishing values.
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

std::vector<std::uint32_t> put_in_order_of_place(std::vector<Body>& bodies) {
    std::vector<std::pair<Key, std::uint32_t>> places;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) places.push_back({key_of(bodies[i]), i});
    std::sort(places.begin(), places.end());
    std::vector<std::uint32_t> order;
    std::vector<Body> ordered;
    ordered.reserve(bodies.size());
    for (const auto& place : places) {
        order.push_back(place.second);
        ordered.push_back(std::move(bodies[place.second]));
    }
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
    const std::vector<std::uint32_t> by_place = put_in_order_of_place(bodies);
    std::vector<std::uint32_t> order = put_in_memory_order(bodies, gravity);
    for (std::uint32_t& body : order) body = by_place[body];
    return order;
}

}  // namespace tumble
