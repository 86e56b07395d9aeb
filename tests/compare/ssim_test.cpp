// SSIM against its definition in closed form and against scikit-image.
#include "compare/metrics/ssim.h"

#include "metric_pairs.h"

#include <gtest/gtest.h>

namespace tumble::ssim_test {
namespace {

TEST(Ssim, IsOneForEqualImages) {
    const SsimResult result = ssim(noise_pair().first, noise_pair().first);
    EXPECT_EQ(result.mean, 1.0);
    EXPECT_EQ(result.lowest, 1.0);
}

TEST(Ssim, OfPlainPicturesIsTheirLuminance) {
    constexpr double c1 = 2.55 * 2.55;
    for (const int a : {0, 100, 255})
        for (const int b : {0, 98, 200, 255}) {
            const double exact = (2.0 * a * b + c1) / (double(a) * a + double(b) * b + c1);
            EXPECT_NEAR(ssim(plain(30, 20, {a, a, a}), plain(30, 20, {b, b, b})).mean, exact, 1e-3) << a << " " << b;
        }
}

// structural_similarity() of scikit-image 0.19.3 of the lumas, with gaussian_weights=True, sigma=1.5,
// use_sample_covariance=False and data_range=255, as its documentation says for the values of Wang et al.
TEST(Ssim, HasTheMeansOfScikitImage) {
    EXPECT_NEAR(ssim(box_pair().first, box_pair().second).mean, 0.884946284750, 1e-6);
    EXPECT_NEAR(ssim(moved_pair().first, moved_pair().second).mean, 0.933278713071, 1e-6);
    EXPECT_NEAR(ssim(noise_pair().first, noise_pair().second).mean, 0.981959885401, 1e-6);
    EXPECT_NEAR(ssim(checker_pair().first, checker_pair().second).mean, 0.981384413125, 1e-6);
}

TEST(Ssim, TheLowestWindowIsAtTheChange) {
    Image a = plain(100, 80, {100, 100, 100}), b = a;
    fill(b, 60, 30, 3, 3, {140, 140, 140});
    const SsimResult result = ssim(a, b);
    EXPECT_NEAR(result.x, 61, 2);
    EXPECT_NEAR(result.y, 31, 2);
    EXPECT_LT(result.lowest, 0.5);
    EXPECT_GT(result.mean, 0.98);
    EXPECT_EQ(result.map.at(61 + 9, 31), 1.0f);  // its window has no changed pixel
    EXPECT_LT(result.map.at(61 + 6, 31), 1.0f);
}

TEST(Ssim, ChangesAtTheEdgeAreFound) {
    const Image a = noise_pair().first;
    Image b = a;
    set(b, 0, 0, {255, 255, 255});
    EXPECT_LT(ssim(a, b).lowest, 0.999);
    EXPECT_LT(ssim(plain(4, 3, {0, 0, 0}), plain(4, 3, {9, 9, 9})).mean, 0.999);  // smaller than a window
}

TEST(Ssim, TransparentPixelsHaveNoColor) {
    Image a = plain(20, 20, {255, 0, 0}), b = plain(20, 20, {0, 255, 0});
    for (std::size_t i = 3; i < a.pixels.size(); i += 4) a.pixels[i] = b.pixels[i] = 0;
    EXPECT_EQ(ssim(a, b).mean, 1.0);
    for (const int level : {0, 255}) EXPECT_LT(ssim(a, plain(20, 20, {level, level, level})).mean, 0.1) << level;
}

}  // namespace
}  // namespace tumble::ssim_test
