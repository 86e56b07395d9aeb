#include "render/shadow/lamp_map.h"

#include "core/deterministic_math.h"
#include "render/gl/glm_conversion.h"
#include "scene/description/lamps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr double normal_texels = 2.2, light_texels = 4.0;  // shifts, as of texel_filter

constexpr double nearest_of_ao_radius = 0.05;  // least distance from a spot with its own depth, in AO radii

SceneDescription lit_by(SceneDescription description, const LampDescription& lamp) {
    description.light.direction = lamp.direction;
    return description;
}

}  // namespace

LampMapFitter::LampMapFitter(const SceneDescription& description, const RenderScene& scene, const Camera& view)
    : lamp_(scene.lamps.at(second_shadow(scene.lamps).value())) {
    if (lamp_.type == LightType::sun) sun_.emplace(lit_by(description, lamp_), scene, view, lamp_map_texels);
}

LampMap LampMapFitter::fit(const RenderScene& scene, const Snapshot& snapshot, const Camera& view,
                           const Vec3& carried) const {
    if (!sun_) return fit_spot(scene, snapshot, view);
    const ShadowCascades cascades = sun_->fit(scene, snapshot, view, carried);
    const glm::vec4 end(0.0f, 0.0f, 0.0f, 1.0f);
    const auto across = [&](const glm::vec4& near, float shift) {
        return 2.0f * (near * cascades.far.x + shift * end) - end;
    };
    LampMap map{};
    map.direction = lamp_.direction;
    map.rows = {across(cascades.x, cascades.far.y), across(cascades.y, cascades.far.z), 2.0f * cascades.z - end, end};
    const double texel = cascades.has_far ? cascades.far_texel : cascades.near_texel;
    map.normal_shift = float(normal_texels * texel);
    map.light_shift = float(2.0 * light_texels * texel) * glm::length(glm::vec3(cascades.z));
    return map;
}

LampMap LampMapFitter::fit_spot(const RenderScene& scene, const Snapshot& snapshot, const Camera& view) const {
    const Vec3 position = view.relative(lamp_.position), z = lamp_.direction;
    const Vec3 across = std::abs(z.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitZ();
    const Vec3 x = (across - z * z.dot(across)).normalized(), y = z.cross(x);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!scene.bodies[i].solid()) continue;
        const BoundingBall ball = bounding_ball(scene.bodies[i], snapshot.bodies[i], view);
        if (z.dot(ball.center - position) > -ball.radius)
            nearest = std::min(nearest, (ball.center - position).norm() - ball.radius);
    }
    // As near_distance_for(): small movements do not round all depths differently.
    const double least = nearest_of_ao_radius * scene.typical_ao_radius;
    const double near =
        std::exp2(std::floor(std::log2(std::isfinite(nearest) ? std::max(0.5 * nearest, least) : least)));
    const SinCos half = sincos(0.5 * lamp_.angle * pi / 180.0);
    const double tan = half.sin / half.cos, texel = 2.0 * tan / lamp_map_texels;  // at distance 1
    const auto row = [&](const Vec3& axis, double more) { return to_glm(axis, more - axis.dot(position)); };
    LampMap map{};
    map.direction = lamp_.direction;
    map.position = position;
    map.rows = {row(x / tan, 0.0), row(y / tan, 0.0), row(z, -2.0 * near), row(z, 0.0)};
    map.normal_shift = float(normal_texels * texel);
    // z of a point that is nearer by as many texels
    map.light_shift = float(2.0 * near * (1.0 / (1.0 - std::min(light_texels * texel, 0.5)) - 1.0));
    return map;
}

}  // namespace tumble
