// Means of images, compared with the same in double precision.
#include "core/image_mean.h"
#include "core/color.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::image_mean_test {
namespace {

Image of_values(const std::vector<int>& values) {
    Image image(int(values.size()), 1);
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) image.pixels[4 * i + c] = static_cast<std::uint8_t>(values[i]);
        image.pixels[4 * i + 3] = 255;
    }
    return image;
}

TEST(ImageMean, EqualPixelsAreUnchanged) {
    std::vector<int> all(256);
    for (int i = 0; i < 256; ++i) all[std::size_t(i)] = i;
    const Image image = of_values(all);
    ImageMean mean;
    Image result;
    for (const int count : {1, 2, 3, 8, 64}) {
        for (int i = 0; i < count; ++i) mean.add(image);
        mean.take(result);
        EXPECT_EQ(result, image) << count;
    }
}

TEST(ImageMean, AddsLightNotNumbers) {
    ImageMean mean;
    Image result;
    mean.add(of_values({0, 255, 10}));
    mean.add(of_values({255, 255, 200}));
    mean.take(result);
    EXPECT_EQ(result.pixels[0], 188);  // half the light of white
    EXPECT_EQ(result.pixels[4], 255);
    const double half = 0.5 * (srgb_to_linear(10 / 255.0) + srgb_to_linear(200 / 255.0));
    EXPECT_EQ(result.pixels[8], std::lround(255.0 * linear_to_srgb(half)));
}

TEST(ImageMean, WeighsColorsByAlpha) {
    Image white = of_values({255, 255, 80}), other = of_values({0, 30, 80});
    white.pixels[3] = 51;  // a fifth
    other.pixels[3] = 0;   // its color does not count
    white.pixels[4 + 3] = other.pixels[4 + 3] = 0;
    other.pixels[8 + 3] = white.pixels[8 + 3] = 7;
    ImageMean mean(true);
    Image result;
    for (const int count : {1, 4, 128}) {
        for (int i = 0; i < count; ++i) {
            mean.add(white);
            mean.add(other);
        }
        mean.take(result);
        EXPECT_EQ(result.pixels, (std::vector<std::uint8_t>{255, 255, 255, 26, 0, 0, 0, 0, 80, 80, 80, 7})) << count;
    }
    white = of_values({255});
    other = of_values({0});
    white.pixels[3] = 100;
    other.pixels[3] = 200;
    mean.add(white);
    mean.add(other);
    mean.take(result);
    EXPECT_EQ(result.pixels[0], std::lround(255.0 * linear_to_srgb(1.0 / 3.0)));
    EXPECT_EQ(result.pixels[3], 150);
}

}  // namespace
}  // namespace tumble::image_mean_test
