// Uniforms of several lights, in the layout of shaders/lights_place.glsl (std140).
#pragma once

#include "render/camera/camera.h"
#include "render/scene/render_scene.h"

#include <glm/vec4.hpp>

#include <string>
#include <vector>

namespace tumble {

struct LampUniforms {
    static constexpr std::size_t most = 4;
    glm::vec4 sun;
    glm::vec4 place[most], light[most], axis[most];
};

/// Without lights of its own, the scene has the constants of shaders/light_constants.glsl and no definitions.
LampUniforms make_lamp_uniforms(const RenderScene& scene, const Camera& view);
std::vector<std::string> lamp_defines(const RenderScene& scene);

}  // namespace tumble
