// Quantities of a run that plots can show, by the names of --of: sums over the scene, and values of one body.
#pragma once

#include "scene/description/description.h"
#include "sim/snapshot/report.h"
#include "sim/snapshot/snapshot.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// A run at one frame time.
struct Sample {
    const Snapshot& snapshot;
    const Measurement& measurement;  // empty unless a quantity needs it
};

struct Quantity {
    std::string label;  // for its line: "kinetic", "ball"
    std::string panel;  // quantities with the same text share a panel; it is the panel's title, with the unit
    std::function<double(const Sample&)> value;
    bool needs_measurement = false;
};

/// The quantities of a list separated by commas: "energy,body.ball.y". Throws InputError for an unknown name or body,
/// with the nearest known one.
std::vector<Quantity> parse_quantities(std::string_view list, const SceneDescription& scene);

/// The names for the help, a line for each kind.
std::string quantity_help();

}  // namespace tumble
