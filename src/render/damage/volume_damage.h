// Damage by a body's shadow on a large fixed mesh or ball: where the shadow passes through the boxes around its
// surface.
#pragma once

#include "render/damage/plane_damage.h"
#include "render/frame/frame_context.h"

#include <vector>

namespace tumble {

class VolumeDamage {
public:
    /// `state`: of the item's body.
    VolumeDamage(const DrawableBounds& item, const RenderBody& proxy, const FrameContext& frame, const BodyState& state,
                 const ShadowLight& light);

    /// Marks the caster's shadow.
    void mark_shadow(const DrawableBounds& caster, DirtyTiles& dirty) const;

private:
    struct Box {
        Vec3 center, half_size;  // m, relative to the eye; m, along the axes
    };
    void mark_in(const Box& box, const DrawableBounds& caster, double margin, DirtyTiles& dirty) const;

    ShadowLight light_;
    const Camera* view_;
    Mat3 axes_;  // columns
    std::vector<Box> boxes_;
    bool two_maps_;
};

}  // namespace tumble
