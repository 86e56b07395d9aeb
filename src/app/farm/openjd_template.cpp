#include "app/farm/openjd_template.h"

#include "app/farm/shell_text.h"
#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <set>

namespace tumble {
namespace {

namespace fs = std::filesystem;
using TemplateJson = nlohmann::ordered_json;

// Limits of the specification (2023-09).
constexpr std::size_t most_parameters = 50, longest_value = 1024;
constexpr int notice_seconds = 120;  // between SIGTERM, after which a run ends by itself, and SIGKILL

/// A word of a command line that holds no parameter. The format has no escape for the braces, and no control characters.
std::string literal_word(const std::string& word) {
    if (word.find("{{") != std::string::npos || word.find("}}") != std::string::npos || has_control_characters(word))
        throw InputError(
            fmt::format("an OpenJD template cannot hold double braces or control characters in an option (was '{}'); "
                        "write braces with a "
                        "space between, or put the value into the scene file",
                        safe_text(word)));
    return word;
}

TemplateJson template_parameter(const char* name, const char* type, const std::string& description) {
    TemplateJson json;
    json["name"] = name;
    json["type"] = type;
    json["description"] = description;
    return json;
}

/// The default of a PATH parameter: submitters take paths inside the template's folder only, relative to it.
std::optional<std::string> default_path(const fs::path& path, const fs::path& template_folder) {
    const fs::path relative = path.lexically_relative(template_folder);
    if (relative.empty() || *relative.begin() == ".." || relative.string().size() > longest_value) return std::nullopt;
    return relative.string();
}

TemplateJson input_parameter(const std::string& name, const std::string& description, const fs::path& path,
                             const fs::path& template_folder) {
    TemplateJson json = template_parameter(name.c_str(), "PATH", description);
    json["objectType"] = "FILE";
    json["dataFlow"] = "IN";
    if (const auto value = default_path(path, template_folder)) json["default"] = *value;
    return json;
}

/// The name of a scene's parameter.
std::string scene_name(std::size_t index) { return index == 0 ? "Scene" : fmt::format("Scene{}", index + 1); }

TemplateJson template_parameters(const FarmJob& job, const fs::path& template_folder) {
    TemplateJson list;
    for (std::size_t i = 0; i < job.scenes.size(); ++i)
        list.push_back(input_parameter(scene_name(i), "A scene file (TOML)", job.scenes[i], template_folder));
    TemplateJson folder =
        template_parameter("OutputFolder", "PATH", "Folder of the checkpoints, the frames and the clip");
    folder["objectType"] = "DIRECTORY";
    folder["dataFlow"] = "INOUT";
    list.push_back(folder);
    TemplateJson clip =
        template_parameter("Clip", "STRING", "Name of the clip in the output folder: .mp4 .mov .mkv .webm or .gif");
    clip["default"] = literal_word(job.clip.filename().string());
    clip["minLength"] = 1;
    list.push_back(clip);
    TemplateJson frames = template_parameter("Frames", "STRING", "Frames to draw; the clip needs all of them");
    frames["default"] = fmt::format("0-{}", job.frames - 1);
    frames["minLength"] = 1;
    list.push_back(frames);
    TemplateJson chunk = template_parameter("ChunkSize", "INT", "Frames that a task draws");
    chunk["default"] = job.parts.front().count();
    chunk["minValue"] = 1;
    list.push_back(chunk);
    TemplateJson program = template_parameter("Tumble", "STRING", "The tumble program on the workers");
    program["default"] = job.program;
    program["minLength"] = 1;
    list.push_back(program);
    return list;
}

/// Parameters that no command reads: they name the scene's meshes to submitters that copy inputs to the workers.
void add_meshes(TemplateJson& list, const FarmJob& job, const fs::path& template_folder) {
    const bool each = job.meshes.size() <= most_parameters - list.size();
    std::set<fs::path> paths;
    for (const fs::path& mesh : job.meshes) paths.insert(each ? mesh : mesh.parent_path());
    int number = 0;
    for (const fs::path& path : paths) {
        if (!default_path(path, template_folder) || list.size() == most_parameters) continue;
        TemplateJson json =
            input_parameter(fmt::format("Mesh{}", ++number), each ? "A mesh of the scene" : "Meshes of the scene", path,
                            template_folder);
        if (!each) json["objectType"] = "DIRECTORY";
        json["userInterface"] = {{"control", "HIDDEN"}};
        list.push_back(json);
    }
}

/// A task that runs a command of the program on the scenes (or on none) with these options.
TemplateJson template_script(const std::string& command, std::size_t scenes, const std::vector<std::string>& options,
                             const std::vector<std::string>& outputs) {
    std::vector<std::string> words{command};
    for (std::size_t i = 0; i < scenes; ++i) words.push_back(fmt::format("{{{{Param.{}}}}}", scene_name(i)));
    for (const std::string& option : options) words.push_back(literal_word(option));
    words.push_back("--quiet");
    words.insert(words.end(), outputs.begin(), outputs.end());
    TemplateJson run;
    run["command"] = "{{Param.Tumble}}";
    run["args"] = words;
    run["cancelation"] = {{"mode", "NOTIFY_THEN_TERMINATE"}, {"notifyPeriodInSeconds", notice_seconds}};
    return {{"actions", {{"onRun", run}}}};
}

TemplateJson template_step(const char* name, const char* after, const TemplateJson& script) {
    TemplateJson json;
    json["name"] = name;
    if (after != nullptr) json["dependencies"] = TemplateJson::array({{{"dependsOn", after}}});
    json["script"] = script;
    return json;
}

TemplateJson chunks_of_frames() {
    TemplateJson frame;
    frame["name"] = "Frame";
    frame["type"] = "CHUNK[INT]";
    frame["range"] = "{{Param.Frames}}";
    frame["chunks"] = {{"defaultTaskCount", "{{Param.ChunkSize}}"}, {"rangeConstraint", "CONTIGUOUS"}};
    return {{"taskParameterDefinitions", TemplateJson::array({frame})}};
}

}  // namespace

std::string openjd_template(const FarmJob& job, const fs::path& file) {
    const fs::path template_folder = file.parent_path();
    const std::string checkpoints = "{{Param.OutputFolder}}/checkpoints", frames = "{{Param.OutputFolder}}/frames";
    TemplateJson json;
    json["specificationVersion"] = "jobtemplate-2023-09";
    json["extensions"] = {"TASK_CHUNKING"};
    json["name"] = "{{Param.Clip}}";
    json["description"] =
        "Simulates a scene, draws its frames by chunks, and makes the clip. Written by tumble farm openjd.";
    json["parameterDefinitions"] = template_parameters(job, template_folder);
    add_meshes(json["parameterDefinitions"], job, template_folder);
    const std::size_t scenes = job.scenes.size();
    const std::vector<std::string> states{"--checkpoints", checkpoints, "--every",
                                          fmt::format("{}", job.checkpoint_period)};
    json["steps"].push_back(
        template_step("Simulate", nullptr, template_script("simulate", scenes, job.simulate_options, states)));
    TemplateJson render = template_step("Render", "Simulate",
                                        template_script("render", scenes, job.render_options,
                                                        {"--frames", frames, "--frames-range", "{{Task.Param.Frame}}",
                                                         "--from-checkpoints", checkpoints, "--resume"}));
    render["parameterSpace"] = chunks_of_frames();
    json["steps"].push_back(render);
    const std::string clip = "{{Param.OutputFolder}}/{{Param.Clip}}";
    json["steps"].push_back(
        template_step("Stitch", "Render", template_script("encode", 0, job.encode_options, {frames, "-o", clip})));
    return json.dump(2, ' ', false, TemplateJson::error_handler_t::replace) + "\n";
}

}  // namespace tumble
