// Floating bodies over densities, steps and waves: they stay finite and keep to the speeds of the water, and on still
// water the books of energy close without a gain.
#include "scene/load.h"
#include "sim/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace tumble::water_map_test {
namespace {

constexpr double water = 1000.0, drop = 0.5;  // kg/m^3; m above the water

SceneDescription scene_of(const std::string& shape, double density, int steps, bool waves) {
    return parse_scene("format = 1\n[simulation]\nsteps_per_frame = " + std::to_string(steps) +
                           "\n[water]\nlevel = 0\nviscosity = 0.01\n" +
                           (waves ? "waves = [{ height = 0.2, length = 4, direction = [1, 0, 0] }]\n" : "") +
                           "[[body]]\ndensity = " + std::to_string(density) + "\nshape = " + shape +
                           "\nposition = [0, " + std::to_string(drop) +
                           ", 0]\nrotation = { axis = [1, 2, 3], angle = 40 }\n",
                       "water_map.toml");
}

TEST(WaterMap, DensitiesStepsAndWaves) {
    for (const char* shape : {"{ type = \"box\", size = [0.4, 0.3, 0.5] }", "{ type = \"sphere\", radius = 0.2 }"})
        for (const double ratio : {1e-3, 1e-2, 0.1, 0.5, 0.9, 2.0, 10.0, 1e3})
            for (const int steps : {4, 16})
                for (const bool waves : {false, true}) {
                    World world(scene_of(shape, ratio * water, steps, waves));
                    world.record_energy();
                    const double start = world.measure().kinetic + world.measure().potential;
                    double fastest = 0.0;
                    for (int n = 0; n < 120; ++n) {
                        world.advance_frame();
                        fastest = std::max(fastest, world.snapshot().bodies[0].velocity.norm());
                        const Measurement now = world.measure();
                        const double books = now.kinetic + now.potential + world.contact_records().energy.water_loss;
                        // The error of the Euler method is in proportion to the step, for weights and for buoyancies.
                        const double scale = 0.08 * water * 9.81 * std::max(1.0, ratio);
                        if (waves) continue;
                        EXPECT_LT(books - start, 1e-3 * scale) << shape << ratio << ' ' << steps << ' ' << n;
                    }
                    // Free fall in the time is the bound of heavy bodies; light ones are carried by the water.
                    EXPECT_LT(fastest, ratio > 1.0 ? 9.81 * 2.0 + 1.0 : 12.0)
                        << shape << ratio << ' ' << steps << waves;
                }
}

}  // namespace
}  // namespace tumble::water_map_test
