// Boxes in water: at rest and sinking over densities, and on waves.
#include "harness/shapes.h"
#include "stability/stability_case.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace tumble::bench {
namespace {

const Vector plank{0.5, 0.4, 0.2};  // m: upright it is stable at any density

// Integral of the depth over the wet part of a box, m^4: columns across it, each of them exact.
double depth_integral(const Body& body, const Motion& at) {
    constexpr int across = 8;
    const auto depth = [&](double x, double y, double z) {
        return -(at.position.z + rotate(at.orientation, {x * body.size.x, y * body.size.y, z * body.size.z}).z);
    };
    double sum = 0.0;
    for (int i = 0; i < across; ++i)
        for (int j = 0; j < across; ++j) {
            const double x = (i + 0.5) / across - 0.5, y = (j + 0.5) / across - 0.5;
            const double a = depth(x, y, -0.5), b = depth(x, y, 0.5), deeper = std::max(a, b);
            if (deeper <= 0.0) continue;
            sum += a >= 0.0 && b >= 0.0 ? 0.5 * (a + b) : 0.5 * deeper * deeper / std::abs(a - b);
        }
    return sum / (across * across) * body.size.x * body.size.y * body.size.z;
}

// How far the center of a floating box is from its place at rest, over `limit` (m). It may rest on any side.
double off_rest(const Body& body, const Motion& at, double ratio, double limit) {
    const std::array<double, 3> up{rotate(at.orientation, {1.0, 0.0, 0.0}).z, rotate(at.orientation, {0.0, 1.0, 0.0}).z,
                                   rotate(at.orientation, {0.0, 0.0, 1.0}).z};
    const std::array<double, 3> edges{body.size.x, body.size.y, body.size.z};
    double height = 0.0, most = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
        if (std::abs(up[k]) > most) {
            most = std::abs(up[k]);
            height = edges[k];
        }
    return std::abs(at.position.z - (0.5 - ratio) * height) / limit;
}

// m/s, at which drag and viscosity carry the weight less the buoyancy.
double terminal_speed(const Body& body, const Water& water) {
    const double volume = body.size.x * body.size.y * body.size.z;
    const double weight = (body.mass - water.density * volume) * g;
    const double square = 0.5 * water.density * water.drag * body.size.x * body.size.y;
    const double linear = 6.0 * std::numbers::pi * water.viscosity * std::cbrt(3.0 * volume / (4.0 * std::numbers::pi));
    return 2.0 * weight / (linear + std::sqrt(linear * linear + 4.0 * square * weight));
}

// A box that falls into still water, tilted where it floats.
Trial dropped(double ratio, double) {
    constexpr double above = 0.5;  // m
    Trial trial;
    Water water;
    water.viscosity = 1e-3;
    const double volume = plank.x * plank.y * plank.z;
    Body body = box(plank, ratio * water.density * volume, {0.0, 0.0, above});
    if (ratio < 1.0) body.orientation = turn({1.0, 0.7, 0.0}, std::numbers::pi / 18.0);
    trial.scene.bodies = {body};
    trial.scene.water = water;
    trial.seconds = 30.0;
    const double scale = body.mass * g * above, sinks = ratio > 1.0 ? terminal_speed(body, water) : 0.0;
    trial.watch = [=, scene = trial.scene, seconds = trial.seconds](double time, const std::vector<Motion>& motions) {
        const Motion& at = motions[0];
        const double stored = water.density * g * depth_integral(body, at);
        const double gain = (energy(scene, motions) + stored - scale) / (0.01 * scale);
        if (time < seconds - 1e-9) return gain;
        const double off =
            ratio < 1.0 ? off_rest(body, at, ratio, 0.01 * body.size.z) : std::abs(-at.velocity.z / sinks - 1.0) / 0.01;
        return std::max(gain, off);
    };
    return trial;
}

// A light box that starts at rest on a crest.
Trial on_waves(double length, double) {
    constexpr double ratio = 0.3, steepness = 0.05;  // of densities; wave height over length
    const Vector size{0.2, 0.2, 0.1};
    Trial trial;
    Water water;
    water.viscosity = 1e-3;
    water.wave_height = steepness * length;
    water.wave_length = length;
    const double floats = (0.5 - ratio) * size.z;  // m, of the center above the surface
    const double mass = ratio * water.density * size.x * size.y * size.z;
    trial.scene.bodies = {box(size, mass, {0.0, 0.0, water.surface(0.0, 0.0) + floats})};
    trial.scene.water = water;
    trial.seconds = std::max(10.0, 5.0 * std::sqrt(2.0 * std::numbers::pi * length / g));
    trial.watch = [=](double time, const std::vector<Motion>& motions) {
        const Vector& at = motions[0].position;
        return std::abs(at.z - floats - water.surface(at.x, time)) / water.wave_height;
    };
    return trial;
}

}  // namespace

void add_water(std::vector<StabilityCase>& cases) {
    cases.push_back(
        {"box in water",
         "density ratio",
         "box that falls into still water, 30 s; floats within 1 % of its height of its draft, or sinks at its "
         "terminal speed within 1 %; energy never 1 % of the fall above the start",
         {1e3, 10.0, 2.0, 1.1, 0.9, 0.5, 0.1, 1e-2, 1e-3},
         stability_rates(),
         dropped,
         true});
    cases.push_back({"box on waves",
                     "wave length, m",
                     "box of 0.2 m and 0.3 of the water's density, waves of a twentieth of their length, 5 periods and "
                     "10 s; never farther than a wave height from where it floats on the surface at its place",
                     {100.0, 30.0, 10.0, 3.0, 1.0, 0.3, 0.1},
                     stability_rates(),
                     on_waves,
                     true});
}

}  // namespace tumble::bench
