#include "app/farm/farm_job.h"

#include "app/farm/farm_templates.h"
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

/// A word of a command line that holds no parameter. The format has no escape for the braces, and no control
/// characters.
std::string literal_word(const std::string& word) {
    if (word.find("{{") != std::string::npos || word.find("}}") != std::string::npos || has_control_characters(word))
        throw InputError(
            fmt::format("an OpenJD template cannot hold double braces or control characters in an option (was '{}'); "
                        "write braces with a "
                        "space between, or put the value into the scene file",
                        safe_text(word)));
    return word;
}

/// The default of a PATH parameter: submitters take paths inside the template's folder only, relative to it.
std::optional<std::string> default_path(const fs::path& path, const fs::path& template_folder) {
    const fs::path relative = path.lexically_relative(template_folder);
    if (relative.empty() || *relative.begin() == ".." || relative.string().size() > longest_value) return std::nullopt;
    return relative.string();
}

TemplateJson input_parameter(const std::string& name, const std::string& description, const fs::path& path,
                             const fs::path& template_folder) {
    TemplateJson json = {
        {"name", name}, {"type", "PATH"}, {"description", description}, {"objectType", "FILE"}, {"dataFlow", "IN"}};
    if (const auto value = default_path(path, template_folder)) json["default"] = *value;
    return json;
}

/// The name of a scene's parameter.
std::string scene_name(std::size_t index) { return index == 0 ? "Scene" : fmt::format("Scene{}", index + 1); }

/// The parameters of the scenes before the template's parameters, which get their defaults.
TemplateJson template_parameters(const TemplateJson& others, const FarmJob& job, const fs::path& template_folder) {
    const TemplateJson defaults = {{"Clip", literal_word(job.clip.filename().string())},
                                   {"Frames", fmt::format("0-{}", job.frames - 1)},
                                   {"ChunkSize", job.parts.front().count()},
                                   {"Tumble", job.program}};
    TemplateJson list;
    for (std::size_t i = 0; i < job.scenes.size(); ++i)
        list.push_back(input_parameter(scene_name(i), "A scene file (TOML)", job.scenes[i], template_folder));
    for (TemplateJson parameter : others) {
        if (parameter.contains("default")) parameter["default"] = defaults.at(parameter["name"].get<std::string>());
        list.push_back(std::move(parameter));
    }
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

/// The words of a step's command, with words of the job for their marks.
TemplateJson step_words(const TemplateJson& words, const FarmJob& job, const std::vector<std::string>& options) {
    TemplateJson list;
    for (const TemplateJson& word : words) {
        if (word == "@SCENES@")
            for (std::size_t i = 0; i < job.scenes.size(); ++i)
                list.push_back(fmt::format("{{{{Param.{}}}}}", scene_name(i)));
        else if (word == "@OPTIONS@")
            for (const std::string& option : options) list.push_back(literal_word(option));
        else
            list.push_back(word == "@PERIOD@" ? fmt::format("{}", job.checkpoint_period) : word.get<std::string>());
    }
    return list;
}

}  // namespace

std::string openjd_template(const FarmJob& job, const fs::path& file) {
    TemplateJson json = TemplateJson::parse(farm_template("openjd.json"));
    TemplateJson& parameters = json["parameterDefinitions"];
    parameters = template_parameters(parameters, job, file.parent_path());
    add_meshes(parameters, job, file.parent_path());
    const std::vector<std::string>* const options[] = {&job.simulate_options, &job.render_options, &job.encode_options};
    for (std::size_t i = 0; i < json["steps"].size(); ++i) {
        TemplateJson& words = json["steps"][i]["script"]["actions"]["onRun"]["args"];
        words = step_words(words, job, *options[i]);
    }
    return json.dump(2, ' ', false, TemplateJson::error_handler_t::replace) + "\n";
}

}  // namespace tumble
