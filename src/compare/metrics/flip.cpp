#include "compare/metrics/flip.h"

#include "compare/metrics/background.h"
#include "compare/metrics/flip_color.h"
#include "compare/metrics/flip_filters.h"
#include "compare/metrics/metric_map.h"
#include "compare/metrics/row_filter.h"
#include "core/check.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace tumble {
namespace {

struct Filters {
    ContrastFilters contrast;
    FeatureFilters feature;
    int radius;

    explicit Filters(double pixels_per_degree)
        : contrast(contrast_filters(pixels_per_degree)),
          feature(feature_filters(pixels_per_degree)),
          radius(largest_radius(contrast, feature)) {}
};

/// Filters a region of an image from top to bottom, with as many rows in memory as the filters are high.
class FilteredImage {
public:
    FilteredImage(const Image& image, const Rectangle& region, const Filters& filters, std::uint8_t background)
        : image_(image),
          region_(region),
          filters_(filters),
          background_(background),
          padded_(std::size_t(region.width + 2 * filters.radius)),
          next_(std::max(0, region.y - filters.radius)) {
        for (std::vector<float>& row : converted_) row.resize(padded_);
        for (int i = 0; i < 7; ++i) rings_.emplace_back(region.width, filters.radius);
        for (std::vector<float>& row : result_) row.resize(std::size_t(region.width));
    }

    /// Row y of the image, in the columns of the region; y grows by 1 from call to call.
    FilteredRow row(int y) {
        const int last = std::min(image_.height - 1, y + filters_.radius);
        while (next_ <= last) filter_along_row(next_++);
        filter_along_columns(y);
        return {result_[0].data(), result_[1].data(), {result_[2].data(), result_[3].data()},
                result_[4].data(), result_[5].data(), result_[6].data(),
                result_[7].data()};
    }

private:
    enum Ring { luminance, red_green, blue_yellow_0, blue_yellow_1, gaussian, first_derivative, second_derivative };

    void filter_along_row(int y) {
        colors_.convert({image_.at(0, y), image_.width, region_.x - filters_.radius, padded_, background_},
                        {converted_[0].data(), converted_[1].data(), converted_[2].data()});
        const auto filter = [&](std::size_t plane, const RowFilter& with, Ring to) {
            filter_row(converted_[plane].data() + filters_.radius, region_.width, with, rings_[to].row(y));
        };
        filter(0, filters_.contrast.luminance, luminance);
        filter(1, filters_.contrast.red_green, red_green);
        filter(2, filters_.contrast.blue_yellow[0], blue_yellow_0);
        filter(2, filters_.contrast.blue_yellow[1], blue_yellow_1);
        filter(0, filters_.feature.gaussian, gaussian);
        filter(0, filters_.feature.first_derivative, first_derivative);
        filter(0, filters_.feature.second_derivative, second_derivative);
    }

    void filter_along_columns(int y) {
        const auto filter = [&](Ring from, const RowFilter& with, std::size_t to) {
            filter_columns(rings_[from].around(y, 0, image_.height), region_.width, with, result_[to].data());
        };
        filter(luminance, filters_.contrast.luminance, 0);
        filter(red_green, filters_.contrast.red_green, 1);
        filter(blue_yellow_0, filters_.contrast.blue_yellow[0], 2);
        filter(blue_yellow_1, filters_.contrast.blue_yellow[1], 3);
        filter(first_derivative, filters_.feature.gaussian, 4);
        filter(gaussian, filters_.feature.first_derivative, 5);
        filter(second_derivative, filters_.feature.gaussian, 6);
        filter(gaussian, filters_.feature.second_derivative, 7);
    }

    const Image& image_;
    Rectangle region_;
    const Filters& filters_;
    std::uint8_t background_;
    std::size_t padded_;  // columns of the region and of the filters at both sides
    int next_;            // row
    OpponentColors colors_;
    std::array<std::vector<float>, 3> converted_;
    std::vector<RowRing> rings_;
    std::array<std::vector<float>, 8> result_;
};

/// Raises the map to the values on a background.
void add_differences_on(std::uint8_t background, const std::array<const Image*, 2>& images, const Filters& filters,
                        MetricMap& map) {
    // Equal neighborhoods have the value 0, exactly.
    const Rectangle region = with_margin(changed_region(*images[0], *images[1]), filters.radius, *images[0]);
    if (region.width == 0) return;
    FilteredImage a(*images[0], region, filters, background), b(*images[1], region, filters, background);
    std::vector<float> values(std::size_t(region.width));
    for (int y = region.y; y < region.y + region.height; ++y) {
        flip_row(a.row(y), b.row(y), values.size(), values.data());
        float* const to = map.row(y) + region.x;
        for (std::size_t x = 0; x < values.size(); ++x) to[x] = std::max(to[x], values[x]);
    }
}

constexpr std::size_t bins = 10000;  // of quantiles

/// The upper end of the bin in which the sum of all before exceeds the fraction of the total.
double quantile(const std::array<double, bins>& sums, double total, double fraction) {
    double sum = 0.0;
    for (std::size_t i = 0; i < bins; ++i) {
        sum += sums[i];
        if (sum > 0.0 && sum >= fraction * total) return double(i + 1) / double(bins);
    }
    return 1.0;
}

void set_figures(FlipResult& result) {
    std::array<double, bins> counts{}, errors{};
    double total = 0.0;
    std::size_t zeros = 0;
    for (int y = 0; y < result.map.height; ++y)
        for (int x = 0; x < result.map.width; ++x) {
            const double value = double(result.map.at(x, y));
            if (value == 0.0) {
                ++zeros;
                continue;
            }
            const std::size_t bin = std::min(bins - 1, static_cast<std::size_t>(value * double(bins)));
            counts[bin] += 1.0;
            errors[bin] += value;
            total += value;
            if (value > result.maximum) {
                result.maximum = value;
                result.x = x;
                result.y = y;
            }
        }
    if (total == 0.0) return;
    const double pixels = double(result.map.values.size());
    result.mean = total / pixels;
    result.weighted_median = std::min(result.maximum, quantile(errors, total, 0.5));
    const double above_zeros = 0.99 * pixels - double(zeros);
    if (above_zeros > 0.0) result.quantile_99 = std::min(result.maximum, quantile(counts, above_zeros, 1.0));
}

}  // namespace

FlipResult flip(const Image& reference, const Image& image, const FlipSettings& settings) {
    TUMBLE_CHECK_EQ(reference.width, image.width);
    TUMBLE_CHECK_EQ(reference.height, image.height);
    TUMBLE_CHECK_GE(settings.pixels_per_degree, 1.0);
    TUMBLE_CHECK_LE(settings.pixels_per_degree, 1000.0);
    FlipResult result;
    result.map = MetricMap(image.width, image.height);
    const Filters filters(settings.pixels_per_degree);
    add_differences_on(black_background, {&reference, &image}, filters, result.map);
    if (has_alpha(reference) || has_alpha(image))
        add_differences_on(white_background, {&reference, &image}, filters, result.map);
    set_figures(result);
    return result;
}

}  // namespace tumble
