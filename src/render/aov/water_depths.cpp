#include "render/aov/water_depths.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();

/// Most steps toward the surface; rays that need more graze it from crest to crest, far away.
constexpr int most_steps = 400;

/// Part of the amplitude by which a ray may dip into a crest unseen.
constexpr double least_gap = 1e-3;

}  // namespace

double water_depth(const WaterSurface& water, double time, const Vec3& eye, const Vec3& ray) {
    double most = 0.0, steepest = 0.0;  // m and slope of all waves together
    for (const WaterSurface::Wave& wave : water.waves()) {
        most += wave.amplitude;
        steepest += wave.amplitude * wave.decay;
    }
    const double above = eye.y() - water.level();
    const auto meets = [&](double height) { return ray.y() != 0.0 ? (height - above) / ray.y() : none; };
    if (water.still()) {
        const double depth = meets(0.0);
        return depth > 0.0 ? depth : none;
    }
    // Outside of the layer from trough to crest there is no surface.
    double depth = 0.0;
    if (std::abs(above) > most) {
        depth = meets(above > 0.0 ? most : -most);
        if (!(depth > 0.0) || depth == none) return none;
    }
    const double last = ray.y() != 0.0 ? meets(ray.y() > 0.0 ? most : -most) : none;
    const auto over = [&](double d) {
        const Vec3 p = eye + d * ray;
        return p.y() - water.height(p.x(), p.z(), time);
    };
    const double side = over(depth) >= 0.0 ? 1.0 : -1.0;
    // By regula falsi, with half the weight of an end that stays (Dowell and Jarratt 1971).
    const auto root = [&](double low, double f_low, double high, double f_high) {
        double at = high;
        for (int step = 0; step < 60 && std::abs(f_high) > 1e-13 * most; ++step) {
            at = high - f_high * (high - low) / (f_high - f_low);
            const double f = side * over(at);
            if ((f > 0.0) == (f_high > 0.0))
                f_low *= 0.5;
            else
                low = high, f_low = f_high;
            high = at, f_high = f;
        }
        return at;
    };
    const double fastest = std::abs(ray.y()) + steepest * std::sqrt(ray.x() * ray.x() + ray.z() * ray.z());
    double before = depth, gap_before = 0.0;
    for (int step = 0; step < most_steps; ++step) {
        const double gap = side * over(depth);
        if (gap <= 0.0) return step == 0 ? depth : root(before, gap_before, depth, gap);
        if (depth >= last) return none;
        before = depth;
        gap_before = gap;
        depth = std::min(depth + std::max(gap, least_gap * most) / fastest, last);
    }
    return depth;
}

void add_water(const WaterSurface& water, double time, const PinholeCamera& camera, std::uint32_t surface,
               VisibilityBuffer& map) {
    for (int row = 0; row < map.height; ++row)
        for (int column = 0; column < map.width; ++column) {
            const Vec3 ray = camera.axes * Vec3(camera.ray_x(column), camera.ray_y(row), 1.0);
            const double depth = water_depth(water, time, camera.eye, ray);
            const std::size_t pixel = map.at(column, row);
            if (!(depth < map.depth[pixel])) continue;
            map.depth[pixel] = depth;
            map.surface[pixel] = surface;
        }
}

}  // namespace tumble
