// Damage by a body's shadow on a large fixed box: face by face, as on planes.
#pragma once

#include "render/damage/plane_damage.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

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

/// The corners of a part of a box's face. `low`, `high`: on its axes (the two axes after that of the face), from -1 to
/// 1.
std::array<Vec3, 4> face_part(const DrawableBounds& box, int face, const Eigen::Vector2d& low = {-1.0, -1.0},
                              const Eigen::Vector2d& high = {1.0, 1.0});

}  // namespace tumble
