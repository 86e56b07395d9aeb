// `tumble render`: its values, and the options of a clip that other commands have as well.
#pragma once

#include "app/clip/clip_request.h"
#include "output/video_format.h"
#include "render/renderer.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct RenderCommand : ClipRequest {
    std::optional<std::filesystem::path> clip;           // without this, frames and AOVs: the first scene's name
    std::optional<std::filesystem::path> frames;         // folder
    std::optional<std::filesystem::path> report;         // .html
    std::optional<std::filesystem::path> profile;        // .json
    std::optional<std::filesystem::path> motion_record;  // .json (app/causes)
    std::optional<std::filesystem::path> aov_folder;     // instead of the frames' folder
    RenderOptions drawing;
    ClipOptions clip_options{FrameTimes::constant_rate, VideoQuality::normal};
    bool resume = false;  // keeps finished frames of the same clip
    std::string call;     // the command as it was typed, for messages
    // folder; otherwise the frames before the first are simulated
    std::optional<std::filesystem::path> from_checkpoints;
    double shutter = 0.0;  // degrees: 360 is always open, 0 a single moment
    int blur_samples = 8;  // images per frame while the shutter is open
    // of the simulation; see simulation_threads_beside_drawing()
    std::optional<int> threads;
    int workers = 1;  // render processes
    bool quiet = false;
};

/// All options of `render`.
void add_render_options(CLI::App& command, RenderCommand& c);
/// --vary and --layout; `what` as in add_vary().
void add_panels(CLI::App& command, RenderCommand& clip, const std::string& what);
/// --overlay, --plot and --plot-place.
void add_text(CLI::App& command, SceneOverrides& overrides);
/// --speed, --shutter and --blur-samples.
void add_clip_times(CLI::App& command, RenderCommand& clip);

// -- --camera all: a render for each camera of a scene.

/// The command, or with --camera all one for [camera] and one for each of [cameras], in the order of their names. Each
/// writes into a folder of its camera's name inside the folders of the command. Throws InputError for outputs that can
/// hold one camera only.
std::vector<RenderCommand> of_each_camera(const RenderCommand& command);

}  // namespace tumble
