#include "compare/metrics/metric_map.h"

#include <gtest/gtest.h>

namespace tumble::heat_map_test {
namespace {

int lightness(const Image& image, int x) { return 2 * image.at(x, 0)[0] + 5 * image.at(x, 0)[1] + image.at(x, 0)[2]; }

TEST(HeatMap, GrowsLighterFromColdToHot) {
    MetricMap map(256, 1);
    for (int x = 0; x < 256; ++x) map.row(0)[x] = float(x) / 255.0f;
    const Image image = heat_map(map);
    for (int x = 1; x < 256; ++x) EXPECT_GE(lightness(image, x), lightness(image, x - 1) - 8) << x;
    const auto color = [&](int x) {
        return std::array<int, 4>{image.at(x, 0)[0], image.at(x, 0)[1], image.at(x, 0)[2], image.at(x, 0)[3]};
    };
    // matplotlib 3.6's "magma" at 0, 128 and 255.
    EXPECT_EQ(color(0), (std::array<int, 4>{0, 0, 4, 255}));
    EXPECT_EQ(color(128), (std::array<int, 4>{183, 55, 121, 255}));
    EXPECT_EQ(color(255), (std::array<int, 4>{252, 253, 191, 255}));
}

TEST(HeatMap, ValuesBeyondTheEndsHaveTheirColors) {
    MetricMap map(3, 1);
    map.values = {-0.5f, 2.0f, 2.5f};
    const Image image = heat_map(map, 2.0f);
    EXPECT_EQ(image.at(0, 0)[0], 0);
    EXPECT_EQ(image.at(1, 0)[0], 252);
    EXPECT_EQ(image.at(2, 0)[0], 252);
}

}  // namespace
}  // namespace tumble::heat_map_test
