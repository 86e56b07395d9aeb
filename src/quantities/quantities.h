// Quantities of a run that plots can show, by the names of --of: sums over the scene, and values of a body or a joint.
#pragma once

#include "quantities/survey_frame.h"
#include "scene/description/description.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// A run at one frame time.
struct Sample {
    const Snapshot& snapshot;
    const Survey& survey;  // with the needs of the quantities
};

struct Quantity {
    std::string name;   // as in the list: "body.ball.y"
    std::string label;  // for its line: "kinetic", "ball"
    std::string panel;  // quantities with the same text share a panel; it is the panel's title, with the unit
    std::function<double(const Sample&)> value;
    SurveyNeeds needs;
    bool of_part = false;        // of a body or a joint, which its label names
    bool mean_of_frame = false;  // over the frame that ends at the time; nothing ends at the first one
};

/// The quantities of a list separated by commas: "energy,body.ball.y". Throws InputError for an unknown name, body or
/// joint, with the nearest known one, and for a locked coordinate.
std::vector<Quantity> parse_quantities(std::string_view list, const SceneDescription& scene);

/// The names for the help, a line for each kind.
std::string quantity_help();

}  // namespace tumble
