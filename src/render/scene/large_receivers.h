// Large bodies that the others stand on or between: a floor, a field, the walls of a room. Whatever is fitted to the bodies'
// size or place (the near shadow map, how finely darkening is sampled) is fitted to the rest.
#pragma once

#include "render/scene/render_scene.h"

namespace tumble {

/// Sets RenderBody::ground of those that are much larger than all smaller bodies together, as they start.
void find_large_receivers(const SceneDescription& scene, RenderScene& looks);

/// How far a point falls until it meets a plane or a ground, as they start, m; 0 where there is none below. `down`: unit.
class RestHeightEstimate {
public:
    RestHeightEstimate(const SceneDescription& scene, const RenderScene& looks);
    double fall(const Vec3& point, const Vec3& down) const;

private:
    struct Block {
        Vec3 center, half_size;   // m
        Quat rotation;
        bool hollow;              // a mesh: what falls may land as deep as at its lower side
    };
    std::vector<PlaneShape> planes_;
    std::vector<Block> blocks_;
};

}  // namespace tumble
