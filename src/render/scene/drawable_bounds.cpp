#include "render/scene/drawable_bounds.h"
#include "core/rotation.h"

namespace tumble {
namespace {

DrawableBounds bounds_of_body(const RenderBody& proxy, const RenderScene& scene, const BodyState& state,
                              const Camera& view) {
    DrawableBounds bounds;
    if (proxy.kind == DrawKind::hidden || proxy.kind == DrawKind::plane) return bounds;
    const BoundingBall ball = bounding_ball(proxy, state, view);
    bounds.center = ball.center;
    bounds.radius = ball.radius;
    const Vec3 half_size = proxy.kind == DrawKind::mesh ? scene.meshes[proxy.mesh].half_extent : proxy.half_size;
    bounds.half_axes = state.orientation.toRotationMatrix() * half_size.asDiagonal();
    return bounds;
}

DrawableBounds bounds_of_cord(const CordDescription& cord, const BodyState& state, const Camera& view) {
    const Vec3 from = view.relative(cord.anchor);
    const Vec3 to = view.relative(state.origin + state.orientation * cord.point);
    DrawableBounds bounds;
    bounds.center = 0.5 * (from + to);
    bounds.radius = 0.5 * (to - from).norm() + 2.0 * cord.radius;
    const Quat turn = turn_between(Vec3::UnitY(), to - from);
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
        drawables.bodies.push_back(bounds_of_body(scene.bodies[i], scene, snapshot.bodies[i], view));
    for (const CordDescription& cord : scene.cords)
        drawables.cords.push_back(bounds_of_cord(cord, snapshot.bodies[cord.body], view));
    return drawables;
}

}  // namespace tumble
