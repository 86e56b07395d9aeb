// Occlusion of the bodies that have a lightmap, updated block by block where an occluder is near or was near at the
// previous update.
#pragma once

#include "render/ambient_occlusion/analytic_occlusion.h"
#include "render/ambient_occlusion/occluders.h"
#include "render/ambient_occlusion/plane_occlusion.h"
#include "render/lightmap/occlusion_lightmap.h"

#include <functional>
#include <vector>

namespace tumble {

/// A body with a lightmap, and its place relative to the same point as occluders.
struct LightmapBody {
    std::size_t body = 0;
    const OcclusionLightmap* surface = nullptr;
    Vec3 origin;  // m
    Mat3 axes;
    double ao_radius = 0.0;  // AO radius of this body, m
};

class LightmapOcclusion {
public:
    /// Sets the place of the body.
    void place(const LightmapBody& body);

    /// Stores visibilities of a block's texels, row after row.
    using Store = std::function<void(const OcclusionLightmap::Block& block, const float* open)>;

    /// Updates all blocks. `moved`: finds the occluders that moved since the previous update, at both poses; null: any
    /// may have moved. `near`: finds all.
    void update(const std::vector<Occluder>& occluders, const OccluderFinder& near, const OccluderFinder* moved,
                const std::vector<PlaneInView>& planes, const Store& store);

private:
    struct Ball {
        Eigen::Vector3f center;
        float radius;
    };
    Ball ball_around(const Bounds& bounds) const;
    bool occluded_by_plane(const Ball& ball, const std::vector<PlaneInView>& planes) const;

    LightmapBody body_{};
    SurfacePoints all_, points_;  // of the whole surface; of a block
    std::vector<char> touched_;   // blocks that have or had an occluder nearby
    std::vector<std::size_t> found_;
};

}  // namespace tumble
