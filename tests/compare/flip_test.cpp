// FLIP against its definition in closed form and against the authors' program.
#include "compare/metrics/flip.h"

#include "metric_pairs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace tumble::flip_test {
namespace {

using Color3 = std::array<double, 3>;

/// L*, and a* and b* with Hunt's adjustment, in double precision.
Color3 hunt_lab(const Pixel& color) {
    Color3 linear;
    for (std::size_t c = 0; c < 3; ++c) {
        const double v = color[c] / 255.0;
        linear[c] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
    // IEC 61966-2-1 to four digits would do: the exact matrix is that of the primaries and the white (0.31271,
    // 0.32902).
    const double m[3][3] = {
        {0.4123867, 0.3575915, 0.1804505}, {0.2126368, 0.7151830, 0.0721802}, {0.0193306, 0.1191972, 0.9503726}};
    Color3 f;
    for (std::size_t r = 0; r < 3; ++r) {
        const double white = m[r][0] + m[r][1] + m[r][2];
        const double t = (m[r][0] * linear[0] + m[r][1] * linear[1] + m[r][2] * linear[2]) / white;
        f[r] = t > std::pow(6.0 / 29.0, 3.0) ? std::cbrt(t) : t * 841.0 / 108.0 + 4.0 / 29.0;
    }
    const double l = 116.0 * f[1] - 16.0;
    return {l, 0.01 * l * 500.0 * (f[0] - f[1]), 0.01 * l * 200.0 * (f[1] - f[2])};
}

double distance(const Pixel& p, const Pixel& q) {
    const Color3 a = hunt_lab(p), b = hunt_lab(q);
    return std::pow(std::fabs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]), 0.7);
}

/// FLIP of plain pictures: no filter changes them, and they have neither edges nor points.
double flip_of_colors(const Pixel& p, const Pixel& q) {
    const double largest = distance({0, 255, 0}, {0, 0, 255}), knee = 0.4 * largest, d = distance(p, q);
    return d < knee ? 0.95 * d / knee : 0.95 + 0.05 * (d - knee) / (largest - knee);
}

TEST(Flip, IsZeroForEqualImages) {
    const FlipResult result = flip(noise_pair().first, noise_pair().first);
    EXPECT_EQ(result.mean, 0.0);
    EXPECT_EQ(result.maximum, 0.0);
    EXPECT_EQ(result.weighted_median, 0.0);
    for (const float value : result.map.values) EXPECT_EQ(value, 0.0f);
}

TEST(Flip, OfPlainPicturesIsTheDifferenceOfTheirColors) {
    const std::vector<Pixel> colors = {{0, 0, 0},   {255, 255, 255}, {100, 100, 100}, {120, 100, 80},
                                       {0, 255, 0}, {0, 0, 255},     {10, 2, 5},      {99, 101, 100}};
    for (const Pixel& p : colors)
        for (const Pixel& q : colors) {
            const FlipResult result = flip(plain(12, 9, p), plain(12, 9, q));
            const double exact = p == q ? 0.0 : flip_of_colors(p, q);
            EXPECT_NEAR(result.mean, exact, 4e-6) << p[0] << " " << p[1] << ", " << q[0] << " " << q[1];
            EXPECT_NEAR(result.maximum, exact, 4e-6);
        }
    EXPECT_NEAR(flip(plain(5, 5, {0, 255, 0}), plain(5, 5, {0, 0, 255})).mean, 1.0, 1e-6);
}

struct Published {
    MetricPair pair;
    double pixels_per_degree, mean;
};

// Means of the authors' program (github.com/NVlabs/flip at 1eb247c, in floats) for these pictures.
TEST(Flip, HasTheMeansOfTheAuthorsProgram) {
    constexpr double usual = 67.0206432765823;
    for (const auto& [pair, ppd, mean] :
         {Published{box_pair(), usual, 0.125666186}, Published{box_pair(), 20.0, 0.111032108},
          Published{box_pair(), 150.0, 0.147847857}, Published{moved_pair(), usual, 0.035098437},
          Published{noise_pair(), usual, 0.125692249}, Published{noise_pair(), 20.0, 0.235577270},
          Published{noise_pair(), 150.0, 0.109743281}, Published{checker_pair(), usual, 0.137876752}}) {
        EXPECT_NEAR(flip(pair.first, pair.second, {ppd}).mean, mean, 1e-6) << ppd;
        EXPECT_NEAR(flip(pair.second, pair.first, {ppd}).mean, mean, 1e-6) << "exchanged, " << ppd;
    }
}

