// Are two pictures the same for the eye? Renderings of one scene differ a little between processors (a few pixels on
// edges, by a few dozen levels), and that must pass; a small object moved by one pixel, a lost shadow or a shifted
// color must not. Three rules, all of which must hold:
//
//   pixels    no more than a small fraction of all pixels differs by more than the tolerance in some channel
//   cluster   nowhere do several such pixels lie within one 8 x 8 window: noise is scattered, a moved edge is not
//   window    nowhere does an 8 x 8 window differ by more than half the tolerance on average: a soft shadow stays
//             below the tolerance in each of its pixels, but covers many
//
// Windows begin at every fourth row and column, and flush with the far edges. The window rule bounds single pixels too: one
// that is off by 64 times the rule's limit (98 levels by default) is seen as a dot.
#pragma once

#include "core/image.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

struct CompareOptions {
    /// Levels (of 255) that a channel may differ without counting. Measured between instruction sets: hundreds of
    /// pixels by 1. 3 leaves room for other rounding in drivers, and is below what an eye sees.
    int tolerance = 3;
    /// Of all pixels, that may differ by more. Measured: 2 of 307,200 (6.5e-6), by up to 35 levels.
    double fraction = 1e-4;
    /// Pixels of a window that may differ by more than the tolerance. Not given: 4 + 64 fraction.
    std::optional<int> cluster = std::nullopt;
    /// Levels that a window may differ on average. Not given: tolerance / 2 + 255 fraction.
    std::optional<double> window = std::nullopt;
};

/// What a rule found, and where: the pixel that differs most for `pixels`, else the worst window's top left pixel (the
/// first from the top, then from the left, of equals).
struct CompareRule {
    const char* name = "";
    double figure = 0.0, limit = 0.0;   // pixels for `pixels` and `cluster`, levels for `window`
    int x = 0, y = 0;
    bool holds() const { return figure <= limit; }
};

struct Comparison {
    bool alike = false;
    std::array<CompareRule, 3> rules;  // pixels, cluster, window
    std::string reason;                // a sentence for each rule that does not hold, on lines of their own
    std::size_t differing_pixels = 0;  // any difference at all
    std::size_t failing_pixels = 0;    // beyond the tolerance
    double failing_fraction = 0.0;     // of all pixels
    int max_difference = 0;            // levels, largest over pixels and channels
    int max_x = 0, max_y = 0;          // where it is
    double worst_window = 0.0;         // levels, largest mean difference in an 8 x 8 window
    int worst_window_x = 0, worst_window_y = 0;     // its top left pixel
    int worst_cluster = 0;             // failing pixels, most in an 8 x 8 window
    int worst_cluster_x = 0, worst_cluster_y = 0;   // its top left pixel
};

/// Compares two pictures of one size from top to bottom. Of the rows it keeps the differences of the last eight.
class ImageComparer {
public:
    ImageComparer(int width, int height, const CompareOptions& options);

    /// The next row of each: four bytes a pixel, red, green, blue and alpha.
    void add_row(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b);

    /// After the last row.
    Comparison result() const;

private:
    void look_through_windows(int top, int bottom);
    std::span<const std::uint8_t> differences(int row) const;

    int width_, height_;
    CompareOptions options_;
    int row_ = 0;                             // the next one
    std::vector<int> lefts_;                  // where windows begin
    std::vector<std::uint8_t> differences_;   // levels, of the last eight rows, around the ring
    std::vector<int> sums_, failing_;         // of the columns of a row of windows: levels, pixels beyond the tolerance
    int last_difference_ = -1;                // row
    Comparison found_;
};

/// The same of pictures in memory. Throws InputError where the sizes differ (nothing can be said then).
Comparison compare_images(const Image& a, const Image& b, const CompareOptions& options = {});

/// A row of the first picture dimmed to gray, with differences in red (beyond the tolerance) and blue (within it, magnified).
void difference_row(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int tolerance, std::span<std::uint8_t> to);

/// The same of pictures in memory.
Image difference_image(const Image& a, const Image& b, const CompareOptions& options = {});

/// Throws InputError where the sizes differ.
void check_sizes(int width_a, int height_a, int width_b, int height_b);

}  // namespace tumble
