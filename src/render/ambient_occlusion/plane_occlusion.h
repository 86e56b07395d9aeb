// Occlusion of planes by bodies: the plane tiles of the AO atlas. Every occluder near a plane darkens the texels around
// its footprint. Factors multiply, apart from fixed surfaces between both (overhang_heights.h). Only the blocks of
// texels near an occluder that moved, at both poses, are recomputed.
#pragma once

#include "render/ambient_occlusion/atlas_layout.h"
#include "render/ambient_occlusion/occluders.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/ambient_occlusion/overhang_heights.h"
#include "render/ambient_occlusion/texel_grid.h"

#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace tumble {

/// A plane with the camera on its outer side.
struct PlaneInView {
    std::size_t body;
    Eigen::Vector3f normal;
    float height;  // of the reference point of positions above the plane, m
    friend bool operator==(const PlaneInView&, const PlaneInView&) = default;
};

/// The occluders of a frame, with all positions relative to `reference`.
struct FrameOccluders {
    const FrameContext& frame;
    Vec3 reference;  // m
    const std::vector<Occluder>& all;
    const std::vector<Occluder>& moved;  // bodies that moved since the previous frame, at both poses
    bool anew;                           // any may have moved
};

class PlaneOcclusion {
public:
    /// Updates a plane's tile and returns it; nothing if no body is near the plane or there is no room. `known`: its
    /// last tile, if the plane has not moved. `store` takes visibilities of the texels from (x, y) on, with rows
    /// `stride` apart.
    using Store = std::function<void(int x, int y, int width, int height, int stride, const float* open)>;
    std::optional<PlaneOcclusionTile> update(const PlaneInView& plane, const FrameOccluders& occluders,
                                             const PlaneOcclusionTile* known, ShelfPacker& shelves, const Store& store);

private:
    struct Foot {
        const Occluder* occluder;
        double a, b, radius;  // m, on the plane's axes
        double height;        // m, above the plane
    };
    struct Texels {
        int i0, i1, j0, j1;  // texels of the tile, both ends included
        bool empty() const { return i0 > i1 || j0 > j1; }
    };
    static Texels touched(const Foot& foot, const PlaneOcclusionTile& tile);
    bool place(PlaneOcclusionTile& tile, ShelfPacker& shelves) const;

    std::map<std::size_t, OverhangHeights> overhangs_;  // by plane
    std::vector<Foot> feet_;
    std::vector<float> open_;
    std::vector<char> dirty_;  // blocks
    TexelGrid around_foot_;
};

}  // namespace tumble
