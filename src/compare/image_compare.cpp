#include "compare/image_compare.h"

#include "compare/difference_image.h"
#include "compare/metrics/pixel_windows.h"
#include "core/check.h"
#include "core/error.h"
#include "output/picture_reader.h"
#include "output/png_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace tumble {
namespace {

// Two adjacent outliers occur in noise; a small box moved by one pixel gives more than four.
constexpr int cluster_limit = 4;  // failing pixels in a window

/// A bit for each channel and direction in which the second pixel is off by more than half the tolerance.
std::uint8_t off_bits(const std::uint8_t* a, const std::uint8_t* b, int tolerance) {
    unsigned bits = 0;
    for (int c = 0; c < 4; ++c) {
        const int shift = c == 3 ? b[3] - a[3] : seen_on_black(b, c) - seen_on_black(a, c);
        if (2 * shift > tolerance) bits |= 1u << (2 * c);
        if (-2 * shift > tolerance) bits |= 2u << (2 * c);
    }
    return static_cast<std::uint8_t>(bits);
}

/// True if windows start at this row.
bool is_window_start(int row, int size) {
    return row == std::max(0, size - window_side) || (row >= 0 && row % window_step == 0 && row + window_side < size);
}

std::array<CompareRule, 4> rules(const Comparison& c, std::size_t pixels, const CompareOptions& options) {
    // Pixels that the caller allows to differ may be anywhere, with any difference, so both window limits grow with
    // them.
    const double cluster =
        options.cluster ? *options.cluster : cluster_limit + window_side * window_side * options.fraction;
    const double mean = options.window ? *options.window : 0.5 * options.tolerance + 255.0 * options.fraction;
    // Rounded up, so that one pixel of a small image may be noise.
    const double count = std::ceil(options.fraction * double(pixels));
    const double shade = options.shade ? *options.shade : cluster;
    return {{{"pixels", double(c.failing_pixels), count, c.max_x, c.max_y},
             {"cluster", double(c.worst_cluster), std::floor(cluster), c.worst_cluster_x, c.worst_cluster_y},
             {"window", c.worst_window, mean, c.worst_window_x, c.worst_window_y},
             {"shade", double(c.worst_shade), std::floor(shade), c.worst_shade_x, c.worst_shade_y}}};
}

std::string sentence(const CompareRule& rule, const Comparison& c, const CompareOptions& options, LimitNames names) {
    const std::string_view name = rule.name;
    const std::string hint = names == LimitNames::keys ? fmt::format("key {}", name) : fmt::format("see --{}", name);
    if (name == "pixels")
        return fmt::format(
            "rule pixels: {:.0f} pixels differ by more than {} levels (at most {:.0f} may, a fraction of {:.4g}; "
            "{}); the most by {}, at x {}, y {}",
            rule.figure, options.tolerance, rule.limit, options.fraction,
            names == LimitNames::keys ? "keys levels, fraction" : "see --tolerance, --fraction", c.max_difference,
            rule.x, rule.y);
    if (name == "cluster")
        return fmt::format(
            "rule cluster: {:.0f} pixels of the 8 x 8 from x {}, y {} on differ by more than {} levels "
            "(at most {:.0f} may; {})",
            rule.figure, rule.x, rule.y, options.tolerance, rule.limit, hint);
    if (name == "shade") {
        constexpr std::array<std::string_view, 4> channels{"red", "green", "blue", "alpha"};
        return fmt::format(
            "rule shade: {:.0f} pixels of the 8 x 8 from x {}, y {} on have {} {} by {} levels or more (at most {:.0f} "
            "may; {})",
            rule.figure, rule.x, rule.y, c.worst_shade_brighter ? "more" : "less",
            channels[std::size_t(c.worst_shade_channel)], options.tolerance / 2 + 1, rule.limit, hint);
    }
    return fmt::format(
        "rule window: the 8 x 8 pixels from x {}, y {} on differ by {:.4g} levels on average "
        "(at most {:.4g} may; {})",
        rule.x, rule.y, rule.figure, rule.limit, hint);
}

}  // namespace

void check_sizes(int width_a, int height_a, int width_b, int height_b) {
    if (width_a != width_b || height_a != height_b)
        throw InputError(fmt::format("pictures of different sizes cannot be compared ({} x {} and {} x {})", width_a,
                                     height_a, width_b, height_b));
}

void ImageComparer::Bounds::add(int column, int row) {
    const bool empty = right < left;
    left = empty ? column : std::min(left, column);
    right = std::max(right, column);
    top = empty ? row : top;
    bottom = row;
}

Rectangle ImageComparer::Bounds::rectangle() const { return {left, top, right + 1 - left, bottom + 1 - top}; }

ImageComparer::ImageComparer(int width, int height, const CompareOptions& options)
    : width_(width),
      height_(height),
      options_(options),
      columns_(window_starts(width)),
      differences_(std::size_t(width) * window_side),
      offs_(std::size_t(width) * window_side),
      sums_(std::size_t(width)) {}

/// The first element of a row's differences.
std::size_t ImageComparer::ring_row(int row) const { return std::size_t(row % window_side) * std::size_t(width_); }

void ImageComparer::add_row(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
    TUMBLE_CHECK_LT(row_, height_);
    if (std::equal(a.begin(), a.end(), b.begin(), b.end())) {
        std::fill_n(differences_.begin() + std::ptrdiff_t(ring_row(row_)), width_, std::uint8_t(0));
        std::fill_n(offs_.begin() + std::ptrdiff_t(ring_row(row_)), width_, std::uint8_t(0));
    } else {
        add_differing_row(a, b);
    }
    ++row_;
    const int top = std::max(0, row_ - window_side);
    const bool full = row_ >= window_side || row_ == height_;
    if (full && is_window_start(top, height_) && last_difference_ >= top) check_windows(top, row_);
}

