// Frame rates as fractions and as doubles, which name each other.
#include "core/frame_rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>

namespace tumble::frame_rate_test {
namespace {

TEST(FrameRate, IsTheFractionMeant) {
    EXPECT_EQ(to_frame_rate(60.0), (FrameRate{60, 1}));
    EXPECT_EQ(to_frame_rate(29.97), (FrameRate{2997, 100}));
    EXPECT_EQ(to_frame_rate(30000.0 / 1001.0), (FrameRate{30000, 1001}));
    EXPECT_EQ(to_frame_rate(0.5), (FrameRate{1, 2}));
    EXPECT_EQ(to_frame_rate(1.0 / 3.0), (FrameRate{1, 3}));
    EXPECT_EQ(to_frame_rate(12.5), (FrameRate{25, 2}));
    EXPECT_EQ(to_frame_rate(1e6), (FrameRate{1000000, 1}));
    EXPECT_EQ(to_frame_rate(0.001), (FrameRate{1, 1000}));
    EXPECT_EQ(to_frame_rate(60.0).text(), "60/1");
}

TEST(FrameRate, IsCloseForAnyNumber) {
    for (double fps = 0.0013; fps < 1e6; fps *= 1.0371) {
        const FrameRate rate = to_frame_rate(fps);
        ASSERT_GE(rate.numerator, 1);
        ASSERT_GE(rate.denominator, 1);
        EXPECT_LE(rate.numerator, largest_rate_term);
        EXPECT_LE(rate.denominator, largest_rate_term);
        // A best fraction p/q is closer than 1/(q * limit): the worst case is a numerator at the limit.
        EXPECT_NEAR(rate.value(), fps, fps * fps * 1e-6 + fps * 1e-6) << fps;
    }
}

TEST(FrameRate, ADoubleNamesItsFraction) {
    std::mt19937_64 engine(7);
    for (int i = 0; i < 100000; ++i) {
        // Small and large terms alike.
        const auto term = [&] { return 1 + std::int64_t(engine() % (std::uint64_t(10) << engine() % 17)); };
        FrameRate rate{std::min(term(), largest_rate_term), std::min(term(), largest_rate_term)};
        const std::int64_t common = std::gcd(rate.numerator, rate.denominator);
        rate = {rate.numerator / common, rate.denominator / common};
        ASSERT_EQ(to_frame_rate(rate.value()), rate) << rate.text();
        const auto parsed = parse_frame_rate(rate.text());
        ASSERT_TRUE(parsed) << rate.text();
        EXPECT_EQ(*parsed, rate);
    }
}

TEST(FrameRate, OtherTextsAreNone) {
    for (const char* text : {"", "/", "1", "1/", "/1", "0/1", "1/0", "-1/1", "1/-1", "+1/1", "1/1/1", " 1/1", "1/1 ",
                             "1.0/1", "0x1/1", "1000001/1", "1/1000001", "99999999999999999999/1"})
        EXPECT_FALSE(parse_frame_rate(text)) << text;
}

TEST(FrameRate, TextsAreShortAndReadBack) {
    EXPECT_EQ(fps_text(60.0), "60");
    EXPECT_EQ(fps_text(29.97), "29.97");
    EXPECT_EQ(fps_text(23.976), "23.976");
    EXPECT_EQ(fps_text(12.5), "12.5");
    EXPECT_EQ(fps_text(0.001), "0.001");
    EXPECT_EQ(fps_text(24000.0 / 1001.0), "24000/1001");
    EXPECT_EQ(fps_text(1.0 / 3.0), "1/3");
    EXPECT_EQ(fps_text(std::nextafter(60.0, 61.0)), "60.00000000000001");  // no fraction
}

}  // namespace
}  // namespace tumble::frame_rate_test
