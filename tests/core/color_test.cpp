#include "core/color.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::color_test {
namespace {

TEST(Color, EveryLevelSurvivesTheWayToLinearLightAndBack) {
    double last = -1.0;
    for (int level = 0; level < 256; ++level) {
        const double linear = srgb_to_linear(level / 255.0);
        EXPECT_GT(linear, last);
        EXPECT_NEAR(linear_to_srgb(linear) * 255.0, level, 1e-4) << level;
        last = linear;
    }
}

TEST(Color, KnownValues) {  // IEC 61966-2-1
    EXPECT_DOUBLE_EQ(srgb_to_linear(0.0), 0.0);
    EXPECT_DOUBLE_EQ(srgb_to_linear(1.0), 1.0);
    EXPECT_NEAR(srgb_to_linear(0.5), 0.21404114048223255, 1e-15);
    EXPECT_NEAR(srgb_to_linear(0.04045), 0.0031308049535603713, 1e-15);
    EXPECT_NEAR(linear_to_srgb(0.18), 0.46135612950044164, 1e-15);  // middle gray
    const auto linear = to_linear(Color{255, 128, 0});
    EXPECT_DOUBLE_EQ(linear[0], 1.0);
    EXPECT_NEAR(linear[1], 0.21586050011389926, 1e-15);
    EXPECT_DOUBLE_EQ(linear[2], 0.0);
}

TEST(Color, TextIsReadInEitherCaseAndWrittenInLowerCase) {
    EXPECT_EQ(parse_color("#C8853c"), (Color{0xc8, 0x85, 0x3c}));
    EXPECT_EQ(to_string(Color{0xc8, 0x85, 0x3c}), "#c8853c");
    for (int level = 0; level < 256; ++level) {
        const auto byte = static_cast<std::uint8_t>(level);
        const Color color{byte, static_cast<std::uint8_t>(255 - level), byte};
        EXPECT_EQ(parse_color(to_string(color)), color);
    }
}

TEST(Color, OtherTextIsNone) {
    for (const char* text :
         {"", "#", "c8853c", "#c8853", "#c8853c0", "#c8853g", "#-18000", "# 18000", "#+18000", "red"}) {
        EXPECT_FALSE(parse_color(text)) << text;
    }
}

}  // namespace
}  // namespace tumble::color_test
