#include "render/scene/drawable_bounds.h"
#include "core/rotation.h"

namespace tumble {
namespace {

DrawableBounds body_item(const RenderBody& proxy, const RenderScene& scene, const BodyState& state,
                         const Camera& view) {
    DrawableBounds item;
    if (proxy.kind == DrawKind::hidden || proxy.kind == DrawKind::plane) return item;
    const BoundingBall ball = bounding_ball(proxy, state, view);
    item.center = ball.center;
    item.radius = ball.radius;
    const Vec3 half_size = proxy.kind == DrawKind::mesh ? scene.meshes[proxy.mesh].half_extent : proxy.half_size;
    item.half_axes = state.orientation.toRotationMatrix() * half_size.asDiagonal();
    return item;
}

DrawableBounds cord_item(const CordDescription& cord, const BodyState& state, const Camera& view) {
    const Vec3 from = view.relative(cord.anchor);
    const Vec3 to = view.relative(state.origin + state.orientation * cord.point);
    DrawableBounds item;
    item.center = 0.5 * (from + to);
    item.radius = 0.5 * (to - from).norm() + 2.0 * cord.radius;
    const Quat turn = turn_between(Vec3::UnitY(), to - from);
    item.half_axes = turn.toRotationMatrix() * Vec3(cord.radius, item.radius, cord.radius).asDiagonal();
    return item;
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

std::vector<DrawableBounds> make_drawn_items(const SceneDescription& description, const RenderScene& scene,
                                             const Snapshot& snapshot, const Camera& view) {
    std::vector<DrawableBounds> items;
    items.reserve(scene.bodies.size() + description.cords.size());
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        items.push_back(body_item(scene.bodies[i], scene, snapshot.bodies[i], view));
    for (const CordDescription& cord : description.cords)
        items.push_back(cord_item(cord, snapshot.bodies[cord.body], view));
    return items;
}

}  // namespace tumble
