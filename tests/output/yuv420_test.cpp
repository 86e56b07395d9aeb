// Conversion to video planes: compared with the formula in doubles, by regions, at every alignment.
#include "output/yuv420.h"
#include "output/video_pixels.h"

#include "support/pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tumble::yuv420_test {
namespace {

struct Ycc {
    double y, cb, cr;
};

/// ITU-R BT.709, limited range, from values of 0 to 255.
Ycc bt709(double r, double g, double b) {
    const double luma = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    return {16.0 + 219.0 * luma / 255.0, 128.0 + 224.0 * (b - luma) / 1.8556 / 255.0,
            128.0 + 224.0 * (r - luma) / 1.5748 / 255.0};
}

Image noise(int width, int height, unsigned seed) {
    Image image(width, height);
    std::mt19937 random(seed);
    for (std::uint8_t& byte : image.pixels) byte = static_cast<std::uint8_t>(random());  // the fourth byte as well
    return image;
}

std::vector<std::uint8_t> converted(const Image& image) {
    std::vector<std::uint8_t> planes(yuv420_bytes(image.width, image.height));
    convert_to_yuv420(image, {0, 0, image.width, image.height}, planes);
    return planes;
}

/// The value of plane 0, 1 or 2 that covers the pixel.
int value_at(const std::vector<std::uint8_t>& planes, const Image& image, int plane, int x, int y) {
    const int width = image.width, height = image.height;
    if (plane == 0) return planes[std::size_t(y * width + x)];
    return planes[std::size_t(width * height + (plane - 1) * (width / 2) * (height / 2) + y / 2 * (width / 2) + x / 2)];
}

TEST(Yuv420, IsTheFormula) {
    const Image image = noise(256, 128, 1);
    const std::vector<std::uint8_t> planes = converted(image);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const std::uint8_t* p = image.at(x, y);
            EXPECT_NEAR(value_at(planes, image, 0, x, y), bt709(p[0], p[1], p[2]).y, 0.51);
            double mean[3] = {};
            for (int i = 0; i < 4; ++i)
                for (int c = 0; c < 3; ++c) mean[c] += 0.25 * image.at((x & ~1) + i % 2, (y & ~1) + i / 2)[c];
            const Ycc color = bt709(mean[0], mean[1], mean[2]);
            EXPECT_NEAR(value_at(planes, image, 1, x, y), color.cb, 0.52);
            EXPECT_NEAR(value_at(planes, image, 2, x, y), color.cr, 0.52);
        }
}

TEST(Yuv420, KnownColors) {
    const auto first_of = [](Pixel color) {
        const Image image = plain(16, 2, color);
        const std::vector<std::uint8_t> planes = converted(image);
        return std::array{value_at(planes, image, 0, 9, 1), value_at(planes, image, 1, 9, 1),
                          value_at(planes, image, 2, 9, 1)};
    };
    EXPECT_EQ(first_of({0, 0, 0}), (std::array{16, 128, 128}));
    EXPECT_EQ(first_of({255, 255, 255}), (std::array{235, 128, 128}));
    EXPECT_EQ(first_of({255, 0, 0}), (std::array{63, 102, 240}));
    EXPECT_EQ(first_of({0, 0, 255}), (std::array{32, 240, 118}));
    for (int grey = 0; grey < 256; ++grey) {
        EXPECT_EQ(first_of({grey, grey, grey})[1], 128) << grey;
        EXPECT_EQ(first_of({grey, grey, grey})[2], 128) << grey;
    }
}

TEST(Yuv420, WideAndNarrowImagesAgree) {
    // Widths below 8 are converted square by square; the same pixels in a wide picture eight at a time.
    const Image wide = noise(64, 8, 2);
    const std::vector<std::uint8_t> planes = converted(wide);
    for (int left = 0; left < 64; left += 2) {
        Image narrow(2, 8);
        for (int y = 0; y < 8; ++y) std::copy_n(wide.at(left, y), 8, narrow.at(0, y));
        const std::vector<std::uint8_t> alone = converted(narrow);
        for (int plane = 0; plane < 3; ++plane)
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 2; ++x)
                    ASSERT_EQ(value_at(planes, wide, plane, left + x, y), value_at(alone, narrow, plane, x, y));
    }
}

TEST(Yuv420, PartsMakeTheWhole) {
    std::mt19937 random(3);
    const Rectangle whole{0, 0, 50, 38};
    for (const PixelFormat form : {PixelFormat::yuv420, PixelFormat::yuva420, PixelFormat::rgba}) {
        for (int odd = 0; odd < 2; ++odd) {
            Image image = noise(50 - odd, 38 - odd, 4);
            const Rectangle all{0, 0, image.width, image.height};
            VideoPixels parts(form, image.width, image.height);
            parts.update(image, {&all, 1});
            for (int round = 0; round < 40; ++round) {
                std::vector<Rectangle> changed;
                for (unsigned i = 0; i < random() % 4; ++i) {
                    const int x = int(random() % unsigned(image.width)), y = int(random() % unsigned(image.height));
                    changed.push_back({x, y, 1 + int(random() % unsigned(image.width - x)),
                                       1 + int(random() % unsigned(image.height - y))});
                    const Rectangle& r = changed.back();
                    for (int row = r.y; row < r.y + r.height; ++row)
                        for (int c = 0; c < 4 * r.width; ++c)
                            image.at(r.x, row)[c] = static_cast<std::uint8_t>(random());
                }
                parts.update(image, changed);
                VideoPixels anew(form, image.width, image.height);
                anew.update(image, {&all, 1});
                ASSERT_TRUE(std::ranges::equal(parts.bytes(), anew.bytes())) << round;
            }
        }
    }
    EXPECT_EQ(frame_bytes(PixelFormat::yuv420, 49, 37), yuv420_bytes(whole.width, whole.height));
    EXPECT_EQ(frame_bytes(PixelFormat::yuva420, 49, 37), yuva420_bytes(whole.width, whole.height));
}

TEST(Yuva420, CoveredColorsReachBeyondTheirEdge) {
    Image image(48, 32);  // black without coverage, but for a half covered column in the second block
    for (int y = 0; y < image.height; ++y) {
        set(image, 20, y, {200, 60, 40});
        image.at(20, y)[3] = 128;
    }
    std::vector<std::uint8_t> planes(yuva420_bytes(48, 32));
    Image filled;
    convert_to_yuva420(image, {0, 0, 48, 32}, filled, planes);
    const std::vector<std::uint8_t> same = converted(plain(48, 32, {200, 60, 40})),
                                    black = converted(plain(48, 32, {}));
    const std::size_t alpha = yuv420_bytes(48, 32);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const std::vector<std::uint8_t>& wanted = x / 16 == 1 ? same : black;
            for (int plane = 0; plane < 3; ++plane)
                ASSERT_EQ(value_at(planes, image, plane, x, y), value_at(wanted, image, plane, x, y));
            ASSERT_EQ(planes[alpha + std::size_t(48 * y + x)], x == 20 ? 128 : 0);
        }
}

}  // namespace
}  // namespace tumble::yuv420_test
