#include "app/causes/body_changes.h"

#include "app/causes/first_difference.h"
#include "core/safe_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string_view>
#include <tuple>

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

namespace {

constexpr std::size_t named_bodies = 3;  // of a group with one change
constexpr double least_move = 0.05;      // pixels: less is not seen, even on an edge
constexpr double turn_share = 0.3;       // a body whose center moved by a smaller part than its corners has turned

/// "crate.3", or "crate.3, crate.4, crate.5 and 7 others".
std::string names_text(const std::vector<std::string>& names) {
    if (names.size() <= named_bodies) return fmt::format("{}", fmt::join(names, ", "));
    return fmt::format("{} and {} others", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(named_bodies), ", "),
                       names.size() - named_bodies);
}

/// Bodies with one change of one value: key, value before, value after.
using Change = std::tuple<std::string, std::string, std::string>;
struct ChangedBodies {
    std::vector<std::string> names;
    double pixels = 0.0;
};

std::string change_text(const Change& change, const std::vector<std::string>& names) {
    const auto& [key, before, after] = change;
    return fmt::format("{} of {} ({})", key, names_text(names), value_change_text(before, after));
}

std::vector<Cause> value_changes(const PanelView& before, const PanelView& after, const BodyPairs& pairs,
                                 ValueMap BodyKind::*values) {
    std::map<Change, ChangedBodies> groups;
    for (const auto& [a, b] : pairs.both) {
        const BodyKind &from = before.panel().kind_of(a), &to = after.panel().kind_of(b);
        if (from.*values == to.*values) continue;
        for (const ValueDifference& one : value_differences(from.*values, to.*values)) {
            ChangedBodies& group = groups[{one.key, one.before, one.after}];
            group.names.push_back(before.panel().bodies[a].name);
            group.pixels += std::max(before.changed_pixels(a), after.changed_pixels(b));
        }
    }
    std::vector<Cause> causes;
    for (const auto& [change, bodies] : groups) causes.push_back({change_text(change, bodies.names), bodies.pixels});
    return causes;
}

void add_group(const PanelView& view, const std::vector<std::size_t>& bodies, const char* what,
               std::vector<Cause>& causes) {
    if (bodies.empty()) return;
    std::vector<std::string> names;
    double pixels = 0.0;
    for (const std::size_t body : bodies) {
        names.push_back(view.panel().bodies[body].name);
        pixels += view.changed_pixels(body);
    }
    causes.push_back({fmt::format("{} {}", names_text(names), what), pixels});
}

double turn_degrees(const RecordedPose& a, const RecordedPose& b) {
    return a.rotation.angularDistance(b.rotation) * 180.0 / std::numbers::pi;
}

std::string pixels_text(double pixels) {
    return pixels >= 1.0 ? fmt::format("{:.0f} px", pixels) : fmt::format("{:.1g} px", pixels);
}

std::string move_text(const PanelView& before, std::size_t body, const RecordedPose& now) {
    const RecordedPose& then = before.pose(body);
    const double moved = before.distance(body, then, now), center = before.center_distance(body, then, now);
    if (!std::isfinite(moved)) return fmt::format("moved by {:.2g} m", (then.origin - now.origin).norm());
    if (center < turn_share * moved) return fmt::format("turned by {:.2g} degrees", turn_degrees(then, now));
    return "moved by " + pixels_text(moved);
}

}  // namespace

BodyPairs::BodyPairs(const PanelRecord& before, const PanelRecord& after) {
    std::map<std::string, std::size_t> names;
    for (std::size_t i = 0; i < after.bodies.size(); ++i) names[after.bodies[i].name] = i;
    std::vector<bool> found(after.bodies.size());
    for (std::size_t i = 0; i < before.bodies.size(); ++i) {
        const auto other = names.find(before.bodies[i].name);
        if (other == names.end()) {
            removed.push_back(i);
        } else {
            both.emplace_back(i, other->second);
            found[other->second] = true;
        }
    }
    for (std::size_t i = 0; i < found.size(); ++i)
        if (!found[i]) added.push_back(i);
}

std::vector<Cause> appearance_changes(const PanelView& before, const PanelView& after, const BodyPairs& pairs) {
    std::vector<Cause> causes = value_changes(before, after, pairs, &BodyKind::look);
    add_group(before, pairs.removed, pairs.removed.size() > 1 ? "are missing" : "is missing", causes);
    add_group(after, pairs.added, pairs.added.size() > 1 ? "are new" : "is new", causes);
    return causes;
}

std::vector<Cause> matter_changes(const PanelView& before, const PanelView& after, const BodyPairs& pairs) {
    return value_changes(before, after, pairs, &BodyKind::matter);
}

std::vector<Cause> motion_changes(const PanelView& before, const PanelView& after, const BodyPairs& pairs) {
    std::vector<Cause> causes;
    const FirstDifferences first(before.panel(), after.panel());
    for (const auto& [a, b] : pairs.both) {
        const RecordedPose &then = before.pose(a), &now = after.pose(b);
        const double moved = before.distance(a, then, now);
        if (!(moved > least_move)) continue;
        const Rectangle from = before.bounds(a), to = after.bounds(b);
        const double visible = std::max(before.changed_pixels(a), after.changed_pixels(b));
        const double sides = std::max(from.width + from.height, to.width + to.height);
        causes.push_back({fmt::format("{} {}{}", before.panel().bodies[a].name, move_text(before, a, now),
                                      first.text(a, b, after.time())),
                          std::min(2.0 * visible, sides * moved)});
    }
    return causes;
}

std::vector<Cause> run_changes(const PanelView& before, const PanelView& after, const BodyPairs& pairs) {
    std::vector<Cause> causes;
    const FirstDifferences first(before.panel(), after.panel());
    for (const auto& [a, b] : pairs.both) {
        const RecordedBody &from = before.panel().bodies[a], &to = after.panel().bodies[b];
        if (from.moves && to.moves && first.frame(a, b))
            causes.push_back({fmt::format("{} moves differently{}", from.name, first.text(a, b, infinity)), 1.0});
    }
    return causes;
}

}  // namespace tumble
