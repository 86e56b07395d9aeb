#include "compare/metrics/ssim.h"

#include "compare/metrics/background.h"
#include "compare/metrics/metric_map.h"
#include "compare/metrics/row_filter.h"
#include "core/check.h"
#include "core/cpu_dispatch.h"
#include "core/deterministic_math.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace tumble {
namespace {

// Sec. III-B and III-C of the paper: windows of 11 x 11 with a standard deviation of 1.5; K1, K2 and L of eqs. (7) and
// (9) to (11).
constexpr int window_radius = 5;
constexpr double window_deviation = 1.5;
constexpr float c1 = (0.01f * 255.0f) * (0.01f * 255.0f), c2 = (0.03f * 255.0f) * (0.03f * 255.0f);

// Luma relative to a middle level: squares are smaller then, and lose fewer bits. Variances do not change.
constexpr float middle_luma = 128.0f;

RowFilter window_filter() {
    std::array<double, window_radius + 1> weights{};
    double sum = 0.0;
    for (int k = 0; k <= window_radius; ++k) {
        const double t = k / window_deviation;
        weights[std::size_t(k)] = exponential(-0.5 * t * t);
        sum += (k == 0 ? 1.0 : 2.0) * weights[std::size_t(k)];
    }
    RowFilter filter;
    for (const double weight : weights) filter.weights.push_back(static_cast<float>(weight / sum));
    return filter;
}

/// Luma of ITU-R BT.601 of the columns from `first` on; columns outside are the nearest inside.
void luma_row(const Image& image, int y, int first, std::uint8_t background, std::vector<float>& to) {
    for (std::size_t i = 0; i < to.size(); ++i) {
        const std::uint8_t* const p = image.at(std::clamp(first + static_cast<int>(i), 0, image.width - 1), y);
        const auto seen = [&](int channel) { return float(seen_on_background(p, channel, background)); };
        to[i] = 0.299f * seen(0) + 0.587f * seen(1) + 0.114f * seen(2) - middle_luma;
    }
}

/// Means of a window, of luma less the middle: of a, of b, of a^2 + b^2 and of (a - b)^2.
struct WindowMeans {
    const float *a, *b, *squares, *difference;
};

TUMBLE_WIDE void square_rows(const float* a, const float* b, std::size_t count, float* __restrict squares,
                             float* __restrict difference) {
    for (std::size_t i = 0; i < count; ++i) {
        squares[i] = a[i] * a[i] + b[i] * b[i];
        difference[i] = (a[i] - b[i]) * (a[i] - b[i]);
    }
}

// Eq. (13). 2 m_a m_b = m_a^2 + m_b^2 - (m_a - m_b)^2, and the same of variances: exactly 1 where a = b.
TUMBLE_WIDE void ssim_row(const WindowMeans& means, std::size_t count, float* __restrict to) {
    const WindowMeans m = means;
    for (std::size_t i = 0; i < count; ++i) {
        const float a = m.a[i], b = m.b[i], d = a - b;
        const float light_a = a + middle_luma, light_b = b + middle_luma;
        const float luminance = 1.0f - d * d / (light_a * light_a + light_b * light_b + c1);
        const float variances = std::max(m.squares[i] - (a * a + b * b), 0.0f);
        const float variance_of_difference = std::max(m.difference[i] - d * d, 0.0f);
        to[i] = luminance * (1.0f - variance_of_difference / (variances + c2));
    }
}

/// Filters the windows of a region from top to bottom.
class Windows {
public:
    Windows(const Image& a, const Image& b, const Rectangle& region, std::uint8_t background)
        : a_(a), b_(b), region_(region), background_(background), next_(std::max(0, region.y - window_radius)) {
        for (std::vector<float>& row : source_) row.resize(std::size_t(region.width + 2 * window_radius));
        for (int i = 0; i < 4; ++i) rings_.emplace_back(region.width, window_radius);
        for (std::vector<float>& row : means_) row.resize(std::size_t(region.width));
    }

    /// Row y of the image; y grows by 1 from call to call.
    WindowMeans row(int y) {
        const int last = std::min(a_.height - 1, y + window_radius);
        while (next_ <= last) add_row(next_++);
        for (std::size_t i = 0; i < means_.size(); ++i)
            filter_columns(rings_[i].around(y, 0, a_.height), region_.width, filter_, means_[i].data());
        return {means_[0].data(), means_[1].data(), means_[2].data(), means_[3].data()};
    }

private:
    void add_row(int y) {
        luma_row(a_, y, region_.x - window_radius, background_, source_[0]);
        luma_row(b_, y, region_.x - window_radius, background_, source_[1]);
        square_rows(source_[0].data(), source_[1].data(), source_[0].size(), source_[2].data(), source_[3].data());
        for (std::size_t i = 0; i < source_.size(); ++i)
            filter_row(source_[i].data() + window_radius, region_.width, filter_, rings_[i].row(y));
    }

    const Image &a_, &b_;
    Rectangle region_;
    std::uint8_t background_;
    int next_;  // row
    RowFilter filter_ = window_filter();
    std::array<std::vector<float>, 4> source_, means_;
    std::vector<RowRing> rings_;
};

/// Lowers the map to the values on a background.
void add_similarity_on(std::uint8_t background, const Image& a, const Image& b, MetricMap& map) {
    const Rectangle region = with_margin(changed_region(a, b), window_radius, a);
    if (region.width == 0) return;
    Windows windows(a, b, region, background);
    std::vector<float> values(std::size_t(region.width));
    for (int y = region.y; y < region.y + region.height; ++y) {
        ssim_row(windows.row(y), values.size(), values.data());
        float* const to = map.row(y) + region.x;
        for (std::size_t x = 0; x < values.size(); ++x) to[x] = std::min(to[x], values[x]);
    }
}

void set_figures(SsimResult& result) {
    const MetricMap& map = result.map;
    const bool inside = map.width > 2 * window_radius && map.height > 2 * window_radius;
    const int border = inside ? window_radius : 0;
    double loss = 0.0;  // 1 - SSIM: most of an image has exactly none
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const double value = double(map.at(x, y));
            const bool counts = x >= border && x < map.width - border && y >= border && y < map.height - border;
            if (counts) loss += 1.0 - value;
            if (value < result.lowest) {
                result.lowest = value;
                result.x = x;
                result.y = y;
            }
        }
    const double windows = double(map.width - 2 * border) * double(map.height - 2 * border);
    if (windows > 0.0) result.mean = 1.0 - loss / windows;
}

}  // namespace

SsimResult ssim(const Image& reference, const Image& image) {
    TUMBLE_CHECK_EQ(reference.width, image.width);
    TUMBLE_CHECK_EQ(reference.height, image.height);
    SsimResult result;
    result.map = MetricMap(image.width, image.height, 1.0f);
    add_similarity_on(black_background, reference, image, result.map);
    if (has_alpha(reference) || has_alpha(image)) add_similarity_on(white_background, reference, image, result.map);
    set_figures(result);
    return result;
}

}  // namespace tumble
