// The region of the shadow map of a second light: the cone of a spot, or the region of the cascades of a sun. It
// depends on the scene and one snapshot only.
#pragma once

#include "render/camera/camera.h"
#include "render/scene/render_scene.h"
#include "render/shadow/shadow_cascades.h"

#include <glm/vec4.hpp>

#include <array>
#include <optional>

namespace tumble {

inline constexpr int lamp_map_texels = 1024;  // across the map

struct LampMap {
    std::array<glm::vec4, 4> rows;  // position relative to the eye -> clip space of the map
    float normal_shift;             // along the normal of a surface, m at w = 1
    float light_shift;              // of z towards the light
    Vec3 direction;                 // in which a sun shines, unit
    std::optional<Vec3> position;   // of a spot, m, relative to the eye

    /// The direction of the light at a point (m, relative to the eye), of any length.
    Vec3 light_at(const Vec3& point) const { return position ? Vec3(point - *position) : direction; }
};

/// For a scene whose lamps have a second light with shadows.
class LampMapFitter {
public:
    /// `view`: at the start. The scene has second_shadow() of lamps.h.
    LampMapFitter(const SceneDescription& description, const RenderScene& scene, const Camera& view);

    /// `carried`: see CascadeFitter.
    LampMap fit(const RenderScene& scene, const Snapshot& snapshot, const Camera& view, const Vec3& carried) const;

private:
    LampMap fit_spot(const RenderScene& scene, const Snapshot& snapshot, const Camera& view) const;

    LampDescription lamp_;
    std::optional<CascadeFitter> sun_;
};

}  // namespace tumble
