// The values that hold for a whole frame, laid out as shaders/frame.glsl reads them (std140: vec4s throughout).
#pragma once

#include "render/camera/camera.h"
#include "render/shadow/shadow_cascades.h"
#include "scene/description/description.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace tumble {

struct FrameUniforms {
    glm::mat4 clip_from_relative;
    glm::vec4 ray_origin, ray_dx, ray_dy;
    glm::vec4 to_light;
    glm::vec4 shadow_x, shadow_y, shadow_z, shadow_far, shadow_texels;
    glm::vec4 haze;
    glm::vec4 atlas;
};
static_assert(sizeof(FrameUniforms) == sizeof(glm::mat4) + 11 * sizeof(glm::vec4));

/// Planes throw no shadows, for each is the surface of half a space, which takes the sun from all or from nothing: from all where
/// the sun is below what bodies can lie on. Of planes that stand still.
bool sun_is_up(const SceneDescription& scene);

/// `sun_up`: else there is no sunlight.
FrameUniforms make_frame_uniforms(const LightDescription& light, bool sun_up, const Camera& view, double near_distance,
                                  const ShadowCascades& shadows, int atlas_height, bool widen_rods);

}  // namespace tumble
