// Comparison of pictures: noise between processors passes, and a visible change fails.
#include "compare/difference_image.h"
#include "core/error.h"

#include "support/pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace tumble::image_compare_test {
namespace {

constexpr int width = 640, height = 480;  // 307,200 pixels, as in the measurement of the noise

void shift(Image& image, int x, int y, int levels) {
    for (int c = 0; c < 3; ++c) image.at(x, y)[c] = std::uint8_t(std::clamp(image.at(x, y)[c] + levels, 0, 255));
}

TEST(Compare, TheSameIsAlike) {
    const Comparison result = compare_images(landscape(width, height), landscape(width, height));
    EXPECT_TRUE(result.alike);
    EXPECT_TRUE(result.reason.empty());
    EXPECT_EQ(result.differing_pixels, 0u);
    EXPECT_EQ(result.worst_window, 0.0);
}

TEST(Compare, NoiseBetweenInstructionSetsPasses) {
    const Image a = landscape(width, height);
    Image few = a;  // 2 pixels by up to 35 levels, even adjacent
    shift(few, 200, 300, 35);
    shift(few, 201, 300, -30);
    EXPECT_TRUE(compare_images(a, few).alike) << compare_images(a, few).reason;
    Image many = a;  // 372 by 1
    std::mt19937 random(3);
    for (int i = 0; i < 372; ++i)
        shift(many, int(random() % width), int(random() % height), random() % 2 == 0 ? 1 : -1);
    const Comparison result = compare_images(a, many);
    EXPECT_TRUE(result.alike) << result.reason;
    EXPECT_EQ(result.max_difference, 1);
    EXPECT_GT(result.differing_pixels, 350u);
}

TEST(Compare, ABoxMovedByOnePixelFails) {
    for (const auto& [w, h] : {std::pair{1280, 720}, {640, 480}, {160, 90}})
        for (const int side : {4, 6, 12, 40})
            for (const int contrast : {24, 60})
                for (const auto& [dx, dy] : {std::pair{1, 0}, {0, 1}, {-1, 0}, {1, 1}}) {
                    const int x = w / 2 + 3, y = h / 2 + 1;
                    Image a = plain(w, h, {120, 120, 120}), b = a;
                    const Pixel color{120 + contrast, 120, 120 - contrast};
                    fill(a, x, y, side, side, color);
                    fill(b, x + dx, y + dy, side, side, color);
                    EXPECT_FALSE(compare_images(a, b).alike)
                        << w << " wide, box of " << side << ", contrast " << contrast;
                }
}

TEST(Compare, ALostSoftShadowFails) {
    // A blur of few levels: darkest in the middle, nowhere beyond the tolerance for a single pixel when weak.
    for (const double depth : {3.0, 10.0, 40.0}) {
        const Image a = landscape(width, height);
        Image b = a;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const double r2 = (x - 300.0) * (x - 300.0) + 4.0 * (y - 350.0) * (y - 350.0);
                shift(b, x, y, -int(std::lround(depth * std::exp(-r2 / (2.0 * 15.0 * 15.0)))));
            }
        const Comparison result = compare_images(a, b);
        EXPECT_FALSE(result.alike) << depth << " levels";
        EXPECT_NEAR(result.worst_window_x, 300, 12);
        EXPECT_NEAR(result.worst_window_y, 350, 12);
    }
}

TEST(Compare, AShiftedColorFails) {
    for (const int channel : {0, 1, 2})
        for (const int levels : {8, -8, 2}) {
            const Image a = landscape(width, height);
            Image b = a;
            for (std::size_t i = std::size_t(channel); i < b.pixels.size(); i += 4)
                b.pixels[i] = std::uint8_t(std::clamp(b.pixels[i] + levels, 0, 255));
            EXPECT_FALSE(compare_images(a, b).alike) << "channel " << channel << " by " << levels;
        }
}

TEST(Compare, AShiftOfOneLevelPasses) {
    const Image a = plain(width, height, {100, 100, 100}), b = plain(width, height, {101, 100, 99});
    EXPECT_TRUE(compare_images(a, b).alike) << compare_images(a, b).reason;
}

TEST(Compare, ManyScatteredPixelsFail) {
    const Image a = landscape(width, height);
    Image b = a;
    for (int i = 0; i < 60; ++i) shift(b, 10 * i + 5, 8 * i, 20);  // far apart: no cluster, but twice too many
    const Comparison result = compare_images(a, b);
    EXPECT_FALSE(result.alike);
    EXPECT_EQ(result.failing_pixels, 60u);
    EXPECT_EQ(result.worst_cluster, 1);
    EXPECT_TRUE(compare_images(a, b, {.fraction = 3e-4}).alike);
}

