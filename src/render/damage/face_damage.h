// Where on the screen a body's shadow changes the look of a large box that stands still: face by face, as on planes.
#pragma once

#include "render/damage/plane_damage.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class FaceDamage {
public:
    /// `faces`: those of the box that can be seen, bits as in Visibility.
    FaceDamage(const DrawableBounds& box, std::uint8_t faces, const ShadowLight& light, const Camera& view);

    /// Does each pixel of such a box find its place in the shadow maps by itself? Others look into the far map as a whole.
    static bool suits(const DrawableBounds& box, const ShadowCascades& shadows);

    /// Marks the caster's shadow on each face.
    void mark_shadow(const DrawableBounds& caster, DirtyTiles& marks) const;

private:
    struct Face {
        Vec3 middle, u, v;   // u, v: unit
        double half_u, half_v;   // m
        Vec3 normal;
        double approach;     // sine of the angle at which the light meets it
        Mat3 from_map;       // place in the near map, and height over the face's plane -> relative to the eye
        bool meets(std::span<const Vec3> points, double around) const;
        std::array<Vec3, 4> corners() const;
    };
    void mark_in_far_map(const Face& face, const DrawableBounds& caster, DirtyTiles& marks) const;

    ShadowLight light_;
    const Camera* view_;
    std::vector<Face> faces_;   // those in the sun
    bool two_maps_;
};

/// The corners of a part of a box's face. `low`, `high`: on its axes (the box's next two after the face's), from -1 to 1.
std::array<Vec3, 4> face_part(const DrawableBounds& box, int face, const Eigen::Vector2d& low = {-1.0, -1.0},
                              const Eigen::Vector2d& high = {1.0, 1.0});

}  // namespace tumble
