// The windows of the occlusion atlas: how the bodies darken the planes near them. Every occluder near a plane darkens the
// texels around its foot; they multiply, but for what a fixed body stands under (plane_roof.h). Only the blocks of texels that a moved occluder touches, or touched, are worked
// out anew.
#pragma once

#include "render/ambient_occlusion/shelf_packer.h"
#include "render/ambient_occlusion/occluders.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/ambient_occlusion/overhang_heights.h"
#include "render/ambient_occlusion/texel_grid.h"

#include <functional>
#include <map>
#include <vector>

namespace tumble {

/// A plane with the camera on its outer side.
struct PlaneInView {
    std::size_t body;
    Eigen::Vector3f normal;
    float height;  // of the point that positions are relative to, above it, m
    friend bool operator==(const PlaneInView&, const PlaneInView&) = default;
};

class PlaneOcclusion {
public:
    /// Brings a plane's window up to date: `known` is the one it had, if the plane has not moved. `moved`: the occluders
    /// that have moved since, as they were and as they are; none for `everything`. `store` takes shares for the texels
    /// from (x, y) on, whose rows are `stride` apart. False: nothing is near the plane, or there is no room.
    using Store = std::function<void(int x, int y, int width, int height, int stride, const float* open)>;
    bool update(const PlaneInView& plane, const RenderScene& looks, const Snapshot& snapshot, const Vec3& reference,
                const std::vector<Occluder>& occluders, const std::vector<Occluder>& moved, bool everything,
                const PlaneOcclusionTile* known, ShelfPacker& shelves, PlaneOcclusionTile& window, const Store& store);

private:
    struct Foot {
        const Occluder* occluder;
        double a, b, radius;   // m, on the plane's axes
        double height;         // m, above it
    };
    struct Texels {
        int i0, i1, j0, j1;    // of the window, both ends included
        bool empty() const { return i0 > i1 || j0 > j1; }
    };
    static Texels touched(const Foot& foot, const PlaneOcclusionTile& window);
    bool place(PlaneOcclusionTile& window, ShelfPacker& shelves) const;

    std::map<std::size_t, OverhangHeights> roofs_;   // by plane
    std::vector<Foot> feet_;
    std::vector<float> open_;
    std::vector<char> dirty_;   // blocks
    TexelGrid around_foot_;
};

}  // namespace tumble
