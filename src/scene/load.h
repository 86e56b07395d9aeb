// From a scene file to a checked description: parse, check, resolve.
#pragma once

#include "scene/description/description.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// What the command line may say in place of the file. Each is checked like the file's own value;
/// an error names the option ("--fps: ...").
struct SceneOverrides {
    std::optional<double> duration, fps, step;
    std::optional<int> steps_per_frame, width, height, samples;
    std::optional<std::string> integrator, impacts, impact_law;
};

using FileList = std::vector<std::filesystem::path>;

/// Throws InputError with file, line and column for anything the format forbids: nothing is guessed.
/// The files that were read are appended to `read`, where that is given: the scene's own and those of its meshes.
SceneDescription load_scene(const std::filesystem::path& file, const SceneOverrides& overrides = {},
                            FileList* read = nullptr);

/// The same from text, for tests; relative mesh paths are resolved against the folder of `file`.
SceneDescription parse_scene(const std::string& text, const std::filesystem::path& file,
                             const SceneOverrides& overrides = {}, FileList* read = nullptr);

}  // namespace tumble
