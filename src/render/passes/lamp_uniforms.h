// Uniforms of several lights, in the layout of shaders/lamps_block.glsl (std140).
#pragma once

#include "render/camera/camera.h"
#include "render/scene/render_scene.h"
#include "render/shadow/lamp_map.h"

#include <glm/vec4.hpp>

#include <optional>
#include <vector>

namespace tumble {

struct LampUniforms {
    static constexpr std::size_t most = 4;
    glm::vec4 sun;
    glm::vec4 place[most], light[most], axis[most];
    glm::vec4 map[4], bias;
};

/// All lights but the sun that lighting.glsl has.
std::vector<LampDescription> lamps_beside_sun(const RenderScene& scene);

/// `map`: of the second light with shadows, if there is one.
LampUniforms make_lamp_uniforms(const RenderScene& scene, const Camera& view, const std::optional<LampMap>& map);

}  // namespace tumble
