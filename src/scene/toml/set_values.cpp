#include "scene/toml/set_values.h"

#include "core/safe_text.h"
#include "scene/toml/error_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <vector>

namespace tumble {
namespace {

constexpr std::string_view option = "--set ";

using Path = std::vector<std::string>;

[[noreturn]] void fail(std::string_view assignment, std::string_view problem) {
    throw InputError(fmt::format("{}{}: {}", option, safe_text(assignment), problem));
}

/// Splits at the dots outside of quotes, up to the '='; returns the rest behind it.
std::string_view split_path(std::string_view assignment, Path& path) {
    std::string key;
    bool quoted = false;
    for (std::size_t i = 0; i < assignment.size(); ++i) {
        const char c = assignment[i];
        if (c == '"') {
            quoted = !quoted;
        } else if (!quoted && (c == '.' || c == '=')) {
            if (key.empty())
                fail(assignment, "has an empty key in its path; write PATH=VALUE, as in simulation.duration=2");
            path.push_back(std::move(key));
            key.clear();
            if (c == '=') return assignment.substr(i + 1);
        } else {
            key += c;
        }
    }
    fail(assignment, "has no value; write PATH=VALUE, as in simulation.duration=2");
}

/// The document "value = ..." with the option as its source; a string if the text is no TOML value.
toml::table parse_value(std::string_view text, const std::string& source) {
    try {
        toml::table parsed = toml::parse(fmt::format("value = {}", text), source);
        if (parsed.size() == 1) return parsed;
    } catch (const toml::parse_error&) {
    }
    toml::table parsed = toml::parse("value = ''", source);
    parsed.get("value")->as_string()->get() = text;
    return parsed;
}

toml::key sourced_key(const std::string& name, const std::string& source) {
    return toml::key(name, toml::source_region{{}, {}, std::make_shared<const std::string>(source)});
}

/// The element of an array of tables: by its name, or by its number.
toml::node& element(toml::array& array, const std::string& key, std::string_view assignment) {
    std::vector<std::string> names;
    for (toml::node& node : array) {
        const toml::table* table = node.as_table();
        const auto name = table ? (*table)["name"].value<std::string>() : std::nullopt;
        if (name && *name == key) return node;
        if (name) names.push_back(*name);
    }
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    if (error == std::errc() && end == key.data() + key.size() && index < array.size()) return *array.get(index);
    const std::vector<std::string_view> known(names.begin(), names.end());
    fail(assignment, fmt::format("there is no element \"{}\" in an array of {}{}", safe_text(key), array.size(),
                                 suggestion(key, known)));
}

void set_value(toml::table& document, std::string_view assignment) {
    Path path;
    const std::string_view text = split_path(assignment, path);
    const std::string source = fmt::format("{}{}", option, assignment.substr(0, assignment.size() - text.size() - 1));
    toml::table parsed = parse_value(text, source);
    toml::node& value = *parsed.get("value");

    toml::node* at = &document;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
        if (toml::array* array = at->as_array()) {
            at = &element(*array, path[k], assignment);
        } else if (toml::table* table = at->as_table()) {
            if (!table->contains(path[k])) {
                const std::string here =
                    fmt::format("{}{}", option, fmt::join(path.begin(), path.begin() + long(k) + 1, "."));
                toml::table made = toml::parse("value = {}", here);
                table->insert(sourced_key(path[k], here), std::move(*made.get_as<toml::table>("value")));
            }
            at = table->get(path[k]);
        } else {
            fail(assignment, fmt::format("\"{}\" is neither a table nor an array, so it has no key \"{}\"",
                                         safe_text(path[k - 1]), safe_text(path[k])));
        }
    }
    if (toml::array* array = at->as_array()) {
        toml::node& old = element(*array, path.back(), assignment);
        const auto index = std::find_if(array->begin(), array->end(), [&](const toml::node& n) { return &n == &old; });
        value.visit([&](auto& typed) { array->replace(index, std::move(typed)); });
    } else if (toml::table* table = at->as_table()) {
        value.visit([&](auto& typed) { table->insert_or_assign(sourced_key(path.back(), source), std::move(typed)); });
    } else {
        fail(assignment, fmt::format("\"{}\" is neither a table nor an array", safe_text(path[path.size() - 2])));
    }
}

}  // namespace

void set_values(toml::table& document, std::span<const std::string> assignments) {
    for (const std::string& assignment : assignments) set_value(document, assignment);
}

std::optional<SetValue> value_of_path(toml::table& document, std::string_view path_text) {
    Path path;
    const std::string assignment = std::string(path_text) + "=";
    split_path(assignment, path);
    toml::node* at = &document;
    for (const std::string& key : path) {
        if (toml::array* array = at->as_array())
            at = &element(*array, key, path_text);
        else if (toml::table* table = at->as_table())
            at = table->get(key);
        else
            return std::nullopt;
        if (at == nullptr) return std::nullopt;
    }
    if (const auto number = at->value<double>(); number && !at->is_boolean()) return SetValue{number, {}};
    if (const auto flag = at->value<bool>()) return SetValue{{}, *flag ? "true" : "false"};
    if (const auto text = at->value<std::string>()) return SetValue{{}, *text};
    return std::nullopt;
}

std::optional<std::string> set_option(const toml::source_region& source) {
    if (!source.path || !source.path->starts_with(option)) return std::nullopt;
    return *source.path;
}

}  // namespace tumble
