#include "render/scene/near_plane.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Smallest near distance over the reference distance: depth has 24 bits between it and infinity.
constexpr double nearest_part = 1e-4;

}  // namespace

// The bounding ball of a large receiver often contains the eye. The visible part of its bounding box is no nearer than
// the nearest point of the box; along the view axis this is less by the cosine at a corner of the image.
double least_depth(const RenderBody& proxy, const RenderScene& scene, const BodyState& state, const BoundingBall& ball,
                   const Camera& view) {
    const double depth = ball.center.dot(view.forward()) - ball.radius;
    if (!proxy.large_receiver) return depth;
    const Vec3 half_size = proxy.kind == DrawKind::mesh ? scene.meshes[proxy.mesh].half_extent : proxy.half_size;
    const Vec3 eye = state.orientation.conjugate() * -ball.center;
    const double gap = (eye.cwiseAbs() - half_size).cwiseMax(0.0).norm();
    double longest = 1.0;  // of rays whose component along the axis is 1
    for (const double x : {0.0, double(view.width())})
        for (const double y : {0.0, double(view.height())}) longest = std::max(longest, view.ray(x, y).norm());
    return std::max(depth, gap / longest);
}

double near_distance_for(const RenderScene& scene, const Snapshot& snapshot, const Camera& view) {
    double nearest = view.target_distance();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (scene.bodies[i].kind == DrawKind::hidden || scene.bodies[i].kind == DrawKind::plane) continue;
        const BoundingBall ball = bounding_ball(scene.bodies[i], snapshot.bodies[i], view);
        if (view.sees(ball.center, ball.radius))
            nearest = std::min(nearest, least_depth(scene.bodies[i], scene, snapshot.bodies[i], ball, view));
    }
    nearest = std::max(nearest, nearest_part * view.target_distance());
    return std::exp2(std::floor(std::log2(0.5 * nearest)));
}

}  // namespace tumble
