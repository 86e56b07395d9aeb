#include "render/passes/lamp_uniforms.h"

#include "core/deterministic_math.h"
#include "render/gl/glm_conversion.h"
#include "scene/description/lamps.h"

#include <algorithm>

namespace tumble {
namespace {

glm::vec4 strength_in_glsl(const LampDescription& lamp) {
    const std::array<double, 3> strength = strength_of(lamp);
    return glm::vec4(float(strength[0]), float(strength[1]), float(strength[2]), 0.0f);
}

}  // namespace

std::vector<LampDescription> lamps_beside_sun(const RenderScene& scene) {
    std::vector<LampDescription> all = scene.lamps;
    if (const auto sun = main_sun(all)) all.erase(all.begin() + std::ptrdiff_t(*sun));
    return all;
}

LampUniforms make_lamp_uniforms(const RenderScene& scene, const Camera& view, const std::optional<LampMap>& map) {
    LampUniforms u{};
    if (const auto sun = main_sun(scene.lamps)) u.sun = strength_in_glsl(scene.lamps[*sun]);
    std::size_t at = 0;
    for (const LampDescription& lamp : lamps_beside_sun(scene)) {
        const bool sun = lamp.type == LightType::sun;
        u.place[at] = sun ? to_glm(-lamp.direction, 0.0) : to_glm(view.relative(lamp.position), 1.0);
        u.light[at] = strength_in_glsl(lamp);
        u.axis[at] = to_glm(lamp.direction, sincos(0.5 * lamp.angle * pi / 180.0).cos);
        ++at;
    }
    if (map) {
        std::ranges::copy(map->rows, u.map);
        u.bias = glm::vec4(map->normal_shift, map->light_shift, 0.0f, 0.0f);
    }
    return u;
}

}  // namespace tumble