TEST(Compare, EveryPlaceIsChecked) {
    // Three rows of 3 in each corner and at odd sizes: the windows reach the edges.
    for (const auto& [w, h] : {std::pair{101, 67}, {64, 64}, {9, 9}, {5, 5}})
        for (const int x : {0, w - 3})
            for (const int y : {0, h - 3}) {
                const Image a = plain(w, h, {50, 50, 50});
                Image b = a;
                fill(b, x, y, 3, 3, {80, 50, 50});
                const Comparison result = compare_images(a, b, {.fraction = 0.02});
                EXPECT_EQ(result.worst_cluster, 9) << w << " x " << h << " at " << x << ", " << y;
                EXPECT_FALSE(result.alike);
            }
}

TEST(Compare, LooserOptionsAllowMore) {
    const Image a = plain(100, 100, {0, 0, 0}), b = plain(100, 100, {255, 255, 255});
    EXPECT_FALSE(compare_images(a, b).alike);
    EXPECT_TRUE(compare_images(a, b, {.fraction = 1.0}).alike);
    Image c = a;
    shift(c, 3, 3, 1);
    EXPECT_FALSE(compare_images(a, c, {.tolerance = 0, .fraction = 0.0}).alike) << "no tolerance: exact";
    const Image d = plain(100, 100, {5, 5, 5});
    EXPECT_FALSE(compare_images(a, d).alike);
    EXPECT_FALSE(compare_images(a, d, {.tolerance = 5, .fraction = 0.0}).alike)
        << "within the tolerance, but everywhere";
    EXPECT_TRUE(compare_images(a, d, {.tolerance = 10, .fraction = 0.0}).alike);
    EXPECT_TRUE(compare_images(a, a, {.tolerance = 0, .fraction = 0.0}).alike);
}

TEST(Compare, EveryFailedRuleIsNamedWithItsValueAndPlace) {
    const Image a = plain(width, height, {120, 120, 120});
    Image dot = a;  // 31 of 307,200 pixels may differ by any amount, but a window's mean is bounded
    shift(dot, 100, 60, 134);
    const Comparison one = compare_images(a, dot);
    EXPECT_EQ(one.reason,
              "rule window: the 8 x 8 pixels from x 96, y 56 on differ by 2.094 levels on average "
              "(at most 1.526 may; see --window)");
    EXPECT_EQ(one.max_x, 100);
    EXPECT_EQ(one.max_y, 60);
    EXPECT_TRUE(one.rules[0].holds() && one.rules[1].holds() && !one.rules[2].holds());

    Image box = a;
    fill(box, 20, 40, 9, 9, {220, 120, 120});
    const Comparison all = compare_images(a, box);
    EXPECT_EQ(
        all.reason,
        "rule pixels: 81 pixels differ by more than 3 levels (at most 31 may, a fraction of 0.0001; see --tolerance, "
        "--fraction); the most by 100, at x 20, y 40\n"
        "rule cluster: 64 pixels of the 8 x 8 from x 20, y 40 on differ by more than 3 levels (at most 4 may; see "
        "--cluster)\n"
        "rule window: the 8 x 8 pixels from x 20, y 40 on differ by 100 levels on average (at most 1.526 may; see "
        "--window)\n"
        "rule shade: 64 pixels of the 8 x 8 from x 20, y 40 on have more red by 2 levels or more (at most 4 may; see "
        "--shade)");
}

TEST(Compare, ASmallRegionOffByTwoLevelsFails) {
    const Image a = landscape(width, height);
    for (int channel = 0; channel < 3; ++channel) {
        Image b = a, noise = a;
        for (int y = 100; y < 103; ++y)
            for (int x = 200; x < 203; ++x) {
                b.at(x, y)[channel] = std::uint8_t(b.at(x, y)[channel] - 2);
                noise.at(x, y)[channel] = std::uint8_t(noise.at(x, y)[channel] + ((x + y) % 2 == 0 ? -2 : 1));
            }
        const Comparison off = compare_images(a, b);
        EXPECT_FALSE(off.alike);
        EXPECT_FALSE(off.rules[3].holds());
        EXPECT_TRUE(off.rules[0].holds() && off.rules[1].holds() && off.rules[2].holds());
        EXPECT_EQ(off.rules[3].figure, 9.0);
        EXPECT_EQ(compare_images(a, noise).rules[3].figure, 5.0);  // of one direction
        CompareOptions options;
        options.tolerance = 4;  // and half of it are two levels
        EXPECT_TRUE(compare_images(a, b, options).alike);
    }
}

