#include "scene/keys/readers.h"

#include "scene/fields/water_fields.h"
#include "scene/keys/read_fields.h"

#include <fmt/format.h>

namespace tumble {
namespace {

// The sum of height / length above which the highest wave of a group breaks (Michell 1893: 0.1412 of one wave).
constexpr double steepest = 1.0 / 7.0;

std::vector<WaterWave> read_waves(const TomlValue& list) {
    std::vector<WaterWave> waves;
    double steepness = 0.0;
    for (TomlTable& table : list.tables("; write { height = ..., length = ... } for each")) {
        table.set_title("a wave");
        const WaterWave wave = read_all_fields<WaterWave>(table);
        if (wave.direction.y() != 0.0) table.require("direction").fail("must be horizontal: y must be 0");
        steepness += wave.height / wave.length;
        if (steepness > steepest)
            table.require("height").origin().fail(fmt::format(
                "makes a wave that breaks: the sum of height / length of all waves must be at most 1/7 (given {:.4g})",
                steepness));
        waves.push_back(wave);
    }
    if (waves.size() > limits::waves)
        list.fail(fmt::format("must have at most {} waves, not {}", limits::waves, waves.size()));
    return waves;
}

}  // namespace

std::optional<WaterDescription> read_water(const TomlTable& root, const SimulationSettings& simulation) {
    const auto table = root.find_table("water");
    if (!table) return std::nullopt;
    const TomlValue value = *root.find("water");
    if (simulation.method == SimulationMethod::notes)
        value.origin().fail("is unknown to the method of the notes: give method = \"tumble\"");
    const Vec3& g = simulation.gravity;
    if (g.x() != 0.0 || g.z() != 0.0 || g.y() > 0.0)
        value.origin().fail(fmt::format("needs gravity along -y, or none: its surface is level (given [{}, {}, {}])",
                                        g.x(), g.y(), g.z()));
    auto water = read_all_fields<WaterDescription>(*table);
    if (water.current.y() != 0.0) table->require("current").fail("must be horizontal: y must be 0");
    if (const auto waves = table->find("waves")) {
        water.waves = read_waves(*waves);
        if (!water.waves.empty() && g.y() == 0.0) waves->fail("need gravity: without it nothing drives them");
    }
    return water;
}

}  // namespace tumble
