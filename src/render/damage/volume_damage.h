// Where on the screen a body's shadow may change the look of a large mesh or ball that stands still: where the shadow passes
// through the boxes that hold its surface.
#pragma once

#include "render/damage/plane_damage.h"

#include <vector>

namespace tumble {

class VolumeMarks {
public:
    /// `state`: of the body that the item is.
    VolumeMarks(const DrawnItem& item, const BodyLook& look, const SceneLooks& looks, const BodyState& state,
                const ShadowLight& light, const CameraView& view);

    /// Marks the caster's shadow.
    void mark_shadow(const DrawnItem& caster, TileMarks& marks) const;

private:
    struct Box {
        Vec3 center, half_size;   // relative to the eye, m; along the axes
    };
    void mark_in(const Box& box, const DrawnItem& caster, double margin, TileMarks& marks) const;

    ShadowLight light_;
    const CameraView* view_;
    Mat3 axes_;                   // columns
    std::vector<Box> boxes_;
    bool two_maps_;
};

}  // namespace tumble
