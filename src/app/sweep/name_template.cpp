#include "app/sweep/sweep_sample.h"

#include "app/sweep/manifest.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "scene/toml/error_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace tumble {
namespace {

constexpr std::size_t longest_part = 200;  // bytes of a folder's name: file systems have 255
constexpr int most_digits = 18;

struct Field {
    std::string name;
    int digits = 0;  // of a number, with zeros in front
};

[[noreturn]] void fail(std::string_view problem) { throw InputError(std::string(problem)); }

Field read_field(std::string_view text) {
    const std::size_t colon = text.find(':');
    Field field{std::string(text.substr(0, colon)), 0};
    if (colon == std::string_view::npos) return field;
    const std::string_view digits = text.substr(colon + 1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), field.digits);
    if (error != std::errc() || end != digits.data() + digits.size() || field.digits < 1 || field.digits > most_digits)
        fail(fmt::format("has a field with the format \"{}\": a number of digits such as 06 is possible",
                         safe_text(digits)));
    return field;
}

/// The text with each field replaced.
std::string filled(std::string_view text, const std::function<std::string(const Field&)>& value) {
    std::string name;
    while (!text.empty()) {
        const std::size_t open = text.find_first_of("{}");
        name += text.substr(0, open);
        if (open == std::string_view::npos) break;
        const std::size_t close = text.find('}', open);
        if (text[open] == '}' || close == std::string_view::npos) fail("has a brace without its other half");
        name += value(read_field(text.substr(open + 1, close - open - 1)));
        text.remove_prefix(close + 1);
    }
    return name;
}

std::string number_with(std::int64_t number, int digits) { return fmt::format("{:0{}}", number, std::max(digits, 1)); }

/// A value without what file systems, shells and this path may give another meaning.
std::string plain_value(std::string_view value) {
    if (value.size() >= 2 && value.front() == '"') value = value.substr(1, value.size() - 2);
    std::string text;
    for (const char c : value) {
        const bool kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                          c == '+' || c == '-' || c == '_';
        text += kept ? c : '_';
    }
    return text;
}

void check_path(const std::string& name) {
    const std::filesystem::path path(name);
    if (name.empty() || path.is_absolute() || name.back() == '/') fail("must be a relative path of a folder");
    if (name.find("//") != std::string::npos) fail("must have no empty part");
    for (const auto& part : path) {
        const std::string text = part.string();
        if (text.front() == '.') fail("must have no part that begins with a dot");
        if (text.size() > longest_part) fail(fmt::format("gives a name of more than {} bytes", longest_part));
    }
    if (has_control_characters(name)) fail("must have no control characters");
    if (*path.begin() == ManifestFile::path_in({})) fail("must not be in the place of the manifest of the sweep");
}

}  // namespace

void check_name_template(const SweepPlan& plan) {
    std::vector<std::string_view> known{"index"};
    if (plan.pair) known.insert(known.end(), {"pair", "side"});
    for (const SweepAxis& axis : plan.axes) known.push_back(axis.name);
    const std::string example = filled(plan.name, [&](const Field& field) {
        if (std::find(known.begin(), known.end(), field.name) == known.end())
            fail(fmt::format("has the unknown field \"{}\"{}", safe_text(field.name), suggestion(field.name, known)));
        return std::string("0");
    });
    check_path(example);
}

std::string name_of_sample(const SweepPlan& plan, const SweepSample& sample) {
    std::string name = filled(plan.name, [&](const Field& field) -> std::string {
        if (field.name == "index") return number_with(sample.index, field.digits);
        if (sample.pair && field.name == "pair") return number_with(sample.pair->pair, field.digits);
        if (sample.pair && field.name == "side") return {sample.pair->side};
        for (std::size_t i = 0; i < plan.axes.size(); ++i)
            if (plan.axes[i].name == field.name) return plain_value(sample.values[i]);
        return {};
    });
    try {
        check_path(name);
    } catch (const InputError& error) {
        fail(fmt::format("name \"{}\" {} (sample {}: {})", safe_text(name), error.message(), sample.index,
                         sample.text(plan)));
    }
    return name;
}

bool names_each_index(const SweepPlan& plan) {
    bool index = false, pair = false, side = false;
    filled(plan.name, [&](const Field& field) {
        index = index || field.name == "index";
        pair = pair || field.name == "pair";
        side = side || field.name == "side";
        return std::string();
    });
    return index || (pair && side);
}

}  // namespace tumble
