#include "app/sweep/toml_json.h"

#include "scene/toml/toml_text.h"

#include <cmath>

namespace tumble {

nlohmann::ordered_json json_of(const toml::node& value) {
    if (const auto* text = value.as_string()) return text->get();
    if (const auto* number = value.as_integer()) return number->get();
    if (const auto* truth = value.as_boolean()) return truth->get();
    if (const auto* number = value.as_floating_point(); number != nullptr && std::isfinite(number->get()))
        return number->get();
    if (const toml::array* array = value.as_array()) {
        auto items = nlohmann::ordered_json::array();
        for (const toml::node& item : *array) items.push_back(json_of(item));
        return items;
    }
    if (const toml::table* table = value.as_table()) {
        auto object = nlohmann::ordered_json::object();
        for (const auto& [key, node] : entries_in_order(*table)) object[std::string(key->str())] = json_of(*node);
        return object;
    }
    return toml_value_text(value);
}

nlohmann::ordered_json json_of(const std::string& toml) {
    const toml::table parsed = parse_toml("value = " + toml, "");
    return json_of(*parsed.get("value"));
}

}  // namespace tumble
