#include "compare/metrics/flip_filters.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tumble {
namespace {

/// A contrast sensitivity function is the sum of Gaussians a exp(-b f^2), f in cycles a degree. Its filter is
/// a sqrt(pi / b) exp(-pi^2 d^2 / b), d in degrees.
struct Sensitivity {
    double a, b;
};

// The paper's table 1.
constexpr Sensitivity luminance{1.0, 0.0047};
constexpr Sensitivity red_green{1.0, 0.0053};
constexpr Sensitivity blue_yellow[] = {{34.1, 0.04}, {13.5, 0.025}};

// Width of the lines that the eye detects, degrees (sec. 4.2): 2 standard deviations of the feature filters.
constexpr double feature_width = 0.082;
constexpr double deviations = 3.0;   // radius of the filters (secs. 4.1.1, 4.2)
constexpr double negligible = 1e-9;  // of the sum of all weights: below the rounding of floats

/// Values of the offsets 0 to radius.
using Weights = std::vector<double>;

/// The sum over all offsets.
double total(const Weights& weights) {
    double sum = weights[0];
    for (std::size_t k = 1; k < weights.size(); ++k) sum += 2.0 * weights[k];
    return sum;
}

/// One factor of the Gaussian of two dimensions, so with the root of its height.
Weights gaussian(const Sensitivity& s, double pixels_per_degree, int radius) {
    Weights weights;
    const double height = std::sqrt(s.a * std::sqrt(pi / s.b));
    for (int k = 0; k <= radius; ++k) {
        const double d = k / pixels_per_degree;
        weights.push_back(height * exponential(-pi * pi * d * d / s.b));
    }
    return weights;
}

RowFilter row_filter(const Weights& weights, double scale, FilterKind kind = FilterKind::symmetric) {
    std::size_t count = weights.size();
    while (count > 1 && std::fabs(weights[count - 1] * scale) < negligible) --count;
    RowFilter filter{{}, kind};
    for (std::size_t k = 0; k < count; ++k) filter.weights.push_back(static_cast<float>(weights[k] * scale));
    return filter;
}

/// Scales positive and negative weights of a derivative.
RowFilter derivative_filter(Weights weights, FilterKind kind) {
    double positive = 0.0, negative = 0.0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const double both_sides = (k == 0 || kind == FilterKind::antisymmetric ? 1.0 : 2.0) * weights[k];
        (both_sides > 0.0 ? positive : negative) += std::fabs(both_sides);
    }
    for (double& weight : weights) {
        const double sum = weight > 0.0 ? positive : negative;
        weight = sum > 0.0 ? weight / sum : 0.0;
    }
    return row_filter(weights, 1.0, kind);
}

}  // namespace

ContrastFilters contrast_filters(double pixels_per_degree) {
    const double widest = std::max({luminance.b, red_green.b, blue_yellow[0].b, blue_yellow[1].b});
    const double deviation = std::sqrt(widest / (2.0 * pi * pi));  // degrees
    const int radius = static_cast<int>(std::ceil(deviations * deviation * pixels_per_degree));
    ContrastFilters filters;
    const auto alone = [&](const Sensitivity& s) {
        const Weights weights = gaussian(s, pixels_per_degree, radius);
        return row_filter(weights, 1.0 / total(weights));
    };
    filters.luminance = alone(luminance);
    filters.red_green = alone(red_green);
    // The weights of the sum in two dimensions sum to 1.
    const Weights first = gaussian(blue_yellow[0], pixels_per_degree, radius);
    const Weights second = gaussian(blue_yellow[1], pixels_per_degree, radius);
    const double a = total(first), b = total(second), scale = 1.0 / std::sqrt(a * a + b * b);
    filters.blue_yellow[0] = row_filter(first, scale);
    filters.blue_yellow[1] = row_filter(second, scale);
    return filters;
}

FeatureFilters feature_filters(double pixels_per_degree) {
    const double deviation = 0.5 * feature_width * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(deviations * deviation));
    Weights gaussian, first, second;
    for (int k = 0; k <= radius; ++k) {
        const double t = k / deviation, g = exponential(-0.5 * t * t);
        gaussian.push_back(g);
        first.push_back(-k * g);
        second.push_back((t * t - 1.0) * g);
    }
    return {row_filter(gaussian, 1.0 / total(gaussian)), derivative_filter(first, FilterKind::antisymmetric),
            derivative_filter(second, FilterKind::zero_sum)};
}

int largest_radius(const ContrastFilters& contrast, const FeatureFilters& feature) {
    return std::max({contrast.luminance.radius(), contrast.red_green.radius(), contrast.blue_yellow[0].radius(),
                     contrast.blue_yellow[1].radius(), feature.gaussian.radius(), feature.first_derivative.radius(),
                     feature.second_derivative.radius()});
}

}  // namespace tumble
