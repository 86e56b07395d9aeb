// Compares two images as a viewer would. Renderings of one scene differ slightly between processors (a few pixels on
// edges, by a few dozen levels), which must pass. A small object moved by one pixel, a lost shadow or a shifted color
// must fail. All of four rules must hold:
//
//   pixels    at most a small fraction of all pixels differs by more than the tolerance in some channel
//   cluster   no 8 x 8 window has several such pixels: noise is scattered, a moved edge is not
//   window    no 8 x 8 window differs by more than half the tolerance on average: a soft shadow stays below the
// tolerance in each of its pixels, but covers many
//   shade     no 8 x 8 window has several pixels that are brighter, or several that are darker, by more than half the
//             tolerance in one channel: noise goes both ways and rounds to the next level, a changed color is off
//             everywhere in the same direction
//
// Windows start at every fourth row and column, and flush with the far edges. The window rule bounds single pixels as
// well: one that is off by 64 times the rule's limit (98 levels by default) is visible as a dot.
#pragma once

#include "core/image.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

struct CompareOptions {
    /// Difference of a channel, levels (of 255), that does not count. Measured between instruction sets: hundreds of
    /// pixels by 1. 3 leaves a margin for rounding in other drivers, and is invisible.
    int tolerance = 3;
    /// Fraction of all pixels that may differ by more. Measured: 2 of 307,200 (6.5e-6), by up to 35 levels.
    double fraction = 1e-4;
    /// Pixels of a window that may differ by more than the tolerance. Default: 4 + 64 fraction.
    std::optional<int> cluster = std::nullopt;
    /// Mean difference of a window, levels. Default: tolerance / 2 + 255 fraction.
    std::optional<double> window = std::nullopt;
    /// Pixels of a window that may be off by more than half the tolerance in one direction. Default: as many as
    /// cluster.
    std::optional<int> shade = std::nullopt;
};

/// Result of a rule and its place: the pixel that differs most for `pixels`, otherwise the worst window's top left
/// pixel (of equal ones the first from the top, then from the left).
struct CompareRule {
    const char* name = "";
    double figure = 0.0, limit = 0.0;  // levels for `window`, pixels for the others
    int x = 0, y = 0;
    bool holds() const { return figure <= limit; }
};

struct Comparison {
    bool alike = false;
    std::array<CompareRule, 4> rules;              // pixels, cluster, window, shade
    std::string reason;                            // a sentence for each failed rule, one per line
    std::size_t differing_pixels = 0;              // with any difference
    std::size_t failing_pixels = 0;                // beyond the tolerance
    int max_difference = 0;                        // levels, largest over pixels and channels
    int max_x = 0, max_y = 0;                      // its place
    double worst_window = 0.0;                     // levels, largest mean difference in an 8 x 8 window
    int worst_window_x = 0, worst_window_y = 0;    // its top left pixel
    int worst_cluster = 0;                         // failing pixels, most in an 8 x 8 window
    int worst_cluster_x = 0, worst_cluster_y = 0;  // its top left pixel
    int worst_shade = 0;                           // pixels, most in an 8 x 8 window that are off in one direction
    int worst_shade_x = 0, worst_shade_y = 0;      // its top left pixel
    int worst_shade_channel = 0;                   // red, green, blue, alpha
    bool worst_shade_brighter = false;             // the second image has the higher values
    Rectangle changed;                             // bounds of the failing pixels, or of all that differ if none fails
};

/// Names of the limits in sentences.
enum class LimitNames { options, keys };  // --window; the key window of tolerances.toml

/// Compares two images of one size from top to bottom, with the differences of the last eight rows in memory.
class ImageComparer {
public:
    ImageComparer(int width, int height, const CompareOptions& options);

    /// The next row of each: four bytes per pixel, red, green, blue and alpha.
    void add_row(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b);

    /// Call it after the last row.
    Comparison result(LimitNames names = LimitNames::options) const;

private:
    struct Sums {  // of a column or a window, down eight rows
        int difference = 0, failing = 0;
        std::array<int, 8> off{};  // pixels of each bit of offs_
    };
    /// Bounds of some pixels.
    struct Bounds {
        int left = 0, right = -1, top = 0, bottom = -1;
        void add(int column, int row);
        Rectangle rectangle() const;
    };

    std::size_t ring_row(int row) const;
    void add_differing_row(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b);
    void check_windows(int top, int bottom);
    void check_window(int left, int top, const Sums& sums);

    int width_, height_;
    CompareOptions options_;
    int row_ = 0;                            // index of the next row
    std::vector<int> columns_;               // starts of windows
    std::vector<std::uint8_t> differences_;  // levels, of the last eight rows, as a ring
    std::vector<std::uint8_t> offs_;         // the same of pixels that are off: a bit for each channel and direction
    std::vector<Sums> sums_;                 // over the columns of a row of windows
    int last_difference_ = -1;               // row
    Bounds differing_, failing_;
    Comparison found_;
};

/// The same for images in memory. Throws InputError if the sizes differ.
Comparison compare_images(const Image& a, const Image& b, const CompareOptions& options = {});

/// The same for picture files of any size: a few rows are in memory. Writes an image of the differences
/// (difference_image.h) where that file is named, also if the sizes differ. Throws InputError where an image is missing
/// or broken or the sizes differ, RunError where the difference cannot be written.
Comparison compare_png_files(const std::filesystem::path& a, const std::filesystem::path& b,
                             const CompareOptions& options, const std::filesystem::path& difference_file);

/// Throws InputError if the sizes differ.
void check_sizes(int width_a, int height_a, int width_b, int height_b);

}  // namespace tumble
