#include "render/scene/drawable_bounds.h"

#include "core/vector.h"
#include "render/scene/cord_ends.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

DrawableBounds bounds_of_body(const RenderBody& proxy, const BodyState& state, const Camera& view) {
    DrawableBounds bounds;
    if (!proxy.solid()) return bounds;
    const BoundingBall ball = bounding_ball(proxy, state, view);
    bounds.center = ball.center;
    bounds.radius = ball.radius;
    bounds.half_axes = state.orientation.toRotationMatrix() * proxy.half_extent.asDiagonal();
    return bounds;
}

DrawableBounds bounds_of_cord(const CordDescription& cord, const Snapshot& snapshot, const Camera& view) {
    const CordEnds ends = cord_ends(cord, snapshot);
    const Vec3 from = view.relative(ends.anchor), to = view.relative(ends.point);
    DrawableBounds bounds;
    bounds.center = 0.5 * (from + to);
    bounds.radius = 0.5 * (to - from).norm() + 2.0 * cord.radius;
    const Quat turn = rotation_between(Vec3::UnitY(), to - from);
    bounds.half_axes = turn.toRotationMatrix() * Vec3(cord.radius, bounds.radius, cord.radius).asDiagonal();
    return bounds;
}

}  // namespace

std::array<Vec3, 8> DrawableBounds::corners() const {
    std::array<Vec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        corners[i] = center;
        for (int k = 0; k < 3; ++k)
            if ((i >> k & 1) != 0)
                corners[i] += half_axes.col(k);
            else
                corners[i] -= half_axes.col(k);
    }
    return corners;
}

std::array<Vec3, 4> DrawableBounds::face(int index) const {
    const int axis = index / 2, a = (axis + 1) % 3, b = (axis + 2) % 3;
    const Vec3 middle = center + (index % 2 == 0 ? -1.0 : 1.0) * half_axes.col(axis);
    std::array<Vec3, 4> points;
    for (std::size_t i = 0; i < 4; ++i)
        points[i] =
            middle + half_axes.col(a) * ((i & 1) != 0 ? 1.0 : -1.0) + half_axes.col(b) * ((i & 2) != 0 ? 1.0 : -1.0);
    return points;
}

std::array<Vec3, 8> box_corners(const Vec3& center, const Mat3& axes, const Vec3& half_size) {
    std::array<Vec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 sides((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0);
        corners[i] = center + axes * half_size.cwiseProduct(sides);
    }
    return corners;
}

PerDrawable<DrawableBounds> make_drawables(const RenderScene& scene, const Snapshot& snapshot, const Camera& view) {
    PerDrawable<DrawableBounds> drawables;
    drawables.bodies.reserve(scene.bodies.size());
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        drawables.bodies.push_back(
            snapshot.bodies[i].absent ? DrawableBounds{} : bounds_of_body(scene.bodies[i], snapshot.bodies[i], view));
    for (const CordDescription& cord : scene.cords) drawables.cords.push_back(bounds_of_cord(cord, snapshot, view));
    return drawables;
}

namespace {

// Smallest near distance over the reference distance: depth has 24 bits between it and infinity.
constexpr double nearest_part = 1e-4;

}  // namespace

// The bounding ball of a large receiver often contains the eye. The visible part of its bounding box is no nearer than
// the nearest point of the box; along the view axis this is less by the cosine at a corner of the image.
double least_depth(const RenderBody& proxy, const BodyState& state, const BoundingBall& ball, const Camera& view) {
    const double depth = ball.center.dot(view.forward()) - ball.radius;
    if (!proxy.large_receiver) return depth;
    const Vec3 eye = state.orientation.conjugate() * -ball.center;
    const double gap = (eye.cwiseAbs() - proxy.half_extent).cwiseMax(0.0).norm();
    double longest = 1.0;  // of rays whose component along the axis is 1
    for (const double x : {0.0, double(view.width())})
        for (const double y : {0.0, double(view.height())}) longest = std::max(longest, view.ray(x, y).norm());
    return std::max(depth, gap / longest);
}

double near_distance_for(const RenderScene& scene, const Snapshot& snapshot, const Camera& view) {
    double nearest = view.target_distance();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!scene.bodies[i].solid() || snapshot.bodies[i].absent) continue;
        const BoundingBall ball = bounding_ball(scene.bodies[i], snapshot.bodies[i], view);
        if (view.sees(ball.center, ball.radius))
            nearest = std::min(nearest, least_depth(scene.bodies[i], snapshot.bodies[i], ball, view));
    }
    nearest = std::max(nearest, nearest_part * view.target_distance());
    return std::exp2(std::floor(std::log2(0.5 * nearest)));
}

}  // namespace tumble
