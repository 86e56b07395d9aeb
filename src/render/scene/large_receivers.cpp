#include "render/scene/large_receivers.h"

#include "render/scene/plane_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// A large receiver is this many times as wide as the space that all smaller bodies occupy. A shadow map around it would
// be twice as coarse as one around them.
constexpr double receiver_of_rest = 1.5;

// Lower limit of that space, in half edges of the largest of these bodies: shadows are not needed finer
// (shadow_cascades.cpp).
constexpr double least_rest = 15.0;

// More large bodies than this are the subject of the scene, not receivers.
constexpr std::size_t most_receivers = 32;

struct ReceiverExtent {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    void add(const Vec3& center, double radius) {
        low = low.cwiseMin(center - Vec3::Constant(radius));
        high = high.cwiseMax(center + Vec3::Constant(radius));
    }
    double size() const { return (high - low).maxCoeff(); }
};

bool is_solid(const RenderBody& proxy) { return proxy.solid() && !proxy.buried; }

}  // namespace

void find_large_receivers(const SceneDescription& description, RenderScene& scene) {
    std::vector<std::size_t> by_size;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (is_solid(scene.bodies[i])) by_size.push_back(i);
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) {
        return scene.bodies[a].bound_radius < scene.bodies[b].bound_radius;
    });
    std::vector<std::size_t> receivers;
    ReceiverExtent rest;
    double largest_ao_radius = std::numeric_limits<double>::infinity();  // the smallest body is no receiver
    for (const std::size_t i : by_size) {
        const RenderBody& proxy = scene.bodies[i];
        if (2.0 * proxy.bound_radius > receiver_of_rest * std::max(rest.size(), least_rest * largest_ao_radius)) {
            receivers.push_back(i);
            continue;
        }
        const BodyDescription& body = description.bodies[i];
        rest.add(body.position + body.rotation * proxy.bound_center, proxy.bound_radius);
        for (const Keyframe& key : body.keyframes)
            rest.add(key.position + key.rotation * proxy.bound_center, proxy.bound_radius);
        largest_ao_radius =
            std::isfinite(largest_ao_radius) ? std::max(largest_ao_radius, proxy.ao_radius) : proxy.ao_radius;
    }
    if (receivers.size() <= most_receivers)
        for (const std::size_t i : receivers) scene.bodies[i].large_receiver = true;
}

RestHeightEstimate::RestHeightEstimate(const SceneDescription& description, const RenderScene& scene) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const RenderBody& proxy = scene.bodies[i];
        const BodyDescription& body = description.bodies[i];
        if (proxy.kind == DrawKind::plane) {
            BodyState state;
            state.origin = body.position;
            state.orientation = body.rotation;
            planes_.push_back(plane_in_world(proxy, state));
        } else if (proxy.large_receiver) {
            blocks_.push_back({body.position + body.rotation * proxy.bound_center, proxy.half_extent, body.rotation,
                               proxy.kind == DrawKind::mesh});
        }
    }
}

double RestHeightEstimate::fall(const Vec3& point, const Vec3& down) const {
    double fall = std::numeric_limits<double>::infinity();
    for (const PlaneShape& plane : planes_) {
        const double approach = -plane.normal.dot(down), height = plane.normal.dot(point) - plane.offset;
        if (approach > 1e-6 && height > 0.0) fall = std::min(fall, height / approach);
    }
    for (const Block& block : blocks_) {  // between the planes of its sides, axis by axis
        const Vec3 from = block.rotation.conjugate() * (point - block.center), way = block.rotation.conjugate() * down;
        double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
        for (int k = 0; k < 3; ++k) {
            const double side = way[k] < 0.0 ? -block.half_size[k] : block.half_size[k];  // exit point
            const double speed = std::abs(way[k]) < 1e-12 ? std::copysign(1e-12, way[k]) : way[k];
            enter = std::max(enter, (-side - from[k]) / speed);
            leave = std::min(leave, (side - from[k]) / speed);
        }
        const double lands = block.hollow ? leave : enter;
        if (enter <= leave && lands > 0.0) fall = std::min(fall, lands);
    }
    return std::isfinite(fall) ? fall : 0.0;
}

}  // namespace tumble
