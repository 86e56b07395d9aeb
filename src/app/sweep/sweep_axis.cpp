#include "app/sweep/sweep_axis.h"

#include "core/check.h"
#include "core/deterministic_math.h"
#include "scene/toml/toml_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {
namespace {

constexpr int most_normal_draws =
    1000;  // for a normal value within its bounds: fewer than one in a thousand draws is outside all

double draw_normal(const Distribution& d, std::size_t component, DrawStream& stream) {
    double value = 0.0;
    for (int i = 0; i < most_normal_draws; ++i) {
        value = d.mean[component] + d.deviation[component] * stream.normal();
        if (value >= d.min[component] && value <= d.max[component]) return value;
    }
    return std::clamp(value, d.min[component], d.max[component]);
}

double draw_log_uniform(double min, double max, DrawStream& stream) {
    return std::clamp(exponential(stream.between(logarithm(min), logarithm(max))), min, max);
}

std::string draw_component(const Distribution& d, std::size_t component, DrawStream& stream) {
    switch (d.kind) {
        case DistributionKind::uniform:
            return rounded_number(stream.between(d.min[component], d.max[component]), d.decimals);
        case DistributionKind::log_uniform:
            return rounded_number(draw_log_uniform(d.min[component], d.max[component], stream), d.decimals);
        case DistributionKind::normal:
            return rounded_number(draw_normal(d, component, stream), d.decimals);
        case DistributionKind::integer: {
            const auto low = std::int64_t(d.min[component]), high = std::int64_t(d.max[component]);
            return fmt::format("{}", low + stream.index(high - low + 1));
        }
        case DistributionKind::choice:
            break;
    }
    TUMBLE_CHECK_EQ(d.kind == DistributionKind::choice, false);
    return {};
}

const std::string& draw_choice(const Distribution& d, DrawStream& stream) {
    double sum = 0.0;
    for (const double weight : d.weights) sum += weight;
    double rest = sum * stream.unit();
    for (std::size_t i = 0; i < d.values.size(); ++i) {
        if (d.weights[i] > 0.0 && rest < d.weights[i]) return d.values[i];
        rest -= d.weights[i];
    }
    // Rounding of the sums: the last one that has a weight.
    const auto last = std::find_if(d.weights.rbegin(), d.weights.rend(), [](double w) { return w > 0.0; });
    return d.values[d.values.size() - 1 - std::size_t(last - d.weights.rbegin())];
}

}  // namespace

std::string rounded_number(double value, const std::optional<int>& decimals) {
    if (!decimals) return toml_number(value);
    if (*decimals == 0) return toml_number(std::nearbyint(value));
    return fmt::format("{:.{}f}", value, *decimals);
}

std::string draw_value(const Distribution& distribution, DrawStream& stream) {
    if (distribution.kind == DistributionKind::choice) return draw_choice(distribution, stream);
    if (!distribution.array) return draw_component(distribution, 0, stream);
    std::string text = "[";
    const std::size_t components =
        distribution.kind == DistributionKind::normal ? distribution.mean.size() : distribution.min.size();
    for (std::size_t i = 0; i < components; ++i) {
        if (i > 0) text += ", ";
        text += draw_component(distribution, i, stream);
    }
    return text + "]";
}

}  // namespace tumble