void ImageComparer::add_differing_row(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
    std::uint8_t* const to = differences_.data() + ring_row(row_);
    std::uint8_t* const offs = offs_.data() + ring_row(row_);
    for (int x = 0; x < width_; ++x) {
        const std::uint8_t *const pixel_a = &a[4 * std::size_t(x)], *const pixel_b = &b[4 * std::size_t(x)];
        const int d = pixel_difference(pixel_a, pixel_b);
        to[x] = static_cast<std::uint8_t>(d);
        offs[x] = 2 * d > options_.tolerance ? off_bits(pixel_a, pixel_b, options_.tolerance) : std::uint8_t(0);
        if (d == 0) continue;
        ++found_.differing_pixels;
        differing_.add(x, row_);
        last_difference_ = row_;
        if (d > options_.tolerance) {
            ++found_.failing_pixels;
            failing_.add(x, row_);
        }
        if (d > found_.max_difference) {
            found_.max_difference = d;
            found_.max_x = x;
            found_.max_y = row_;
        }
    }
}

/// Evaluates the windows between two rows.
void ImageComparer::check_windows(int top, int bottom) {
    std::fill(sums_.begin(), sums_.end(), Sums{});
    for (int y = top; y < bottom; ++y) {
        const std::size_t first = ring_row(y);
        for (std::size_t x = 0; x < sums_.size(); ++x) {
            const int difference = differences_[first + x];
            if (difference == 0) continue;
            sums_[x].difference += difference;
            sums_[x].failing += difference > options_.tolerance ? 1 : 0;
            for (unsigned bits = offs_[first + x]; bits != 0; bits &= bits - 1)
                ++sums_[x].off[std::size_t(std::countr_zero(bits))];
        }
    }
    for (const int left : columns_) {
        const int right = std::min(left + window_side, width_);
        Sums sum;
        for (int x = left; x < right; ++x) {
            sum.difference += sums_[std::size_t(x)].difference;
            sum.failing += sums_[std::size_t(x)].failing;
            for (std::size_t i = 0; i < sum.off.size(); ++i) sum.off[i] += sums_[std::size_t(x)].off[i];
        }
        if (sum.difference > 0) check_window(left, top, sum);
    }
}

/// An image smaller than a window is one window, with the same weight for each pixel.
void ImageComparer::check_window(int left, int top, const Sums& sums) {
    constexpr double pixels = window_side * window_side;
    if (sums.failing > found_.worst_cluster) {
        found_.worst_cluster = sums.failing;
        found_.worst_cluster_x = left;
        found_.worst_cluster_y = top;
    }
    if (sums.difference / pixels > found_.worst_window) {
        found_.worst_window = sums.difference / pixels;
        found_.worst_window_x = left;
        found_.worst_window_y = top;
    }
    for (int i = 0; i < 8; ++i) {
        if (sums.off[std::size_t(i)] <= found_.worst_shade) continue;
        found_.worst_shade = sums.off[std::size_t(i)];
        found_.worst_shade_x = left;
        found_.worst_shade_y = top;
        found_.worst_shade_channel = i / 2;
        found_.worst_shade_brighter = i % 2 == 0;
    }
}

Comparison ImageComparer::result(LimitNames names) const {
    TUMBLE_CHECK_EQ(row_, height_);
    Comparison result = found_;
    const std::size_t pixels = std::size_t(width_) * std::size_t(height_);
    if (result.differing_pixels > 0) result.changed = (result.failing_pixels > 0 ? failing_ : differing_).rectangle();
    result.rules = rules(result, pixels, options_);
    for (const CompareRule& rule : result.rules)
        if (!rule.holds())
            result.reason +=
                fmt::format("{}{}", result.reason.empty() ? "" : "\n", sentence(rule, result, options_, names));
    result.alike = result.reason.empty();
    return result;
}

Comparison compare_images(const Image& a, const Image& b, const CompareOptions& options) {
    check_sizes(a.width, a.height, b.width, b.height);
    ImageComparer comparer(a.width, a.height, options);
    const std::size_t bytes = 4 * std::size_t(a.width);
    for (int y = 0; y < a.height; ++y) comparer.add_row({a.at(0, y), bytes}, {b.at(0, y), bytes});
    return comparer.result();
}

Comparison compare_png_files(const std::filesystem::path& a, const std::filesystem::path& b,
                             const CompareOptions& options, const std::filesystem::path& difference_file) {
    PictureRows rows_a(a), rows_b(b);
    const ImageSize size = rows_a.size();
    // A picture of the difference shows two sizes as well.
    if (!difference_file.empty() && size != rows_b.size()) write_difference_image(a, b, options, difference_file);
    check_sizes(size.width, size.height, rows_b.size().width, rows_b.size().height);
    ImageComparer comparer(size.width, size.height, options);
    std::optional<PngRowWriter> difference;
    std::vector<std::uint8_t> row;
    if (!difference_file.empty()) {
        difference.emplace(difference_file, size.width, size.height);
        row.resize(4 * std::size_t(size.width));
    }
    for (int y = 0; y < size.height; ++y) {
        const auto row_a = rows_a.next(), row_b = rows_b.next();
        comparer.add_row(row_a, row_b);
        if (!difference) continue;
        difference_row(row_a, row_b, options.tolerance, row);
        difference->add_row(row);
    }
    if (difference) difference->finish();
    return comparer.result();
}

}  // namespace tumble
