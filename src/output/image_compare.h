// Are two pictures the same for the eye? Renderings of one scene differ a little between processors (a few pixels on
// edges, by a few dozen levels), and that must pass; a small object moved by one pixel, a lost shadow or a shifted
// colour must not. Three tests, all of which must pass:
//
//   pixels     no more than a small fraction of all pixels differs by more than the tolerance in some channel
//   clusters   nowhere do several such pixels lie within one 8 x 8 window: noise is scattered, a moved edge is not
//   windows    nowhere does an 8 x 8 window differ by more than half the tolerance on average: a soft shadow stays
//              below the tolerance in each of its pixels, but covers many
#pragma once

#include "core/image.h"

#include <string>

namespace tumble {

struct CompareOptions {
    /// Levels (of 255) that a channel may differ without counting. Measured between instruction sets: hundreds of
    /// pixels by 1. 3 leaves room for other rounding in drivers, and is below what an eye sees.
    int tolerance = 3;
    /// Of all pixels, that may differ by more. Measured: 2 of 307,200 (6.5e-6), by up to 35 levels.
    double fraction = 1e-4;
};

struct Comparison {
    bool alike = false;
    std::string reason;                // the first test that failed, with its figures; empty when alike
    std::size_t differing_pixels = 0;  // any difference at all
    std::size_t failing_pixels = 0;    // beyond the tolerance
    double failing_fraction = 0.0;     // of all pixels
    int max_difference = 0;            // levels, largest over pixels and channels
    double worst_window = 0.0;         // levels, largest mean difference in an 8 x 8 window
    int worst_window_x = 0, worst_window_y = 0;   // its top left pixel
    int worst_cluster = 0;             // failing pixels, most in an 8 x 8 window
};

/// Compares red, green, blue and alpha. Throws InputError where the sizes differ (nothing can be said then).
Comparison compare_images(const Image& a, const Image& b, const CompareOptions& options = {});

/// The first picture dimmed to grey, with differences in red (beyond the tolerance) and blue (within it, magnified).
Image difference_image(const Image& a, const Image& b, const CompareOptions& options = {});

}  // namespace tumble