TEST(Flip, HasTheMapOfTheAuthorsProgram) {
    const FlipResult box = flip(box_pair().first, box_pair().second);
    EXPECT_NEAR(box.map.at(20, 10), 0.620062, 1e-4);
    EXPECT_NEAR(box.map.at(30, 20), 0.759336, 1e-4);
    EXPECT_NEAR(box.map.at(45, 31), 0.016717, 1e-4);
    EXPECT_NEAR(box.maximum, 0.842246, 1e-4);
    EXPECT_EQ(box.x, 24);
    EXPECT_EQ(box.y, 27);
    const FlipResult moved = flip(moved_pair().first, moved_pair().second);
    EXPECT_NEAR(moved.map.at(15, 17), 0.744854, 1e-4);
    EXPECT_NEAR(moved.map.at(28, 12), 0.479231, 1e-4);
    const FlipResult noise = flip(noise_pair().first, noise_pair().second);
    EXPECT_NEAR(noise.map.at(0, 5), 0.410086, 1e-4);
    EXPECT_NEAR(noise.map.at(80, 45), 0.134037, 1e-4);
    EXPECT_NEAR(noise.map.at(159, 89), 0.138623, 1e-4);
}

/// FNV-1a over the bits of a map.
std::uint64_t hash_of(const MetricMap& map) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const float value : map.values) {
        std::uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        for (int i = 0; i < 4; ++i) hash = (hash ^ (bits >> (8 * i) & 255u)) * 0x100000001b3u;
    }
    return hash;
}

TEST(Flip, HasTheSameBitsOnEachProcessorAndOptimizationLevel) {
    EXPECT_EQ(hash_of(flip(noise_pair().first, noise_pair().second).map), 0x7db53b5fd23b7bf2u);
    EXPECT_EQ(hash_of(flip(box_pair().first, box_pair().second).map), 0xdc024b7e5a7a88e3u);
}

TEST(Flip, AChangeReachesAsFarAsTheFiltersOnly) {
    // A region is filtered alone where the rest is equal: its values are those of the whole picture.
    const Image a = noise_pair().first;
    Image one = a, two = a;
    set(one, 40, 30, {255, 0, 0});
    set(two, 40, 30, {255, 0, 0});
    set(two, 159, 89, {255, 0, 0});
    set(two, 0, 0, {0, 255, 0});
    const FlipResult alone = flip(a, one), both = flip(a, two);
    for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 160; ++x) {
            if (std::abs(x - 40) > 10 || std::abs(y - 30) > 10)
                EXPECT_EQ(alone.map.at(x, y), 0.0f) << x << " " << y;
            else
                EXPECT_EQ(alone.map.at(x, y), both.map.at(x, y)) << x << " " << y;
        }
    EXPECT_GT(alone.map.at(40, 30), 0.1f);
    EXPECT_GT(both.mean, 2.0 * alone.mean);
}

TEST(Flip, SmallPicturesAreFiltered) {
    for (const auto& [w, h] : {std::pair{1, 1}, {1, 40}, {40, 1}, {3, 2}}) {
        const Image a = plain(w, h, {10, 200, 30}), b = plain(w, h, {10, 180, 30});
        EXPECT_NEAR(flip(a, b).mean, flip_of_colors({10, 200, 30}, {10, 180, 30}), 4e-6) << w << " x " << h;
    }
    EXPECT_NEAR(flip(plain(9, 9, {10, 200, 30}), plain(9, 9, {10, 180, 30}), {1.0}).mean,
                flip_of_colors({10, 200, 30}, {10, 180, 30}), 4e-6);
}

TEST(Flip, QuantilesDescribeTheMap) {
    // 1.6 % of the pixels differ, all alike.
    Image a = plain(500, 100, {100, 100, 100}), b = a;
    fill(b, 0, 0, 20, 40, {120, 100, 80});
    const FlipResult result = flip(a, b);
    EXPECT_GT(result.quantile_99, 0.1);
    EXPECT_LE(result.quantile_99, result.maximum);
    EXPECT_NEAR(result.weighted_median, flip_of_colors({100, 100, 100}, {120, 100, 80}), 0.05);
    Image c = a;
    set(c, 200, 50, {255, 0, 0});
    EXPECT_EQ(flip(a, c).quantile_99, 0.0);  // at most 441 of 50,000 pixels
}

TEST(Flip, TransparentPixelsHaveNoColor) {
    Image a = plain(20, 20, {255, 0, 0}), b = plain(20, 20, {0, 255, 0});
    for (std::size_t i = 3; i < a.pixels.size(); i += 4) a.pixels[i] = b.pixels[i] = 0;
    EXPECT_EQ(flip(a, b).mean, 0.0);
    // Black is invisible on black, white on white.
    const Image none = a;
    for (const int level : {0, 255}) EXPECT_GT(flip(none, plain(20, 20, {level, level, level})).mean, 0.5) << level;
}

}  // namespace
}  // namespace tumble::flip_test
