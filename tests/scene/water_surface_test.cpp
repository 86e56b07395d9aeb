// The surface of water: phase, slope and motion of waves.
#include "core/deterministic_math.h"
#include "scene/description/water.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::water_surface_test {
namespace {

constexpr double g = 9.81;

WaterDescription one_wave(double length) {
    WaterDescription water;
    water.level = 0.3;
    water.waves.push_back({0.2, length, {0.6, 0.0, 0.8}, 40.0});
    return water;
}

TEST(WaterSurface, TenMetersHaveTheirPeriodAndSpeed) {
    const WaterSurface surface(one_wave(10.0), g);
    const double period = 2.5307860417210335, speed = 3.9513415338736444;  // 25-digit reference
    for (const double t : {0.0, 0.4, 1.7}) {
        EXPECT_NEAR(surface.height(1.0, 2.0, t + period), surface.height(1.0, 2.0, t), 1e-14);
        EXPECT_NEAR(surface.height(1.0 + 0.6 * speed, 2.0 + 0.8 * speed, t + 1.0), surface.height(1.0, 2.0, t), 1e-14);
    }
    EXPECT_NEAR(surface.height(0.0, 0.0, 0.0), 0.3 + 0.1 * std::cos(40.0 * pi / 180.0), 1e-15);
}

TEST(WaterSurface, TheNormalIsThatOfTheHeights) {
    WaterDescription water = one_wave(3.0);
    water.waves.push_back({0.1, 2.0, {-1.0, 0.0, 0.0}, 10.0});
    const WaterSurface surface(water, g);
    const double h = 1e-5, x = 0.7, z = -0.4, t = 2.3;
    const Vec3 normal = surface.normal(x, z, t);
    const double dx = (surface.height(x + h, z, t) - surface.height(x - h, z, t)) / (2.0 * h);
    const double dz = (surface.height(x, z + h, t) - surface.height(x, z - h, t)) / (2.0 * h);
    EXPECT_NEAR(-normal.x() / normal.y(), dx, 1e-9);
    EXPECT_NEAR(-normal.z() / normal.y(), dz, 1e-9);
    EXPECT_NEAR(normal.norm(), 1.0, 1e-15);
}

TEST(WaterSurface, WaterAtTheSurfaceRisesWithIt) {
    WaterDescription water = one_wave(3.0);
    water.waves[0].height = 1e-4;  // the theory is that of low waves
    water.current = {0.5, 0.0, -0.2};
    const WaterSurface surface(water, g);
    const double h = 1e-5, x = 0.7, z = -0.4;
    for (const double t : {0.0, 0.3, 0.6}) {
        const double rise =
            (surface.height(x + h * 0.5, z - h * 0.2, t + h) - surface.height(x - h * 0.5, z + h * 0.2, t - h)) /
            (2.0 * h);
        EXPECT_NEAR(surface.velocity({x, surface.height(x, z, t), z}, t).y(), rise, 1e-7);
    }
    EXPECT_LT((surface.velocity({x, -30.0, z}, 0.0) - water.current).norm(), 1e-15);
}

TEST(WaterSurface, AnOriginOfTheCoordinatesChangesNothing) {
    const WaterDescription water = one_wave(3.0);
    const Vec3 origin{5.0, -2.0, 7.0};
    const WaterSurface surface(water, g), moved(water, g, origin);
    EXPECT_NEAR(moved.height(1.0, 2.0, 0.8) + origin.y(), surface.height(6.0, 9.0, 0.8), 1e-14);
}

}  // namespace
}  // namespace tumble::water_surface_test
