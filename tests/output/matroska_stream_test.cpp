// Time stamps of ffmpeg's input stream.
#include "output/matroska_stream.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::matroska_stream_test {
namespace {

/// Big-endian.
std::uint64_t number_at(const std::vector<std::byte>& bytes, std::size_t at) {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < 8; ++i) number = number << 8 | std::to_integer<std::uint64_t>(bytes.at(at + i));
    return number;
}

constexpr std::size_t cluster_size_at = 4, timestamp_at = 4 + 8 + 1 + 8;  // after the elements' numbers and sizes
constexpr std::uint64_t size_mark = std::uint64_t(1) << 56;

TEST(MatroskaStream, TimesNeitherDriftNorOverflow) {
    for (const FrameRate rate :
         {FrameRate{60, 1}, {2997, 100}, {30000, 1001}, {1000000, 1}, {999983, 1}, {1, 1000}, {7, 3}}) {
        for (std::int64_t n = 0; n <= 10'000'000; n = 3 * n + 1) {
            const long double exact = 1e9L * static_cast<long double>(n * rate.denominator) / rate.numerator;
            const std::uint64_t stamp = number_at(matroska_frame_head(n, rate, 100), timestamp_at);
            EXPECT_LE(std::fabs(static_cast<long double>(stamp) - exact), 0.5L) << n << " at " << rate.text();
        }
    }
}

TEST(MatroskaStream, AClusterIsAsLongAsItSays) {
    constexpr std::size_t pixels = 1234;
    const std::vector<std::byte> head = matroska_frame_head(5, {60, 1}, pixels);
    EXPECT_EQ(number_at(head, cluster_size_at) - size_mark, head.size() - cluster_size_at - 8 + pixels);
}

}  // namespace
}  // namespace tumble::matroska_stream_test
