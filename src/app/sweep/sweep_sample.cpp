#include "app/sweep/sweep_sample.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "scene/toml/toml_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace tumble {
namespace {

constexpr int most_draws = 64;  // to draw another value than that of A

DrawStream stream_of(const SweepPlan& plan, const SweepAxis& axis, std::int64_t draw, std::string_view purpose = "") {
    return {axis.seed.value_or(plan.seed), fmt::format("{}{}", axis.name, purpose), std::uint64_t(draw)};
}

/// The number of the value of each list in a combination.
std::vector<std::size_t> list_numbers(const SweepPlan& plan, std::int64_t draw) {
    std::vector<std::size_t> numbers(plan.axes.size(), 0);
    std::int64_t rest = draw % plan.combinations();
    for (std::size_t i = plan.axes.size(); i-- > 0;) {
        const SweepAxis& axis = plan.axes[i];
        if (!axis.is_list()) continue;
        const auto size = std::int64_t(axis.list_size());
        if (plan.combination == Combination::random) {
            numbers[i] = std::size_t(stream_of(plan, axis, draw).index(size));
        } else if (plan.combination == Combination::zip) {
            numbers[i] = std::size_t(rest);
        } else {
            numbers[i] = std::size_t(rest % size);
            rest /= size;
        }
    }
    return numbers;
}

std::string value_of(const SweepPlan& plan, const SweepAxis& axis, std::size_t list_number, std::int64_t draw) {
    if (const auto* list = std::get_if<ValueList>(&axis.source)) return list->values[list_number];
    DrawStream stream = stream_of(plan, axis, draw);
    return draw_value(std::get<Distribution>(axis.source), stream);
}

/// Times the factor plus the offset; a whole number stays one if the result is whole.
std::string scaled(const toml::node& value, const PairFactor& by, const SweepAxis& axis) {
    if (const toml::array* array = value.as_array()) {
        std::vector<std::string> items;
        for (const toml::node& item : *array) items.push_back(scaled(item, by, axis));
        return fmt::format("[{}]", fmt::join(items, ", "));
    }
    const auto number = value.value<double>();
    if (!number || value.is_boolean())
        throw InputError(fmt::format("[pair]: factor and offset need numbers (the value of {} is {})",
                                     safe_text(axis.name), safe_text(toml_value_text(value))));
    const double result = *number * by.factor + by.offset;
    if (value.is_integer() && result == std::trunc(result) && std::fabs(result) < 0x1p53)
        return fmt::format("{:.0f}", result);
    const auto* distribution = std::get_if<Distribution>(&axis.source);
    return rounded_number(result, distribution != nullptr ? distribution->decimals : std::nullopt);
}

std::string scaled(const std::string& value, const PairFactor& by, const SweepAxis& axis) {
    const toml::table parsed = parse_toml("value = " + value, "");
    return scaled(*parsed.get("value"), by, axis);
}

/// Another value than that of A.
std::string drawn_again(const SweepAxis& axis, const std::string& a, DrawStream stream) {
    for (int i = 0; i < most_draws; ++i)
        if (std::string b = draw_value(std::get<Distribution>(axis.source), stream); b != a) return b;
    throw InputError(fmt::format("[pair]: {} draws {} again and again, and a pair needs two values",
                                 safe_text(axis.name), safe_text(a)));
}

std::string other_in_list(const SweepPlan& plan, const SweepAxis& axis, std::size_t number, std::int64_t draw) {
    const std::size_t size = axis.list_size();
    const bool random = plan.combination == Combination::random;
    const std::int64_t steps = random ? 1 + stream_of(plan, axis, draw, "/B").index(std::int64_t(size) - 1) : 1;
    return std::get<ValueList>(axis.source).values[(number + std::size_t(steps)) % size];
}

std::string value_of_b(const SweepPlan& plan, const SweepAxis& axis, std::size_t list_number, std::int64_t draw,
                       const std::string& a) {
    const PairValue& value = plan.pair->value;
    if (const auto* by = std::get_if<PairFactor>(&value)) return scaled(a, *by, axis);
    DrawStream stream = stream_of(plan, axis, draw, "/B");
    if (const auto* source = std::get_if<OtherSource>(&value)) {
        if (const auto* list = std::get_if<ValueList>(&source->source))
            return list->values[std::size_t(draw) % list->values.size()];
        return draw_value(std::get<Distribution>(source->source), stream);
    }
    return axis.is_list() ? other_in_list(plan, axis, list_number, draw) : drawn_again(axis, a, stream);
}

}  // namespace

std::int64_t SweepPlan::combinations() const {
    if (combination == Combination::random) return 1;
    std::int64_t count = 1;
    for (const SweepAxis& axis : axes) {
        if (!axis.is_list()) continue;
        const auto size = std::int64_t(axis.list_size());
        count = combination == Combination::zip ? size : count * size;
    }
    return count;
}

SweepSample sample_of(const SweepPlan& plan, std::int64_t index) {
    SweepSample sample;
    sample.index = index;
    const std::int64_t draw = plan.pair ? index / 2 : index;
    const std::vector<std::size_t> numbers = list_numbers(plan, draw);
    for (std::size_t i = 0; i < plan.axes.size(); ++i)
        sample.values.push_back(value_of(plan, plan.axes[i], numbers[i], draw));
    if (plan.pair) {
        const std::size_t differs = plan.pair->axes[std::size_t(draw) % plan.pair->axes.size()];
        const SweepAxis& axis = plan.axes[differs];
        sample.pair = PairSide{draw, index % 2 == 0 ? 'A' : 'B', axis.name};
        if (index % 2 == 1)
            sample.values[differs] = value_of_b(plan, axis, numbers[differs], draw, sample.values[differs]);
    }
    sample.name = name_of_sample(plan, sample);
    return sample;
}

std::string SweepSample::text(const SweepPlan& plan) const {
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i)
        text += fmt::format("{}{} = {}", i > 0 ? ", " : "", safe_text(plan.axes[i].name), safe_text(values[i]));
    return text;
}

std::vector<std::string> SweepSample::assignments(const SweepPlan& plan) const {
    std::vector<std::string> all = plan.fixed;
    for (std::size_t i = 0; i < values.size(); ++i)
        for (const std::string& path : plan.axes[i].paths) all.push_back(path + "=" + values[i]);
    return all;
}

}  // namespace tumble
