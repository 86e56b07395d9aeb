#include "render/ambient_occlusion/lightmap_occlusion.h"

#include <algorithm>
#include <limits>

namespace tumble {

void LightmapOcclusion::place(const LightmapBody& body) {
    if (body_.surface == body.surface && body_.origin == body.origin && body_.axes == body.axes) return;
    body_ = body;
    all_.clear();
    const OcclusionLightmap& surface = *body.surface;
    const Eigen::Matrix3f axes = body.axes.cast<float>();
    const auto vector = [](const std::array<float, 3>& v) { return Eigen::Vector3f(v[0], v[1], v[2]); };
    for (std::size_t i = 0; i < surface.positions.size(); ++i)
        all_.add(Vec3(body.origin + body.axes * vector(surface.positions[i]).cast<double>()).cast<float>(),
                 axes * vector(surface.normals[i]));
    touched_.resize(surface.blocks.size(), 0);
}

LightmapOcclusion::Ball LightmapOcclusion::ball_around(const Bounds& bounds) const {
    return {Vec3(body_.origin + body_.axes * bounds.center()).cast<float>(), float(0.5 * bounds.extent().norm())};
}

bool LightmapOcclusion::occluded_by_plane(const Ball& ball, const std::vector<PlaneInView>& planes) const {
    return std::any_of(planes.begin(), planes.end(), [&](const PlaneInView& plane) {
        return plane.normal.dot(ball.center) + plane.height < ball.radius + 2.0f * float(body_.ao_radius);
    });
}

// Texels without an occluder nearby, in this update and the last, keep their initial value of 1.
void LightmapOcclusion::update(const std::vector<Occluder>& occluders, const OccluderFinder& near,
                               const OccluderFinder* moved, const std::vector<PlaneInView>& planes,
                               const Store& store) {
    const OcclusionLightmap& surface = *body_.surface;
    for (const OcclusionLightmap::Group& group : surface.groups) {
        const Ball whole = ball_around(group.bounds);
        if (moved != nullptr && !moved->any(whole.center, whole.radius)) continue;
        const bool alone = !near.any(whole.center, whole.radius) && !occluded_by_plane(whole, planes);
        for (std::uint32_t i = group.first; i < group.end; ++i) {
            if (alone && touched_[i] == 0) continue;
            const OcclusionLightmap::Block& block = surface.blocks[i];
            const Ball ball = ball_around(block.bounds);
            if (moved != nullptr && !moved->any(ball.center, ball.radius)) continue;
            near.find(ball.center, ball.radius, found_);
            // a body does not occlude itself
            std::erase_if(found_, [&](std::size_t o) { return occluders[o].body == body_.body; });
            const bool by_planes = occluded_by_plane(ball, planes);
            if (found_.empty() && !by_planes && touched_[i] == 0) continue;
            touched_[i] = !found_.empty() || by_planes ? 1 : 0;
            points_.clear();
            for (int y = block.y; y < block.y + block.height; ++y)
                points_.add(all_, std::size_t(y) * std::size_t(surface.width) + std::size_t(block.x),
                            std::size_t(block.width));
            for (const std::size_t o : found_) occlude(points_, occluders[o], std::numeric_limits<float>::infinity());
            for (const PlaneInView& plane : planes)
                occlude(points_, plane.normal, plane.height, float(body_.ao_radius));
            store(block, points_.open.data());
        }
    }
}

}  // namespace tumble
