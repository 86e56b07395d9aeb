#include "app/sweep/read_axis.h"

#include "core/deterministic_math.h"
#include "scene/toml/toml_text.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>

namespace tumble {
namespace {

constexpr std::int64_t most_values = 1'000'000;  // of a list or range
constexpr std::int64_t most_components = 16;
constexpr int most_decimals = 15;
constexpr Range any_number{-1e300, 1e300, ""};
constexpr Range above_zero{0.0, 1e300, "", true};
constexpr Range not_negative{0.0, 1e300, ""};
constexpr double largest_integer = 0x1p52;

constexpr Choice<DistributionKind> distributions[] = {
    {"uniform", DistributionKind::uniform}, {"log-uniform", DistributionKind::log_uniform},
    {"normal", DistributionKind::normal},   {"integer", DistributionKind::integer},
    {"choice", DistributionKind::choice},
};

enum class Scale { linear, logarithmic };
constexpr Choice<Scale> scales[] = {{"linear", Scale::linear}, {"log", Scale::logarithmic}};

std::vector<std::string> read_values(const TomlValue& value) {
    std::vector<std::string> values;
    for (const TomlValue& item : value.items()) values.push_back(toml_value_text(item.node()));
    if (values.empty()) value.fail("must have a value");
    if (std::int64_t(values.size()) > most_values) value.fail(fmt::format("may have {} values at most", most_values));
    return values;
}

/// A number, or an array of them.
std::vector<double> read_numbers(const TomlValue& value, const Range& range, bool& array) {
    if (!value.is_array()) return {value.number(range)};
    array = true;
    std::vector<double> numbers;
    for (const TomlValue& item : value.items()) numbers.push_back(item.number(range));
    if (numbers.empty() || std::int64_t(numbers.size()) > most_components)
        value.fail(fmt::format("must be a number, or an array of 1 to {} numbers", most_components));
    return numbers;
}

/// Whole numbers from `from` on: all must be whole for the values to be.
ValueList whole_range(std::int64_t from, std::int64_t step, std::int64_t count) {
    ValueList list;
    for (std::int64_t i = 0; i < count; ++i) list.values.push_back(fmt::format("{}", from + step * i));
    return list;
}

ValueList stepped_range(const TomlTable& range, double from, double to) {
    const TomlValue given = range.require("step");
    const double step = given.number(any_number);
    if (step == 0.0 || (to - from) / step < 0.0) given.fail("must lead from \"from\" to \"to\"");
    // The end is one of the values if it is so within rounding: 0 to 1 by 0.1 has eleven.
    const double intervals = std::floor((to - from) / step * (1.0 + 1e-12) + 1e-9);
    if (intervals >= double(most_values)) given.fail(fmt::format("gives more than {} values", most_values));
    const auto count = std::int64_t(intervals) + 1;
    const bool whole = range.require("from").node().is_integer() && given.node().is_integer();
    if (whole) return whole_range(std::int64_t(from), std::int64_t(step), count);
    ValueList list;
    for (std::int64_t i = 0; i < count; ++i) {
        const double value = from + step * double(i);
        // 0.1 * 3 is 0.30000000000000004, which nobody means: twelve digits of the larger end.
        const double unit = std::fmax(std::fabs(from), std::fabs(to)) * 1e-12;
        const double rounded = std::strtod(fmt::format("{:.12g}", value).c_str(), nullptr);
        list.values.push_back(toml_number(std::fabs(rounded - value) <= unit ? rounded : value));
    }
    return list;
}

ValueList counted_range(const TomlTable& range, double from, double to) {
    const std::int64_t count = range.require("count").integer(1, most_values);
    Scale scale = Scale::linear;
    range.read<Scale>("scale", scale, scales);
    if (scale == Scale::logarithmic && !(from > 0.0 && to > 0.0))
        range.require(from > 0.0 ? "to" : "from").fail("must be above 0 in a logarithmic range");
    if (count > 1 && from == to) range.require("to").fail("must differ from \"from\"");
    ValueList list;
    for (std::int64_t i = 0; i < count; ++i) {
        const double part = count == 1 ? 0.0 : double(i) / double(count - 1);
        double value = i == 0 ? from : i + 1 == count ? to : from + (to - from) * part;
        if (scale == Scale::logarithmic && i > 0 && i + 1 < count)
            value = exponential(logarithm(from) + (logarithm(to) - logarithm(from)) * part);
        list.values.push_back(toml_number(value));
    }
    return list;
}

ValueList read_range(const TomlTable& range) {
    range.expect_keys({"from", "to", "count", "step", "scale"});
    const double from = range.require("from").number(any_number), to = range.require("to").number(any_number);
    if (range.has("step") == range.has("count"))
        range.origin().fail("needs either \"count\" or \"step\", the number of its values or their distance");
    if (!range.has("step")) return counted_range(range, from, to);
    if (const auto scale = range.find("scale")) scale->fail("needs \"count\": \"step\" is a distance");
    return stepped_range(range, from, to);
}

/// Fails at the first key of the table that belongs to other distributions.
void reject_keys(const TomlTable& table, std::initializer_list<std::string_view> keys, std::string_view kind) {
    for (const std::string_view key : keys)
        if (const auto value = table.find(key))
            value->origin().fail(fmt::format("does not belong to the distribution \"{}\"", kind));
}

void read_bounds(const TomlTable& table, const Range& range, Distribution& d) {
    const TomlValue min = table.require("min"), max = table.require("max");
    bool min_array = false, max_array = false;
    d.min = read_numbers(min, range, min_array);
    d.max = read_numbers(max, range, max_array);
    d.array = min_array;
    if (min_array != max_array || d.min.size() != d.max.size())
        max.fail(fmt::format("must have as many components as min, {}", d.min.size()));
    for (std::size_t i = 0; i < d.min.size(); ++i)
        if (!(d.min[i] <= d.max[i])) max.fail(fmt::format("must be at least min, {}", number_text(d.min[i])));
}

void read_normal(const TomlTable& table, Distribution& d) {
    const TomlValue mean = table.require("mean"), deviation = table.require("deviation");
    bool other_array = false;
    d.mean = read_numbers(mean, any_number, d.array);
    const std::size_t size = d.mean.size();
    const auto fill = [&](const TomlValue& value, const Range& range, std::vector<double>& numbers) {
        numbers = read_numbers(value, range, other_array);
        if (numbers.size() == 1) numbers.resize(size, numbers.front());
        if (numbers.size() != size) value.fail(fmt::format("must have as many components as mean, {}", size));
    };
    fill(deviation, not_negative, d.deviation);
    d.min.assign(size, -std::numeric_limits<double>::infinity());
    d.max.assign(size, std::numeric_limits<double>::infinity());
    if (const auto min = table.find("min")) fill(*min, any_number, d.min);
    if (const auto max = table.find("max")) fill(*max, any_number, d.max);
    for (std::size_t i = 0; i < size; ++i)
        if (!(d.min[i] <= d.max[i])) table.require("max").fail("must be at least min");
}

void read_choice(const TomlTable& table, Distribution& d) {
    d.values = read_values(table.require("values"));
    d.weights.assign(d.values.size(), 1.0);
    const auto weights = table.find("weights");
    if (!weights) return;
    const auto items = weights->items(d.values.size(), "numbers, one for each value");
    double sum = 0.0;
    for (std::size_t i = 0; i < items.size(); ++i) sum += d.weights[i] = items[i].number(not_negative);
    if (!(sum > 0.0)) weights->fail("must not all be 0");
}

Distribution read_distribution(const TomlTable& table) {
    Distribution d;
    table.read<DistributionKind>("distribution", d.kind, distributions);
    switch (d.kind) {
        case DistributionKind::uniform:
            reject_keys(table, {"mean", "deviation", "values", "weights"}, "uniform");
            read_bounds(table, any_number, d);
            break;
        case DistributionKind::log_uniform:
            reject_keys(table, {"mean", "deviation", "values", "weights"}, "log-uniform");
            read_bounds(table, above_zero, d);
            break;
        case DistributionKind::normal:
            reject_keys(table, {"values", "weights"}, "normal");
            read_normal(table, d);
            break;
        case DistributionKind::integer:
            reject_keys(table, {"mean", "deviation", "values", "weights", "decimals"}, "integer");
            for (const char* key : {"min", "max"})
                for (const TomlValue& item :
                     table.require(key).is_array() ? table.require(key).items() : std::vector{table.require(key)})
                    item.integer(-std::int64_t(largest_integer), std::int64_t(largest_integer));
            read_bounds(table, any_number, d);
            break;
        case DistributionKind::choice:
            reject_keys(table, {"mean", "deviation", "min", "max", "decimals"}, "choice");
            read_choice(table, d);
            break;
    }
    if (const auto decimals = table.find("decimals")) d.decimals = int(decimals->integer(0, most_decimals));
    return d;
}

}  // namespace

AxisSource read_source(const TomlTable& table) {
    const bool distribution = table.has("distribution"), range = table.has("range"), values = table.has("values");
    if (!distribution)
        for (const char* key : {"min", "max", "mean", "deviation", "weights", "decimals"})
            if (const auto value = table.find(key)) value->origin().fail("needs \"distribution\", such as \"uniform\"");
    if (range && (values || distribution))
        table.require("range").origin().fail("excludes \"values\" and \"distribution\": give one of them");
    if (distribution) return read_distribution(table);
    if (range) {
        TomlTable inner = table.require("range").table();
        inner.set_title("a range");
        return read_range(inner);
    }
    return ValueList{read_values(table.require("values"))};
}

std::string read_path(const TomlValue& value) {
    const std::string path = value.text();
    bool quoted = false, empty = true;
    for (const char c : path + ".") {
        if (c == '"') quoted = !quoted;
        if (c == '=' && !quoted) value.fail("must be the path of a key, without its value");
        if (c == '.' && !quoted) {
            if (empty) value.fail("must be the path of a key, as in \"body.crate.mass\"");
            empty = true;
        } else {
            empty = false;
        }
    }
    if (quoted) value.fail("has a quote without its other half");
    return path;
}

SweepAxis read_axis(const TomlTable& table) {
    table.expect_keys({"name", "path", "paths", "values", "range", "distribution", "min", "max", "mean", "deviation",
                       "weights", "decimals", "seed"});
    SweepAxis axis;
    if (const auto path = table.find("path")) axis.paths.push_back(read_path(*path));
    if (const auto paths = table.find("paths")) {
        if (!axis.paths.empty()) paths->origin().fail("and path exclude each other: give one of them");
        for (const TomlValue& item : paths->items()) axis.paths.push_back(read_path(item));
        if (axis.paths.empty()) paths->fail("must have a path");
    }
    if (axis.paths.empty()) table.require("path");
    axis.name = axis.paths.front();
    table.read("name", axis.name);
    if (axis.name.empty()) table.require("name").fail("must not be empty");
    if (axis.name.find_first_of("{}:/\n") != std::string::npos)
        table.require(table.has("name") ? "name" : "path").fail("must have no brace, colon, slash or line break");
    axis.source = read_source(table);
    if (const auto seed = table.find("seed"))
        axis.seed = std::uint64_t(seed->integer(0, std::numeric_limits<std::int64_t>::max()));
    return axis;
}

}  // namespace tumble
