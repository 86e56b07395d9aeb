// Which bodies lie wholly in the shadow of others: in the shadow map nothing of them would be left. The near map is divided
// into small cells; each knows how deep the fronts of boxes that cover it wholly lie at most. What lies deeper in all of
// its cells is hidden from the sun, in the far map as well. Only the certain is left out: the maps are the same to the bit.
#pragma once

#include "render/scene/render_scene.h"
#include "render/scene/drawable_bounds.h"
#include "render/shadow/shadow_cascades.h"

#include <array>
#include <vector>

namespace tumble {

class CasterCulling {
public:
    explicit CasterCulling(const ShadowCascades& fit);

    void add(const DrawableBounds& box);

    /// Is the box around the item hidden by those that were added? Not where it leaves the near map.
    bool hides(const DrawableBounds& item) const;

private:
    // A box as the sun sees it: a hexagon in texels from its middle, and over it three fronts, the deepest of which counts.
    struct Outline {
        struct Strip {
            double u, v, half;         // the points with |u x + v y| < half; (u, v) is a unit vector
        };
        struct Front {
            double depth, du, dv;      // 0 to 1; at the middle, and how it grows with each texel
        };
        double u, v, reach_v;          // texels
        double nearest, furthest;
        std::array<Strip, 3> strips;
        std::array<Front, 3> fronts;
    };
    Vec3 place(const Vec3& point) const;   // texels, and the depth
    Outline outline(const DrawableBounds& item) const;

    // Calls see(row, first column, last column) for the cells that lie within the hexagon wholly, or at least partly, beside
    // the map as well. Stops and is false where that is false.
    template <class See>
    static bool for_each_row(const Outline& o, bool wholly, See see);

    const ShadowCascades* fit_;
    int count_;                        // cells to a side
    std::vector<double> depths_;
};

/// Takes those out of `casting` (of each item) that are hidden from the sun by boxes among them.
void drop_hidden_casters(const RenderScene& looks, const std::vector<DrawableBounds>& items, const ShadowCascades& fit,
                         std::vector<char>& casting);

}  // namespace tumble
