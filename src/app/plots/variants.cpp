#include "app/plots/variants.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
namespace {

struct Varied {
    std::string path;
    std::vector<std::string> values;
    std::string key() const { return path.substr(path.rfind('.') + 1); }
};

std::vector<std::string> split_values(std::string_view text) {
    std::vector<std::string> values(1);
    int depth = 0;
    char quote = 0;
    for (const char c : text) {
        if (quote != 0) {
            if (c == quote) quote = 0;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '[' || c == '{') {
            ++depth;
        } else if (c == ']' || c == '}') {
            --depth;
        } else if (c == ',' && depth == 0) {
            values.emplace_back();
            continue;
        }
        values.back() += c;
    }
    return values;
}

Varied parse(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        throw InputError(
            fmt::format("--vary {}: has no values; write PATH=VALUE,VALUE, as in simulation.integrator=rk4,exact",
                        safe_text(text)));
    return {text.substr(0, equals), split_values(std::string_view(text).substr(equals + 1))};
}

/// True for a word that tells its meaning, unlike a number or a truth value.
bool is_name(const std::string& value) {
    const char first = value.find_first_of("\"'") == 0 && value.size() > 1 ? value[1] : value[0];
    return ((first >= 'a' && first <= 'z') || (first >= 'A' && first <= 'Z')) && value != "true" && value != "false" &&
           value != "inf" && value != "nan";
}

/// The name of the file; with its folder if another scene's file has the same name.
std::string label_among(std::span<const std::filesystem::path> scenes, const std::filesystem::path& scene) {
    const auto same = std::ranges::count_if(scenes, [&](const auto& other) { return other.stem() == scene.stem(); });
    const std::string folder = scene.parent_path().filename().string();
    return same > 1 && !folder.empty() ? fmt::format("{}/{}", folder, scene.stem().string()) : scene.stem().string();
}

}  // namespace

std::vector<Variant> make_variants(std::span<const std::filesystem::path> scenes, const SceneOverrides& overrides,
                                   std::span<const std::string> vary) {
    std::vector<Varied> varied;
    for (const std::string& text : vary) varied.push_back(parse(text));
    std::vector<Variant> variants;
    for (const auto& scene : scenes)
        variants.push_back({scene, overrides, scenes.size() > 1 ? label_among(scenes, scene) : std::string()});
    for (const Varied& one : varied) {
        std::vector<Variant> more;
        for (const Variant& base : variants)
            for (const std::string& value : one.values) {
                const bool with_key = varied.size() > 1 || !is_name(value);
                Variant variant = base;
                variant.overrides.set.push_back(one.path + "=" + value);
                if (!variant.label.empty()) variant.label += ", ";
                variant.label += with_key ? fmt::format("{} {}", one.key(), value) : value;
                more.push_back(std::move(variant));
            }
        variants = std::move(more);
    }
    return variants;
}

void label_variants(std::vector<Variant>& variants, std::span<const std::string> labels) {
    if (labels.empty()) return;
    if (labels.size() != variants.size())
        throw InputError(fmt::format("needs one label for each run (given {} for {})", labels.size(), variants.size()));
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (labels[i].empty() || std::ranges::find(labels.subspan(i + 1), labels[i]) != labels.end())
            throw InputError(fmt::format("labels tell runs apart (given '{}' {})", safe_text(labels[i]),
                                         labels[i].empty() ? "without a letter" : "twice"));
        variants[i].label = labels[i];
    }
}

}  // namespace tumble
