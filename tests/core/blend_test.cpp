// Compositing onto straight alpha, compared with the same in double precision on backgrounds of any color.
#include "core/color.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>

namespace tumble::blend_test {
namespace {

TEST(PutOver, IsOneLayerAfterTheOther) {
    for (int under = 0; under < 256; under += 17)
        for (int over = 0; over < 256; over += 15)
            for (const double behind : {0.0, 90.0, 255.0}) {
                const std::array<std::uint8_t, 3> color{250, 120, 7};
                std::array<std::uint8_t, 4> pixel{10, 200, 90, std::uint8_t(under)};
                const std::array<std::uint8_t, 4> before = pixel;
                put_over(color.data(), std::uint32_t(over), pixel.data());
                EXPECT_NEAR(pixel[3], 255.0 - (255.0 - under) * (255.0 - over) / 255.0, 0.5001);
                for (std::size_t c = 0; c < 3; ++c) {
                    const auto seen = [&](double top, double alpha, double below) {
                        return below + (top - below) * alpha / 255.0;
                    };
                    const double wanted = seen(color[c], over, seen(before[c], under, behind));
                    EXPECT_NEAR(seen(pixel[c], pixel[3], behind), wanted, 1.0) << under << ", " << over;
                }
            }
}

TEST(PutOver, NothingOverNothingStaysBlack) {
    std::array<std::uint8_t, 4> pixel{};
    const std::array<std::uint8_t, 3> color{250, 120, 7};
    put_over(color.data(), 0, pixel.data());
    EXPECT_EQ(pixel, (std::array<std::uint8_t, 4>{}));
}

}  // namespace
}  // namespace tumble::blend_test
