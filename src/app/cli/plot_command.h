// `tumble plot`: golden cases are drawn by it as well.
#pragma once

#include "scene/keys/overrides.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct PlotCommand {
    std::vector<std::filesystem::path> scenes;
    std::string quantities;                              // names separated by commas (quantities/quantities.h)
    std::filesystem::path output;                        // .svg, .png or .pdf
    std::optional<std::filesystem::path> motion_record;  // .json (app/causes)
    std::vector<std::string> vary;                       // "PATH=VALUE,VALUE"
    SceneOverrides overrides;
    std::optional<std::string> title;  // without this, the first scene's
    bool log = false;                  // logarithmic vertical axes
    bool difference = false;           // of each run to the first one
    int width = 900, height = 540;     // pixels, or points of a PDF
    int threads = 1;
    bool quiet = false;
};

void run_plot(const PlotCommand& command);

}  // namespace tumble
