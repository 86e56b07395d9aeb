#include "render/passes/scene_defines.h"

#include "render/passes/lamp_uniforms.h"
#include "scene/description/lamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

void add_lamps(const RenderScene& scene, std::vector<std::string>& all) {
    if (scene.lamps.empty()) return;
    all.emplace_back("LAMP_LIGHT");
    const std::vector<LampDescription> lamps = lamps_beside_sun(scene);
    if (lamps.empty()) return;
    int kinds = 0;
    for (std::size_t i = 0; i < lamps.size(); ++i) kinds |= int(lamps[i].type) << (2 * i);
    all.push_back(fmt::format("LAMPS {}", lamps.size()));
    all.push_back(fmt::format("LAMP_KINDS {}", kinds));
    if (std::ranges::find(lamps, LightType::spot, &LampDescription::type) != lamps.end()) all.emplace_back("SPOTS");
    // Only the main sun has other shadows.
    const auto shadow = std::ranges::find(lamps, true, &LampDescription::shadows);
    if (shadow == lamps.end()) return;
    all.push_back(fmt::format("LAMP_SHADOW {}", shadow - lamps.begin()));
    all.push_back(fmt::format("LAMP_TEXELS {}.0", lamp_map_texels));
}

void add_mirror_floor(const RenderScene& scene, std::vector<std::string>& all) {
    constexpr double steepest = 0.5;  // cosine of 60 degrees: a steeper plane is a wall
    for (const RenderBody& body : scene.bodies) {
        if (body.reflection <= 0.0f || body.plane.normal.normalized().y() < steepest) continue;
        all.push_back(fmt::format("MIRROR_FLOOR vec4({:.6f}, {:.6f}, {:.6f}, {:.6f})", body.color.r, body.color.g,
                                  body.color.b, body.reflection));
    }
}

}  // namespace

std::vector<std::string> scene_defines(const RenderScene& scene) {
    std::vector<std::string> all;
    add_lamps(scene, all);
    add_mirror_floor(scene, all);
    if (const auto& environment = scene.environment) {
        if (environment->image) all.emplace_back("ENVIRONMENT");
        if (environment->background == BackgroundKind::colors) all.emplace_back("BACKGROUND 1");
        if (environment->background == BackgroundKind::image) all.emplace_back("BACKGROUND 2");
        if (environment->ground_shadow) all.emplace_back("GROUND_SHADOW");
    }
    if (scene.shadow_alpha != 0) all.push_back(fmt::format("TRANSPARENT {}", scene.shadow_alpha));
    if (scene.cut) all.emplace_back("CUT");
    if (scene.exposure != 0.0) all.push_back(fmt::format("EXPOSURE {:.9e}", std::exp2(scene.exposure)));
    if (scene.tone == ToneCurve::linear) all.emplace_back("LINEAR_TONE");
    return all;
}

}  // namespace tumble
