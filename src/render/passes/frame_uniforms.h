// Uniforms that are constant over a frame, in the layout of shaders/frame.glsl (std140: vec4s throughout).
#pragma once

#include "render/frame/frame_context.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

namespace tumble {

struct FrameUniforms {
    glm::mat4 clip_from_relative;
    glm::vec4 ray_origin, ray_dx, ray_dy;
    glm::vec4 to_light;
    glm::vec4 shadow_x, shadow_y, shadow_z, shadow_far, shadow_texels;
    float fog_density;               // 1 / squared distance at which fog is half of the light, 1/m^2
    float pixel_size;                // at distance 1 along the axis
    float widest_rod, thinnest_rod;  // half sizes at distance 1; 0: no rod is widened
    glm::vec4 atlas;
};
static_assert(sizeof(FrameUniforms) == sizeof(glm::mat4) + 11 * sizeof(glm::vec4));

/// `widen_rods`: boxes thinner than a pixel are drawn about a pixel wide (thin_geometry_aa.h).
FrameUniforms make_frame_uniforms(const FrameContext& frame, int atlas_height, bool widen_rods);

}  // namespace tumble
