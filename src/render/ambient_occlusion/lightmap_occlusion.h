// How the bodies darken those that have a fine surface: block by block, where one is near or was.
#pragma once

#include "render/lightmap/occlusion_lightmap.h"
#include "render/ambient_occlusion/occluders.h"
#include "render/ambient_occlusion/plane_occlusion.h"
#include "render/ambient_occlusion/analytic_occlusion.h"

#include <functional>
#include <vector>

namespace tumble {

/// A body with a fine surface, and where it is: relative to the same point as occluders.
struct LightmapBody {
    std::size_t body = 0;
    const OcclusionLightmap* surface = nullptr;
    Vec3 origin;   // m
    Mat3 axes;
    double reach = 0.0;  // its own: how far planes darken it, m
};

class LightmapOcclusion {
public:
    /// Where it is now.
    void place(const LightmapBody& body);

    /// Takes shares for a block's texels, row after row.
    using Store = std::function<void(const OcclusionLightmap::Block& block, const float* open)>;

    /// Brings all blocks up to date. `moved`: finds those that moved since the last time, as they were and as they are; null:
    /// any may have. `near`: finds all.
    void update(const std::vector<Occluder>& occluders, const OccluderFinder& near, const OccluderFinder* moved,
                const std::vector<PlaneInView>& planes, const Store& store);

private:
    struct Ball {
        Eigen::Vector3f center;
        float radius;
    };
    Ball ball_around(const Bounds& bounds) const;
    bool reached_by_plane(const Ball& ball, const std::vector<PlaneInView>& planes) const;

    LightmapBody body_{};
    SurfacePoints all_, points_;   // of the whole surface; of a block
    std::vector<char> touched_;    // blocks that something was near to
    std::vector<std::size_t> found_;
};

}  // namespace tumble
