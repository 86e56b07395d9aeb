// A map over the number of bonds, the strength and the step: no break makes momentum or energy.
#include "scene/load.h"
#include "sim/world.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace tumble::fracture_map_test {
namespace {

struct Books {
    double momentum = 0.0;  // largest change, over the momentum at the start
    double energy = 0.0;    // largest change of energy with losses, over the energy at the start
    double gain = 0.0;      // largest kinetic energy over that at the start, less 1
    std::size_t breaks = 0;
};

/// A ball flies at a spinning plate in free space.
Books books_of(int cells, double strength, int steps, bool exact) {
    const SceneDescription scene = parse_scene(
        fmt::format("format = 1\n[simulation]\ngravity = [0, 0, 0]\nintegrator = \"exact\"\nsteps_per_frame = {}\n"
                    "impacts = \"{}\"\n[[body]]\ndensity = 2500\nstrength = {}\nstiffness = {}\ntoughness = 1\n"
                    "shape = {{ type = \"box\", size = [0.6, 0.5, 0.05] }}\nangular_velocity = [0.4, -0.3, 0.2]\n"
                    "fracture = {{ cells = {}, seed = 3 }}\n[[body]]\nshape = {{ type = \"sphere\", radius = 0.05 }}\n"
                    "density = 7800\nposition = [0.03, 0.04, 0.3]\nvelocity = [0.2, -0.1, -9]\n",
                    steps, exact ? "exact" : "stepped", strength, 1000.0 * strength, cells),
        "map.toml");
    World world(scene);
    world.record_energy();
    const Measurement start = world.measure();
    Books books;
    for (int n = 0; n < 20; ++n) {
        world.advance_frame();
        books.breaks += world.breaks().size();
        const Measurement now = world.measure();
        const EnergyLedger& ledger = world.contact_records().energy;
        const double sum = now.kinetic + ledger.impact_loss + ledger.friction_loss + ledger.surface;
        books.momentum = std::max(books.momentum, (now.momentum - start.momentum).norm() / start.momentum.norm());
        books.energy = std::max(books.energy, std::abs(sum / start.kinetic - 1.0));
        books.gain = std::max(books.gain, now.kinetic / start.kinetic - 1.0);
    }
    return books;
}

TEST(FractureMap, BondsStrengthAndStep) {
    for (const bool exact : {false, true})
        for (const int cells : {2, 8, 30})
            for (const double strength : {1e2, 1e4, 1e6, 1e8, 1e12})
                for (const int steps : {1, 4, 16}) {
                    if (exact && steps > 1) continue;  // it does not depend on the step
                    const Books books = books_of(cells, strength, steps, exact);
                    const std::string where = fmt::format("{} cells, {} Pa, {} steps, {}", cells, strength, steps,
                                                          exact ? "exact" : "stepped");
                    EXPECT_LT(books.momentum, 1e-12) << where;
                    EXPECT_LT(books.energy, 1e-3) << where;  // pieces touch: resting contact has no exact books
                    EXPECT_LT(books.gain, 1e-9) << where;
                    if (strength <= 1e2) {
                        EXPECT_GT(books.breaks, 0u) << where;
                    }
                    if (strength >= 1e12) {
                        EXPECT_EQ(books.breaks, 0u) << where;
                    }
                }
}

}  // namespace
}  // namespace tumble::fracture_map_test
