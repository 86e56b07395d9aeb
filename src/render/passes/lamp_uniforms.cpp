#include "render/passes/lamp_uniforms.h"

#include "core/deterministic_math.h"
#include "render/gl/glm_conversion.h"
#include "scene/description/lamps.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
namespace {

glm::vec4 strength_in_glsl(const LampDescription& lamp) {
    const std::array<double, 3> strength = strength_of(lamp);
    return glm::vec4(float(strength[0]), float(strength[1]), float(strength[2]), 0.0f);
}

/// All but the sun that lighting.glsl has.
std::vector<LampDescription> others(const RenderScene& scene) {
    std::vector<LampDescription> all = scene.lamps;
    if (const auto sun = main_sun(all)) all.erase(all.begin() + std::ptrdiff_t(*sun));
    return all;
}

}  // namespace

LampUniforms make_lamp_uniforms(const RenderScene& scene, const Camera& view) {
    LampUniforms u{};
    if (const auto sun = main_sun(scene.lamps)) u.sun = strength_in_glsl(scene.lamps[*sun]);
    std::size_t at = 0;
    for (const LampDescription& lamp : others(scene)) {
        const bool sun = lamp.type == LightType::sun;
        u.place[at] = sun ? to_glm(-lamp.direction, 0.0) : to_glm(view.relative(lamp.position), 1.0);
        u.light[at] = strength_in_glsl(lamp);
        u.axis[at] = to_glm(lamp.direction, sincos(0.5 * lamp.angle * pi / 180.0).cos);
        ++at;
    }
    return u;
}

std::vector<std::string> lamp_defines(const RenderScene& scene) {
    if (scene.lamps.empty()) return {};
    std::vector<std::string> all{"LAMP_LIGHT"};
    const std::vector<LampDescription> lamps = others(scene);
    if (lamps.empty()) return all;
    int kinds = 0;
    for (std::size_t i = 0; i < lamps.size(); ++i) kinds |= int(lamps[i].type) << (2 * i);
    all.push_back(fmt::format("LAMPS {}", lamps.size()));
    all.push_back(fmt::format("LAMP_KINDS {}", kinds));
    if (std::ranges::find(lamps, LightType::spot, &LampDescription::type) != lamps.end()) all.emplace_back("SPOTS");
    return all;
}

}  // namespace tumble
