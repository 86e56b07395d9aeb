#include "scene/toml/toml_text.h"

#include "scene/toml/set_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace tumble {
namespace {

bool is_bare(std::string_view key) {
    const auto bare = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    return !key.empty() && std::all_of(key.begin(), key.end(), bare);
}

std::string key_text(std::string_view key) { return is_bare(key) ? std::string(key) : toml_string(key); }

std::string array_text(const toml::array& array) {
    std::string text = "[";
    for (const toml::node& item : array) {
        if (text.size() > 1) text += ", ";
        text += toml_value_text(item);
    }
    return text + "]";
}

std::string inline_table_text(const toml::table& table) {
    if (table.empty()) return "{}";
    std::string text = "{ ";
    for (const auto& [key, node] : entries_in_order(table)) {
        if (text.size() > 2) text += ", ";
        text += key_text(key->str()) + " = " + toml_value_text(*node);
    }
    return text + " }";
}

/// True for what the file writes as [table].
bool is_section(const toml::node& node) {
    const toml::table* table = node.as_table();
    return table != nullptr && !table->is_inline();
}

/// True for what the file writes as [[table]]s.
bool is_list_of_sections(const toml::node& node) {
    const toml::array* array = node.as_array();
    return array != nullptr && !array->empty() && std::all_of(array->begin(), array->end(), is_section);
}

void write_table(const toml::table& table, const std::string& path, std::string& text) {
    const auto entries = entries_in_order(table);
    for (const auto& [key, node] : entries)
        if (!is_section(*node) && !is_list_of_sections(*node))
            text += fmt::format("{} = {}\n", key_text(key->str()), toml_value_text(*node));
    for (const auto& [key, node] : entries) {
        const std::string inner = path.empty() ? key_text(key->str()) : path + "." + key_text(key->str());
        if (is_section(*node)) {
            text += fmt::format("\n[{}]\n", inner);
            write_table(*node->as_table(), inner, text);
        } else if (is_list_of_sections(*node)) {
            for (const toml::node& item : *node->as_array()) {
                text += fmt::format("\n[[{}]]\n", inner);
                write_table(*item.as_table(), inner, text);
            }
        }
    }
}

}  // namespace

std::string toml_number(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value < 0.0 ? "-inf" : "inf";
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == std::string::npos) text.append({'.', '0'});
    return text;
}

std::string toml_string(std::string_view given) {
    std::string text = "\"";
    for (const char c : given) {
        if (c == '"' || c == '\\')
            text += fmt::format("\\{}", c);
        else if (c == '\n')
            text += "\\n";
        else if (c == '\t')
            text += "\\t";
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            text += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else
            text += c;
    }
    return text + "\"";
}

std::string toml_value_text(const toml::node& value) {
    if (const auto* text = value.as_string()) return toml_string(text->get());
    if (const auto* number = value.as_integer()) return fmt::format("{}", number->get());
    if (const auto* number = value.as_floating_point()) return toml_number(number->get());
    if (const auto* truth = value.as_boolean()) return truth->get() ? "true" : "false";
    if (const auto* array = value.as_array()) return array_text(*array);
    if (const auto* table = value.as_table()) return inline_table_text(*table);
    std::ostringstream text;  // a date or time
    value.visit([&](const auto& typed) {
        if constexpr (toml::is_date<decltype(typed)> || toml::is_time<decltype(typed)> ||
                      toml::is_date_time<decltype(typed)>)
            text << typed.get();
    });
    return text.str();
}

std::vector<std::pair<const toml::key*, const toml::node*>> entries_in_order(const toml::table& table) {
    std::vector<std::pair<const toml::key*, const toml::node*>> entries;
    for (const auto& [key, node] : table) entries.emplace_back(&key, &node);
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
        const bool a_set = set_option(a.first->source()).has_value(), b_set = set_option(b.first->source()).has_value();
        return a_set != b_set ? b_set : !a_set && a.first->source().begin < b.first->source().begin;
    });
    return entries;
}

std::string toml_document_text(const toml::table& document) {
    std::string text;
    write_table(document, "", text);
    return text;
}

}  // namespace tumble
