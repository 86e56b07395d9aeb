#include "app/cli/every_camera.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "scene/load.h"
#include "scene/toml/set_values.h"
#include "scene/toml/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace tumble {
namespace {

constexpr const char* every = "all";
constexpr const char* own_folder = "camera";  // of [camera]

/// The names of [cameras] in a scene file, sorted.
std::vector<std::string> names_of_cameras(const RenderCommand& command) {
    const std::filesystem::path& file = command.scenes.front();
    toml::table document = parse_toml(read_scene_text(file), file.string());
    set_values(document, command.overrides.set);
    std::vector<std::string> names;
    if (const toml::table* cameras = document["cameras"].as_table())
        for (const auto& [name, value] : *cameras) names.emplace_back(name.str());
    std::ranges::sort(names);
    return names;
}

void check(const RenderCommand& command, const std::vector<std::string>& names) {
    if (command.scenes.size() > 1 || !command.vary.empty())
        throw InputError("--camera all: needs a single scene, without --vary");
    if (!command.frames && !command.aov_folder)
        throw InputError("--camera all: needs --frames or --aov-folder for the folders of the cameras");
    if (command.clip || command.report || command.motion_record || command.profile || command.from_checkpoints)
        throw InputError(
            "--camera all: writes frames and AOVs alone; leave --output, --report, --motion-record, --profile and "
            "--from-checkpoints out, or name one camera");
    for (const std::string& name : names) {
        const bool no_folder = name.empty() || name == "." || name == ".." || name.find('/') != std::string::npos ||
                               name.find('\0') != std::string::npos;
        if (no_folder || name == own_folder)
            throw InputError(
                fmt::format("--camera all: [cameras.\"{}\"] {}; give it another name", safe_text(name),
                            no_folder ? "cannot be the name of a folder" : "would have the folder of [camera]"));
    }
}

}  // namespace

std::vector<RenderCommand> of_each_camera(const RenderCommand& command) {
    if (command.overrides.camera != every) return {command};
    const std::vector<std::string> names = names_of_cameras(command);
    if (std::ranges::find(names, every) != names.end()) return {command};  // a camera of that name
    check(command, names);
    std::vector<RenderCommand> commands;
    const auto add = [&](const std::optional<std::string>& camera, const std::string& folder) {
        RenderCommand& one = commands.emplace_back(command);
        one.overrides.camera = camera;
        if (one.frames) one.frames = *one.frames / folder;
        if (one.aov_folder) one.aov_folder = *one.aov_folder / folder;
    };
    add(std::nullopt, own_folder);
    for (const std::string& name : names) add(name, name);
    return commands;
}

}  // namespace tumble
