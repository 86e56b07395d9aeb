#include "app/golden/suite.h"

#include "app/golden/case_keys.h"
#include "core/check.h"
#include "scene/toml/toml_file.h"
#include "scene/toml/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

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

}  // namespace tumble
