#include "scene/environment/presets.h"

#include "core/check.h"
#include "core/deterministic_math.h"
#include "core/vector.h"
#include "scene/environment/irradiance.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

constexpr int preset_width = 512, preset_height = 256;

using Light = Eigen::Array3d;

double smooth(double from, double to, double value) {
    const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

Light mixed(const Light& a, const Light& b, double share) { return a + (b - a) * share; }

/// Share of a lamp of this half width and height (tangents of angles) around `toward`, with a soft rim.
double panel(const Vec3& direction, const Vec3& toward, double half_width, double half_height, double rim) {
    const Vec3 axis = toward.normalized();
    const Vec3 right =
        (std::abs(axis.y()) > 0.999 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitY().cross(axis))).normalized();
    const Vec3 up = axis.cross(right);
    const double ahead = direction.dot(axis);
    if (ahead <= 0.05) return 0.0;
    const double x = std::abs(direction.dot(right)) / ahead, y = std::abs(direction.dot(up)) / ahead;
    return smooth(half_width + rim, half_width - rim, x) * smooth(half_height + rim, half_height - rim, y);
}

/// A room with light walls and a dark ceiling, a lamp above, a large one at the left, and narrow ones at the right and
/// behind.
Light studio(const Vec3& d) {
    Light light = mixed(Light(0.66, 0.67, 0.685), Light(0.20, 0.205, 0.22), smooth(-0.05, 0.8, d.y()));
    light = mixed(light, Light(0.50, 0.495, 0.49), smooth(0.0, 0.25, -d.y()));
    light += Light(3.3, 3.3, 3.4) * panel(d, {0.1, 1.0, 0.2}, 0.40, 0.20, 0.08);
    light += Light(3.0, 2.9, 2.7) * panel(d, {-1.0, 0.55, 0.5}, 0.28, 0.36, 0.06);
    light += Light(2.4, 2.55, 2.8) * panel(d, {1.0, 0.35, 0.45}, 0.10, 0.5, 0.04);
    light += Light(1.6, 1.65, 1.8) * panel(d, {0.5, 0.9, -1.0}, 0.5, 0.07, 0.04);
    return light;
}

/// An even layer of clouds, brighter above, and light ground.
Light overcast(const Vec3& d) {
    const double up = std::max(d.y(), 0.0);
    const Light sky = mixed(Light(0.70, 0.725, 0.75), Light(0.93, 0.965, 1.0), smooth(0.0, 0.9, up));
    return mixed(sky, Light(0.40, 0.395, 0.38), smooth(0.0, 0.30, -d.y()));
}

/// The sun has set: a bright band there, a dark blue sky above, and a dim violet one on the other side.
Light dusk(const Vec3& d) {
    const Vec3 sun = Vec3(-0.75, 0.01, -0.66).normalized();
    const double up = std::max(d.y(), 0.0), level = hypotenuse(d.x(), d.z());
    const double toward = level > 0.0 ? 0.5 + 0.5 * (d.x() * sun.x() + d.z() * sun.z()) / level : 0.5;
    const double low = exponential(-4.5 * up), lower = exponential(-12.0 * up), west = toward * toward;
    Light sky = mixed(Light(0.085, 0.125, 0.29), Light(0.055, 0.085, 0.21), smooth(0.2, 1.0, up));
    sky += low * mixed(Light(0.13, 0.10, 0.19), Light(0.52, 0.22, 0.13), west);
    sky += lower * west * west * Light(0.62, 0.29, 0.06);
    sky += exponential(-30.0 * (1.0 - std::max(d.dot(sun), 0.0))) * Light(1.1, 0.62, 0.24);
    const Light ground = mixed(Light(0.055, 0.052, 0.072), Light(0.13, 0.08, 0.065), west);
    return mixed(sky, ground, smooth(0.0, 0.20, -d.y()));
}

}  // namespace

EnvironmentPreset environment_preset(std::string_view name) {
    const auto known = std::find(environment_presets.begin(), environment_presets.end(), name);
    TUMBLE_CHECK_EQ(known != environment_presets.end(), true);
    struct Known {
        Light (*formula)(const Vec3&);
        double above;  // irradiance over pi of a level surface
        std::array<double, 3> sun;
    };
    static constexpr Known all[] = {
        {studio, 0.52, {0.58, 0.61, 0.68}}, {overcast, 0.74, {0.16, 0.17, 0.19}}, {dusk, 0.18, {0.62, 0.42, 0.25}}};
    const auto& [formula, above, sun] = all[known - environment_presets.begin()];
    auto image = std::make_shared<EnvironmentImage>();
    image->width = preset_width, image->height = preset_height;
    image->texels.reserve(std::size_t(preset_width) * std::size_t(preset_height));
    for (int y = 0; y < preset_height; ++y) {
        const auto [sine, cosine] = sincos(pi * (y + 0.5) / preset_height);
        for (int x = 0; x < preset_width; ++x) {
            const auto [across, along] = sincos(2.0 * pi * ((x + 0.5) / preset_width - 0.5));
            const Light light = formula(Vec3(sine * along, cosine, sine * across));
            image->texels.push_back({float(light[0]), float(light[1]), float(light[2])});
        }
    }
    EnvironmentDescription environment;
    environment.image = image;
    const Irradiance light = irradiance_of(environment);
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) sum += double(light[0][c]) + double(light[2][c]) - double(light[8][c]);
    for (auto& texel : image->texels)
        for (float& channel : texel) channel *= float(3.0 * above / sum);
    return {std::move(image), sun};
}

}  // namespace tumble
