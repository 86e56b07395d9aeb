#include "output/image_compare.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace tumble {
namespace {

constexpr int window = 8;           // pixels: about the smallest object worth seeing
constexpr int stride = window / 2;  // windows overlap by half, so that no small change is cut in four
// Two outliers side by side are seen in noise; a box moved by one pixel, however small, leaves more than four.
constexpr int cluster_limit = 4;    // failing pixels in a window

void check_sizes(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height)
        throw InputError(fmt::format("pictures of different sizes cannot be compared ({} x {} and {} x {})", a.width,
                                     a.height, b.width, b.height));
}

/// The largest difference over the four channels of a pixel.
int pixel_difference(const std::uint8_t* a, const std::uint8_t* b) {
    int most = 0;
    for (int c = 0; c < 4; ++c) most = std::max(most, std::abs(int(a[c]) - int(b[c])));
    return most;
}

/// Where windows begin along one side: every stride, and one flush with the far edge.
std::vector<int> window_starts(int size) {
    std::vector<int> starts;
    for (int i = 0; i + window < size; i += stride) starts.push_back(i);
    starts.push_back(std::max(0, size - window));
    return starts;
}

/// Sums over windows of the differences and of the failing pixels.
void look_through_windows(const std::vector<std::uint8_t>& difference, int width, int height, int tolerance,
                          Comparison& result) {
    for (const int top : window_starts(height)) {
        for (const int left : window_starts(width)) {
            const int bottom = std::min(top + window, height), right = std::min(left + window, width);
            int sum = 0, failing = 0;
            for (int y = top; y < bottom; ++y)
                for (int x = left; x < right; ++x) {
                    const int d = difference[std::size_t(y) * std::size_t(width) + std::size_t(x)];
                    sum += d;
                    failing += d > tolerance ? 1 : 0;
                }
            // Pictures smaller than a window are one window, with the same weight for each pixel.
            const double mean = double(sum) / (window * window);
            result.worst_cluster = std::max(result.worst_cluster, failing);
            if (mean > result.worst_window) {
                result.worst_window = mean;
                result.worst_window_x = left;
                result.worst_window_y = top;
            }
        }
    }
}

std::string failed_test(const Comparison& c, std::size_t pixels, const CompareOptions& options) {
    // Pixels that the caller lets differ may lie anywhere, and differ by anything: both window limits grow by them.
    const double window_limit = 0.5 * options.tolerance + 255.0 * options.fraction;
    const double cluster_most = cluster_limit + window * window * options.fraction;
    // Rounded up: in a picture of a few thousand pixels one may still be noise.
    if (double(c.failing_pixels) > std::ceil(options.fraction * double(pixels)))
        return fmt::format("{} pixels ({:.4g} of all; at most {:.4g} may) differ by more than {} levels, up to {}",
                           c.failing_pixels, c.failing_fraction, options.fraction, options.tolerance, c.max_difference);
    if (c.worst_cluster > cluster_most)
        return fmt::format("{} pixels close together differ by more than {} levels, up to {}", c.worst_cluster,
                           options.tolerance, c.max_difference);
    if (c.worst_window > window_limit)
        return fmt::format("around pixel {}, {} the pictures differ by {:.2f} levels on average (at most {:.2f} may)",
                           c.worst_window_x + stride, c.worst_window_y + stride, c.worst_window, window_limit);
    return {};
}

}  // namespace

Comparison compare_images(const Image& a, const Image& b, const CompareOptions& options) {
    check_sizes(a, b);
    Comparison result;
    const std::size_t pixels = std::size_t(a.width) * std::size_t(a.height);
    std::vector<std::uint8_t> difference(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const int d = pixel_difference(&a.pixels[4 * i], &b.pixels[4 * i]);
        difference[i] = static_cast<std::uint8_t>(d);
        result.max_difference = std::max(result.max_difference, d);
        result.differing_pixels += d > 0 ? 1 : 0;
        result.failing_pixels += d > options.tolerance ? 1 : 0;
    }
    if (pixels > 0) result.failing_fraction = double(result.failing_pixels) / double(pixels);
    if (result.max_difference > 0)
        look_through_windows(difference, a.width, a.height, options.tolerance, result);
    result.reason = failed_test(result, pixels, options);
    result.alike = result.reason.empty();
    return result;
}

Image difference_image(const Image& a, const Image& b, const CompareOptions& options) {
    check_sizes(a, b);
    Image image(a.width, a.height);
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        const std::uint8_t* from = &a.pixels[i];
        std::uint8_t* to = &image.pixels[i];
        const int d = pixel_difference(from, &b.pixels[i]);
        const int grey = (2 * from[0] + 5 * from[1] + from[2]) / 24;   // a third of the brightness
        const int shown = d == 0 ? grey : std::min(255, 96 + 8 * d);   // the smallest difference can be seen
        to[0] = static_cast<std::uint8_t>(d > options.tolerance ? shown : grey);
        to[1] = static_cast<std::uint8_t>(grey);
        to[2] = static_cast<std::uint8_t>(d > 0 && d <= options.tolerance ? shown : grey);
        to[3] = 255;
    }
    return image;
}

}  // namespace tumble
