// Large receivers: large bodies that the others stand on or between, such as a floor, a field or the walls of a room.
// Quantities that are fitted to the size or place of the bodies (the near shadow map, the sampling of AO) are fitted to
// the others.
#pragma once

#include "render/scene/render_scene.h"

namespace tumble {

/// Sets RenderBody::ground of bodies that are much larger than all smaller bodies together, at the initial poses.
void find_large_receivers(const SceneDescription& description, RenderScene& scene);

/// Fall height of a point above the nearest plane or large receiver below it, at the initial poses, m; 0 without one.
/// `down`: unit.
class RestHeightEstimate {
public:
    RestHeightEstimate(const SceneDescription& description, const RenderScene& scene);
    double fall(const Vec3& point, const Vec3& down) const;

private:
    struct Block {
        Vec3 center, half_size;  // m
        Quat rotation;
        bool hollow;  // a mesh: a body may come to rest as low as the lower side of its bounds
    };
    std::vector<PlaneShape> planes_;
    std::vector<Block> blocks_;
};

}  // namespace tumble
