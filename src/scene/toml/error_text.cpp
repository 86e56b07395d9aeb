#include "scene/toml/error_text.h"

#include "core/safe_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tumble {

namespace {

/// Number of insertions, deletions, replacements and swaps of adjacent characters that turn a into b (Damerau 1964, in
/// the restricted form: optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
    std::iota(last.begin(), last.end(), 0u);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before[j - 2] + 1);
            }
        }
        before = last;
        last = row;
    }
    return last[b.size()];
}

std::size_t common_start(std::string_view a, std::string_view b) {
    return std::size_t(std::ranges::mismatch(a, b).in1 - a.begin());
}

}  // namespace

std::string number_text(double value) {
    if (std::fabs(value) < 1e9 && value == std::trunc(value)) return fmt::format("{:.0f}", value);
    return fmt::format("{}", value);
}

std::string quoted_list(const std::vector<std::string_view>& names) {
    std::vector<std::string> quoted;
    for (std::string_view name : names) quoted.push_back(fmt::format("\"{}\"", safe_text(name)));
    return fmt::format("{}", fmt::join(quoted, ", "));
}

std::string did_you_mean(std::string_view given, const std::vector<std::string_view>& known) {
    constexpr std::size_t longest_guess = 64;  // characters: the cost is the product of both lengths
    std::size_t best = std::string_view::npos;
    std::string_view nearest;
    for (std::string_view name : known) {
        if (given.size() > longest_guess || name.size() > longest_guess) continue;
        const std::size_t distance = edit_distance(given, name);
        // Beginnings are typed with more care: "sped" is "speed" rather than "seed".
        if (distance < best || (distance == best && common_start(given, name) > common_start(given, nearest)))
            best = distance, nearest = name;
    }
    // Up to a third of the letters wrong is a typing error; more is another word.
    if (best == std::string_view::npos || best > std::max<std::size_t>(1, nearest.size() / 3)) return "";
    return fmt::format(" (did you mean \"{}\"?)", safe_text(nearest));
}

std::string suggestion(std::string_view given, const std::vector<std::string_view>& known) {
    constexpr std::size_t readable_list = 12;  // names in a message
    if (std::string nearest = did_you_mean(given, known); !nearest.empty()) return nearest;
    if (known.empty() || known.size() > readable_list) return "";
    return fmt::format(" (known: {})", quoted_list(known));
}

void SourcePosition::fail(std::string_view problem) const {
    if (is_option()) throw InputError(fmt::format("{}: {}", safe_text(name), problem));
    throw InputError(where, fmt::format("{} {}", safe_text(name), problem));
}

}  // namespace tumble
