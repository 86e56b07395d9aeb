#include "app/sweep/sweep_axis.h"

#include "core/check.h"
#include "core/deterministic_math.h"
#include "core/fnv_hash.h"
#include "scene/toml/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The mixing of SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators").
std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

constexpr std::uint64_t golden_step = 0x9e3779b97f4a7c15u;

}  // namespace

DrawStream::DrawStream(std::uint64_t seed, std::string_view axis, std::uint64_t draw)
    : state_(mixed(mixed(mixed(seed + golden_step) ^ fnv_hash(std::as_bytes(std::span(axis)))) +
                   golden_step * (draw + 1))) {}

std::uint64_t DrawStream::next() { return mixed(state_ += golden_step); }

double DrawStream::unit() { return double(next() >> 11) * 0x1p-53; }

double DrawStream::between(double low, double high) {
    return std::clamp(low + (high - low) * unit(), low, high);  // rounding may pass a bound
}

/// Marsaglia and Bray 1964, "A convenient method for generating normal variables".
double DrawStream::normal() {
    for (;;) {
        const double x = 2.0 * unit() - 1.0, y = 2.0 * unit() - 1.0, square = x * x + y * y;
        if (square < 1.0 && square > 0.0) return x * std::sqrt(-2.0 * logarithm(square) / square);
    }
}

std::int64_t DrawStream::index(std::int64_t count) {
    return std::min(count - 1, static_cast<std::int64_t>(unit() * double(count)));
}

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