TEST(Compare, EachRuleCanBeSet) {
    const Image a = plain(width, height, {120, 120, 120});
    Image dot = a;
    shift(dot, 100, 60, 134);
    CompareOptions options;
    options.window = 2.0;
    EXPECT_FALSE(compare_images(a, dot, options).alike);
    options.window = 2.1;
    EXPECT_TRUE(compare_images(a, dot, options).alike);

    Image row = a;  // five adjacent pixels
    for (int x = 40; x < 45; ++x) shift(row, x, 60, 10);
    EXPECT_FALSE(compare_images(a, row).alike);
    options = {};
    options.cluster = 5;
    EXPECT_TRUE(compare_images(a, row, options).alike) << compare_images(a, row, options).reason;
    options.cluster = 0;
    Image one = a;
    shift(one, 40, 60, 10);
    EXPECT_TRUE(compare_images(a, one).alike);
    EXPECT_FALSE(compare_images(a, one, options).alike);
    options = {};
    options.fraction = 0.0;
    EXPECT_FALSE(compare_images(a, one, options).alike);
    EXPECT_FALSE(compare_images(a, one, options).rules[0].holds());
    // A rule that is set explicitly does not grow with the fraction.
    options.fraction = 1.0;
    options.window = 0.1;
    EXPECT_FALSE(compare_images(a, one, options).alike);
}

TEST(Compare, AlphaCounts) {
    const Image a = plain(20, 20, {50, 50, 50});
    Image b = a;
    for (std::size_t i = 3; i < b.pixels.size(); i += 4) b.pixels[i] = 200;
    EXPECT_FALSE(compare_images(a, b).alike);
}

TEST(Compare, ColorsCountAsFarAsAlphaShowsThem) {
    Image a = plain(20, 20, {50, 50, 50}), b = plain(20, 20, {250, 0, 90});
    const auto set_alpha = [](Image& image, std::uint8_t alpha) {
        for (std::size_t i = 3; i < image.pixels.size(); i += 4) image.pixels[i] = alpha;
    };
    for (const auto& [alpha, difference] : {std::pair{0, 0}, {3, 2}, {51, 40}, {255, 200}}) {
        set_alpha(a, std::uint8_t(alpha));
        set_alpha(b, std::uint8_t(alpha));
        EXPECT_EQ(compare_images(a, b).max_difference, difference) << alpha;
    }
}

TEST(Compare, OtherSizesCannotBeCompared) {
    EXPECT_THROW(compare_images(plain(10, 10, {}), plain(10, 11, {})), InputError);
}

TEST(Compare, TheDifferenceOfTwoSizesShowsBothAndMarksWhatOneHas) {
    const Image wide = plain(12, 6, {90, 90, 90}), tall = plain(8, 10, {90, 90, 90});
    const Image d = difference_image(wide, tall);
    EXPECT_EQ(d.width, 12);
    EXPECT_EQ(d.height, 10);
    const auto color = [&](int x, int y) { return std::vector<int>(d.at(x, y), d.at(x, y) + 4); };
    EXPECT_EQ(color(3, 3), (std::vector<int>{30, 30, 30, 255}));    // both have it, alike
    EXPECT_EQ(color(9, 3), (std::vector<int>{126, 126, 30, 255}));  // only the first: yellow
    EXPECT_EQ(color(3, 8), (std::vector<int>{30, 126, 30, 255}));   // only the second: green
    EXPECT_EQ(color(9, 8), (std::vector<int>{0, 0, 0, 255}));       // neither
    const Image turned = difference_image(tall, wide);
    EXPECT_EQ(turned.at(9, 3)[0], 30);
    EXPECT_EQ(turned.at(9, 3)[1], 126);
}

TEST(Compare, TheDifferenceIsVisible) {
    const Image a = plain(20, 20, {90, 90, 90});
    Image b = a;
    shift(b, 3, 4, 50);
    shift(b, 5, 6, 1);
    const Image d = difference_image(a, b);
    EXPECT_GT(d.at(3, 4)[0], 200);
    EXPECT_LT(d.at(3, 4)[2], 60);
    EXPECT_GT(d.at(5, 6)[2], 90);
    EXPECT_LT(d.at(5, 6)[0], 60);
    EXPECT_EQ(d.at(0, 0)[0], d.at(0, 0)[2]);
    EXPECT_EQ(d.at(0, 0)[3], 255);
}

}  // namespace
}  // namespace tumble::image_compare_test
