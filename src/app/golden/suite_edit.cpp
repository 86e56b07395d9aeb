#include "app/golden/suite_edit.h"

#include "core/frame_rate.h"
#include "scene/toml/toml_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr const char* new_suite = "format = 1\nreferences = \"references\"   # folder of the accepted images\n";

std::string text_of(const fs::path& file) {
    std::error_code error;
    if (!fs::exists(file, error)) return new_suite;
    std::string text = read_suite_text(file);
    parse_suite(text, file);  // its mistakes have the places of the file
    if (!text.empty() && text.back() != '\n') text += '\n';
    return text;
}

/// A fraction is a text in TOML.
std::string rate_value(double fps) {
    const std::string text = fps_text(fps);
    return text.find('/') == std::string::npos ? text : toml_string(text);
}

std::string case_text(const NewCase& added, const fs::path& suite) {
    std::error_code error;
    const fs::path folder = suite.has_parent_path() ? suite.parent_path() : fs::path(".");
    fs::path scene = added.scene.is_absolute() ? added.scene : fs::relative(added.scene, folder, error);
    if (error || scene.empty()) scene = fs::absolute(added.scene);
    std::string text = "\n[[case]]\n";
    const auto add = [&](const char* key, const std::string& value) { text += fmt::format("{} = {}\n", key, value); };
    if (added.name) add("name", toml_string(*added.name));
    add("scene", toml_string(scene.generic_string()));
    if (!added.frames.empty()) add("frames", fmt::format("[{}]", fmt::join(added.frames, ", ")));
    const SceneOverrides& o = added.overrides;
    if (o.width && o.height) add("size", fmt::format("[{}, {}]", *o.width, *o.height));
    if (o.fps) add("fps", rate_value(*o.fps));
    if (o.duration) add("duration", fmt::format("{}", *o.duration));
    if (o.samples) add("samples", fmt::format("{}", *o.samples));
    if (o.method) add("method", toml_string(*o.method));
    if (o.overlay) add("overlay", toml_string(*o.overlay));
    if (o.plot) add("plot", toml_string(*o.plot));
    if (o.plot_place) add("plot_place", toml_string(*o.plot_place));
    if (!o.set.empty()) {
        std::vector<std::string> values;
        for (const std::string& value : o.set) values.push_back(toml_string(value));
        add("set", fmt::format("[{}]", fmt::join(values, ", ")));
    }
    if (added.transparent) add("transparent", "true");
    return text;
}

}  // namespace

std::string suite_text_with(const fs::path& suite, const NewCase& added) {
    const std::string text = text_of(suite) + case_text(added, suite);
    parse_suite(text, suite);
    return text;
}

}  // namespace tumble
