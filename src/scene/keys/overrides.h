// Values of the command line that override the scene file's.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Overrides by the command line. Each is checked like the file's own value; an error names the option ("--fps: ...").
struct SceneOverrides {
    std::optional<double> duration, fps, step;
    std::optional<int> steps_per_frame, width, height, samples;
    std::vector<std::string> set;  // "PATH=VALUE", applied to the parsed file (toml/set_values.h)
    std::optional<std::string> method, integrator, impacts, impact_law;
    std::optional<std::string> overlay, plot, plot_place, camera;
};

}  // namespace tumble
