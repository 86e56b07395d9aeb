// Where on the screen a body's shadow may change the look of a large mesh or ball that stands still: where the shadow passes
// through the boxes that hold its surface.
#pragma once

#include "render/damage/plane_damage.h"

#include <vector>

namespace tumble {

class VolumeDamage {
public:
    /// `state`: of the body that the item is.
    VolumeDamage(const DrawableBounds& item, const RenderBody& look, const RenderScene& looks, const BodyState& state,
                const ShadowLight& light, const Camera& view);

    /// Marks the caster's shadow.
    void mark_shadow(const DrawableBounds& caster, DirtyTiles& marks) const;

private:
    struct Box {
        Vec3 center, half_size;   // relative to the eye, m; along the axes
    };
    void mark_in(const Box& box, const DrawableBounds& caster, double margin, DirtyTiles& marks) const;

    ShadowLight light_;
    const Camera* view_;
    Mat3 axes_;                   // columns
    std::vector<Box> boxes_;
    bool two_maps_;
};

}  // namespace tumble
