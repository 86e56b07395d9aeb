#include "app/causes/value_changes.h"

#include "core/safe_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>

namespace tumble {
namespace {

constexpr std::size_t longest_value = 60;  // bytes

std::string shown(const std::string& value) { return value.empty() ? "none" : safe_text(value, longest_value); }

/// The value with long numbers rounded to four digits.
std::string shortened(const std::string& value) {
    constexpr std::size_t long_number = 7;  // characters
    constexpr std::string_view between = " ,[]";
    std::string text;
    for (std::size_t at = 0; at < value.size();) {
        const std::size_t end = std::min(value.find_first_of(between, at), value.size());
        double number = 0.0;
        const auto [parsed, error] = std::from_chars(value.data() + at, value.data() + end, number);
        const bool is_number = error == std::errc() && parsed == value.data() + end;
        text += is_number && end - at >= long_number ? fmt::format("{:.4g}", number) : value.substr(at, end - at);
        if (end < value.size()) text += value[end];
        at = end + 1;
    }
    return text;
}

/// True if a part of the value is the hash of a longer one.
bool has_digest(const std::string& value) {
    constexpr std::size_t digits = 16;
    for (std::size_t at = value.find('#'); at != std::string::npos; at = value.find('#', at + 1)) {
        const std::size_t end = value.find_first_not_of("0123456789abcdef", at + 1);
        if ((end == std::string::npos ? value.size() : end) - at - 1 >= digits) return true;
    }
    return false;
}

}  // namespace

std::vector<ValueDifference> value_differences(const ValueMap& before, const ValueMap& after) {
    std::set<std::string> keys;
    for (const auto& [key, value] : before) keys.insert(key);
    for (const auto& [key, value] : after) keys.insert(key);
    const auto value_of = [](const ValueMap& values, const std::string& key) {
        const auto found = values.find(key);
        return found == values.end() ? std::string() : found->second;
    };
    std::vector<ValueDifference> differences;
    for (const std::string& key : keys) {
        ValueDifference one{key, value_of(before, key), value_of(after, key)};
        if (one.before != one.after) differences.push_back(std::move(one));
    }
    return differences;
}

std::string value_change_text(const std::string& before, const std::string& after) {
    if (has_digest(before) || has_digest(after)) return "changed";
    const std::string from = shortened(before), to = shortened(after);
    return from == to ? fmt::format("{} to {}", shown(before), shown(after))
                      : fmt::format("{} to {}", shown(from), shown(to));
}

}  // namespace tumble
