// Culling of shadow casters that are entirely in the shadow of others and so change no texel of the shadow map. The
// near map is divided into small cells. Each cell stores the largest depth of the fronts of the boxes that cover it
// completely; a caster that is deeper in all of its cells is hidden from the sun, in the far map as well. The test is
// conservative: the maps are the same to the bit.
#pragma once

#include "render/scene/drawable_bounds.h"
#include "render/scene/render_scene.h"
#include "render/shadow/shadow_cascades.h"

#include <array>
#include <vector>

namespace tumble {

class CasterCulling {
public:
    explicit CasterCulling(const ShadowCascades& cascades);

    void add(const DrawableBounds& box);

    /// True if the box around the item is hidden by the added boxes. False if it extends beyond the near map.
    bool hides(const DrawableBounds& item) const;

private:
    // A box seen from the sun: a hexagon in texels from its center, and three fronts, the deepest of which counts.
    struct Outline {
        struct Strip {
            double u, v, half;  // the points with |u x + v y| < half; (u, v) is a unit vector
        };
        struct Front {
            double depth, du, dv;  // 0 to 1; at the center, and its derivatives per texel
        };
        double u, v, half_v;  // texels
        double nearest, furthest;
        std::array<Strip, 3> strips;
        std::array<Front, 3> fronts;
    };
    Vec3 place(const Vec3& point) const;  // texels, and the depth
    Outline outline(const DrawableBounds& item) const;

    // Calls see(row, first column, last column) for the cells that are within the hexagon completely, or at least
    // partly, including cells outside the map. Stops and returns false if `see` does.
    template <class See>
    static bool for_each_row(const Outline& o, bool wholly, See see);

    const ShadowCascades* cascades_;
    int count_;  // cells per side
    std::vector<double> depths_;
};

/// Removes casters from the mask that are hidden from the sun by boxes of the mask.
void drop_hidden_casters(const RenderScene& scene, const PerDrawable<DrawableBounds>& drawables,
                         const ShadowCascades& cascades, DrawableMask& casters);

}  // namespace tumble
