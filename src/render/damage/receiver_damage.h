// Damage by a body's shadow on a large fixed receiver: on a box face by face, as on planes; on a mesh or ball where the
// shadow passes through the boxes around its surface.
#pragma once

#include "render/damage/plane_damage.h"
#include "render/frame/frame_context.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// On a box.
class FaceDamage {
public:
    /// `faces`: the visible faces of the box, bits as in Visibility.
    FaceDamage(const DrawableBounds& box, std::uint8_t faces, const ShadowLight& light, const Camera& view);

    /// True if each pixel of such a box selects its cascade. Other boxes use the far map as a whole.
    static bool suits(const DrawableBounds& box, const ShadowCascades& shadows);

    /// Marks the caster's shadow on each face.
    void mark_shadow(const DrawableBounds& caster, DirtyTiles& dirty) const;

private:
    struct Face {
        Vec3 middle, u, v;      // m; u, v: unit
        double half_u, half_v;  // m
        Vec3 normal;
        double approach;  // sine of the angle between the light and the face
        Mat3 from_map;    // place in the near map, and height over the face's plane -> relative to the eye
        bool meets(std::span<const Vec3> points, double around) const;
        std::array<Vec3, 4> corners() const;
    };
    void mark_in_far_map(const Face& face, const DrawableBounds& caster, DirtyTiles& dirty) const;

    ShadowLight light_;
    const Camera* view_;
    std::vector<Face> faces_;  // faces towards the sun
    bool two_maps_;
};

/// On a mesh or ball.
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
