#include "app/golden/suite.h"

#include "core/check.h"
#include "core/frame_rate.h"
#include "scene/toml/toml_reader.h"
#include "scene/toml/toml_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t suite_bytes = 4 << 20;  // ten thousand cases
constexpr const char* default_references = "references";

void check_format(const TomlTable& root) {
    const auto format = root.find("format");
    if (!format) throw InputError(root.origin().where, "a suite starts with \"format = 1\" (not given)");
    if (format->integer(INT64_MIN, INT64_MAX) != 1) format->fail("must be 1, the only one there is");
}

/// Two cases must not have one reference. Names are compared without case: some file systems do not keep it.
void check_names(const std::vector<GoldenCase>& cases) {
    std::set<std::string> seen;
    for (const GoldenCase& golden : cases) {
        std::string name = golden.name;
        std::ranges::transform(name, name.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
        if (!seen.insert(name).second)
            throw InputError(golden.place_of("name"),
                             fmt::format("there is another case \"{}\"; give each a name of its own", golden.name));
    }
}

/// The key of a case that an option of the command line stands for: "--plot-place" is "plot_place".
std::string key_of_option(std::string_view option) {
    std::string key(option);
    std::ranges::replace(key, '-', '_');
    return key == "frames_range" ? "frames" : key;
}

}  // namespace

const SourceLocation& GoldenCase::place_of(std::string_view key) const {
    const auto place = places.find(key);
    return place == places.end() ? where : place->second;
}

std::string GoldenCase::image_name(std::int64_t frame) const { return fmt::format("{}_{:06}.png", name, frame); }

const GoldenCase* GoldenSuite::find(std::string_view name) const {
    const auto found = std::ranges::find(cases, name, &GoldenCase::name);
    return found == cases.end() ? nullptr : &*found;
}

const Tolerances& GoldenSuite::tolerances_of(const GoldenCase& golden) const {
    return golden.tolerances ? *golden.tolerances : tolerances;
}

PairTolerances GoldenSuite::tolerances_of(const std::string& image) const {
    const GoldenCase* const golden = find(std::string_view(image).substr(0, image.rfind('_')));
    TUMBLE_CHECK_EQ(golden != nullptr, true);
    return tolerances_of(*golden).of(image);
}

GoldenSuite parse_suite(const std::string& text, const fs::path& file) {
    const toml::table document = parse_toml(text, file.string());
    const TomlTable root(document, {"suite", {file.string(), 1, 1}}, "a suite");
    check_format(root);
    root.expect_keys({"format", "references", "tolerances", "defaults", "case"});
    GoldenSuite suite;
    suite.file = file;
    std::string references = default_references;
    root.read("references", references);
    suite.references = (file.parent_path() / references).lexically_normal();
    if (const auto tolerances = root.find("tolerances"))
        suite.tolerances = read_tolerances(*tolerances, file.parent_path());
    const std::optional<TomlTable> defaults = root.find_table("defaults");
    if (defaults) check_default_keys(*defaults);
    if (const auto cases = root.find("case"))
        for (TomlTable& one : cases->tables("; write [[case]] above the keys of each")) {
            one.set_title("a case");
            suite.cases.push_back(read_case(one, defaults, suite));
        }
    if (suite.cases.empty())
        throw InputError(root.origin().where, "a suite needs a case: [[case]] with scene = \"FILE\" (not given)");
    check_names(suite.cases);
    return suite;
}

std::string read_suite_text(const fs::path& file) { return read_toml_file(file, "suite", suite_bytes); }

GoldenSuite load_suite(const fs::path& file) { return parse_suite(read_suite_text(file), file); }

void with_place_of(const GoldenCase& golden, const std::function<void()>& action) {
    try {
        action();
    } catch (const InputError& error) {
        if (!error.where().file.empty()) throw;
        const std::string& text = error.message();
        if (!text.starts_with("--")) throw InputError(golden.where, text);
        const std::size_t end = std::min(text.find_first_of(" :="), text.size());
        const std::string key = key_of_option(text.substr(2, end - 2));
        throw InputError(golden.place_of(key), key + text.substr(end));
    }
}

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
