#include "app/page/live_controls.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "scene/load.h"
#include "scene/toml/set_values.h"
#include "scene/toml/toml_reader.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

constexpr int most_places = 12;            // of decimal text
constexpr double steps_of_a_range = 40.0;  // about: a step is 1, 2 or 5 times a power of ten

[[noreturn]] void fail(const std::string& key, const std::string& problem) {
    throw InputError(fmt::format("--live {}: {}", safe_text(key), problem));
}

/// Without exponent.
std::string decimal(double value) {
    std::string text = fmt::format("{:.{}f}", value, most_places);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text == "-0" ? "0" : text;
}

bool is_decimal(std::string_view text) {
    if (text.starts_with('-')) text.remove_prefix(1);
    const auto digits = std::ranges::count_if(text, [](char c) { return c >= '0' && c <= '9'; });
    const auto points = std::ranges::count(text, '.');
    return digits > 0 && points <= 1 && std::size_t(digits + points) == text.size() && text.size() <= 2 * most_places;
}

std::vector<std::string> split(std::string_view text, char at) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(at, begin), text.size());
        parts.emplace_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

/// 1, 2 or 5 times a power of ten.
double round_step(double step) {
    const double power = std::pow(10.0, std::floor(std::log10(step)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (step <= factor * power * (1.0 + 1e-9)) return factor * power;
    return 10.0 * power;
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 14> units{{
    {"gravity", "m/s²"},
    {"mass", "kg"},
    {"density", "kg/m³"},
    {"step", "s"},
    {"duration", "s"},
    {"velocity", "m/s"},
    {"radius", "m"},
    {"height", "m"},
    {"position", "m"},
    {"size", "m"},
    {"stiffness", "N/m"},
    {"damping", "N s/m"},
    {"length", "m"},
    {"angular_velocity", "rad/s"},
}};

struct KeyWords {
    std::string name, part, owner;  // "gravity", "y"; "restitution", "", "ball"
};

KeyWords words_of(const std::string& key) {
    std::vector<std::string> path = split(key, '.');
    KeyWords words;
    if (path.size() > 1 && path.back().size() == 1 && path.back()[0] >= '0' && path.back()[0] <= '2') {
        words.part = std::string(1, "xyz"[path.back()[0] - '0']);
        path.pop_back();
    }
    words.name = path.back();
    if (path.size() > 2 && path.front() != "simulation") words.owner = path[1];
    return words;
}

void name_control(LiveControl& control) {
    const KeyWords words = words_of(control.key);
    if (control.label.empty()) {
        control.label = words.name;
        std::ranges::replace(control.label, '_', ' ');
        if (!words.part.empty()) control.label += ", " + words.part;
        if (!words.owner.empty()) control.label += " of " + words.owner;
    }
    const auto unit = std::ranges::find(units, words.name, [](const auto& pair) { return pair.first; });
    if (control.unit.empty() && control.choices.empty() && unit != units.end()) control.unit = unit->second;
}

class SceneCheck {
public:
    SceneCheck(const std::string& text, const std::filesystem::path& file, const SceneOverrides& overrides)
        : text_(text), file_(file), overrides_(overrides) {}

    std::optional<SetValue> value(const std::string& key) const {
        toml::table document = parse_toml(text_, file_.string());
        set_values(document, overrides_.set);
        try {
            return value_of_path(document, key);
        } catch (const InputError& error) {
            const std::string& message = error.message();
            fail(key, message.substr(std::min(message.find(": ") + 2, message.size())));
        }
    }
    /// The reason why the scene is not valid with that value.
    std::optional<std::string> problem(const std::string& key, const std::string& value) const {
        SceneOverrides changed = overrides_;
        changed.set.push_back(key + "=" + value);
        try {
            parse_scene(text_, file_, changed, nullptr, MeshImports::refused);
        } catch (const InputError& error) {
            return error.message();
        }
        return std::nullopt;
    }

private:
    const std::string& text_;
    const std::filesystem::path& file_;
    const SceneOverrides& overrides_;
};

/// A range around the value of the scene: from 0, or near it, to its double; to 1 where the double is not valid.
void make_range(LiveControl& control, double value, const SceneCheck& check) {
    const auto valid = [&](double end) { return !check.problem(control.key, decimal(end)); };
    if (value == 0.0) fail(control.key, "is 0 in the scene: give its range, as KEY=MIN:MAX:STEP");
    const double step = round_step(2.0 * std::fabs(value) / steps_of_a_range);
    const double sign = value < 0.0 ? -1.0 : 1.0, near = sign * step;
    double far = sign * step * std::round(2.0 * std::fabs(value) / step);
    if (!valid(far)) far = valid(sign) ? sign : value;
    const double low = valid(0.0) ? 0.0 : near;
    control.step = decimal(step);
    control.min = decimal(std::min(low, far));
    control.max = decimal(std::max(low, far));
}

}  // namespace

LiveControl parse_live_control(const std::string& text) {
    LiveControl control;
    const std::size_t equals = text.find('=');
    control.key = text.substr(0, equals);
    if (control.key.empty()) fail(text, "has no key; write KEY, KEY=MIN:MAX:STEP or KEY=VALUE,VALUE");
    if (equals == std::string::npos) return control;
    const std::string values = text.substr(equals + 1);
    if (const std::vector<std::string> range = split(values, ':'); range.size() == 3) {
        control.min = range[0], control.max = range[1], control.step = range[2];
        return control;
    }
    control.choices = split(values, ',');
    if (control.choices.size() < 2 || std::ranges::count(control.choices, "") > 0)
        fail(text, "must be a range MIN:MAX:STEP, or two values or more, separated by commas");
    return control;
}

void complete_live_controls(std::span<LiveControl> controls, const std::string& scene_text,
                            const std::filesystem::path& file, const SceneOverrides& overrides) {
    const SceneCheck check(scene_text, file, overrides);
    for (LiveControl& control : controls) {
        const std::optional<SetValue> value = check.value(control.key);
        if (value) control.value = value->number ? decimal(*value->number) : value->text;
        if (control.choices.empty() && control.min.empty()) {
            if (!value) fail(control.key, "is not in the scene: give its range, as KEY=MIN:MAX:STEP, or its values");
            if (value->number)
                make_range(control, *value->number, check);
            else if (value->text == "true" || value->text == "false")
                control.choices = {"false", "true"};
            else
                fail(control.key, "is a text: give its values, as KEY=VALUE,VALUE");
        }
        std::vector<std::string> tried = control.choices;
        if (tried.empty()) {
            for (const std::string& text : {control.min, control.max, control.step})
                if (!is_decimal(text))
                    fail(control.key,
                         fmt::format("a range has decimal numbers, as in 0:1:0.05 (given \"{}\")", safe_text(text)));
            if (std::stod(control.min) >= std::stod(control.max) || std::stod(control.step) <= 0.0)
                fail(control.key, fmt::format("a range goes up, by a step above 0 (given {}:{}:{})", control.min,
                                              control.max, control.step));
            tried = {control.min, control.max};
        }
        for (const std::string& each : tried)
            if (const auto problem = check.problem(control.key, each))
                fail(control.key, fmt::format("the scene is not valid with {}: {}", safe_text(each), *problem));
        name_control(control);
    }
}

std::string live_json(const LivePage& page) {
    Json controls = Json::array();
    for (const LiveControl& control : page.controls) {
        Json json{{"key", control.key}, {"label", control.label}, {"unit", control.unit}};
        if (control.choices.empty())
            json.update({{"min", control.min}, {"max", control.max}, {"step", control.step}});
        else
            json["choices"] = control.choices;
        if (!control.value.empty()) json["value"] = control.value;
        controls.push_back(std::move(json));
    }
    return Json{{"name", page.name},
                {"source", page.source},
                {"settings", page.settings},
                {"controls", std::move(controls)},
                {"editor", page.editor}}
        .dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace tumble
