// The pixels of shapes: their places, their coverage against areas in closed form, and hidden parts.
#include "overlay/shape_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tumble::shape_raster_test {
namespace {

constexpr int width = 200, height = 120;
constexpr Color red{255, 0, 0};

/// A gray image, and the sum of the red that shapes add to it, in pixels fully covered.
struct Paper {
    Paper() : image(width, height), raster(width, height, 1e-3) {
        for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = i % 4 == 3 ? 255 : 0;
        raster.begin(image, nullptr);
    }
    double red_at(int x, int y) const { return image.at(x, y)[0] / 255.0; }
    double area() const {
        double sum = 0.0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) sum += red_at(x, y);
        return sum;
    }
    Image image;
    ShapeRaster raster;
};

ScreenPoint at(double x, double y, double depth = 5.0) { return {{x, y}, depth}; }

// The halo darkens pixels outside of the shape and adds 16/255 of red at most there.
TEST(ShapeRaster, ADiscCoversItsArea) {
    Paper paper;
    paper.raster.marker(at(80.3, 60.7), 20.0, MarkerShape::disc, {red, 1.0, false});
    EXPECT_NEAR(paper.area(), std::numbers::pi * 400.0, 0.02 * std::numbers::pi * 400.0);
    EXPECT_EQ(paper.red_at(80, 60), 1.0);
    EXPECT_EQ(paper.red_at(80, 60 + 23), 0.0);
}

TEST(ShapeRaster, ALineCoversACapsule) {
    for (const double angle : {0.0, 0.3, 1.1, 1.5707963}) {
        Paper paper;
        const double dx = 80.0 * std::cos(angle), dy = 80.0 * std::sin(angle);
        const std::array line{at(60.0, 20.0), at(60.0 + dx, 20.0 + dy)};
        paper.raster.line(line, 6.0, {red, 1.0, false});
        EXPECT_NEAR(paper.area(), 6.0 * 80.0 + std::numbers::pi * 9.0, 14.0) << angle;
    }
}

TEST(ShapeRaster, JointsOfALineAreDrawnOnce) {
    Paper paper;
    const std::array line{at(20.0, 60.0), at(60.0, 60.0), at(61.0, 60.0), at(100.0, 60.0)};
    paper.raster.line(line, 8.0, {red, 0.5, false});
    for (int x = 30; x < 90; ++x) EXPECT_EQ(paper.image.at(x, 60)[0], paper.image.at(30, 60)[0]) << x;
}

TEST(ShapeRaster, AnArrowReachesFromItsFootToItsTip) {
    for (const double angle : {0.0, 0.7, 2.1, 3.9}) {
        Paper paper;
        const Eigen::Vector2d foot(100.4, 60.2), axis(std::cos(angle), std::sin(angle));
        paper.raster.arrow({{foot, 5.0}, {foot + 45.0 * axis, 5.0}, 4.0, 1}, {red, 1.0, false});
        double least = 1e9, most = -1e9, widest = 0.0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                if (paper.red_at(x, y) < 0.3) continue;
                const Eigen::Vector2d p = Eigen::Vector2d(x + 0.5, y + 0.5) - foot;
                least = std::min(least, p.dot(axis));
                most = std::max(most, p.dot(axis));
                widest = std::max(widest, std::fabs(p.x() * axis.y() - p.y() * axis.x()));
            }
        EXPECT_NEAR(most, 45.0, 1.0) << angle;
        EXPECT_NEAR(least, -2.0, 1.0) << angle;  // a round foot of half the width
        EXPECT_NEAR(widest, 7.0, 1.0) << angle;  // half of the head
    }
}

TEST(ShapeRaster, AShortArrowIsNoLongerThanItsLength) {
    Paper paper;
    paper.raster.arrow({at(100.0, 60.0), at(105.0, 60.0), 4.0, 2}, {red, 1.0, false});
    for (int y = 0; y < height; ++y)
        for (int x = 107; x < width; ++x) EXPECT_EQ(paper.red_at(x, y), 0.0);
}

TEST(ShapeRaster, HiddenPartsAreFaint) {
    Paper paper;
    DepthImage depths(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 100; x < width; ++x) *depths.at(x, y) = 4.0f;  // a wall, 1 m in front of the line
    paper.raster.begin(paper.image, &depths);
    const std::array line{at(20.0, 60.0), at(180.0, 60.0)};
    paper.raster.line(line, 6.0, {red, 1.0, true});
    EXPECT_EQ(paper.red_at(60, 60), 1.0);
    EXPECT_GT(paper.red_at(140, 60), 0.2);
    EXPECT_LT(paper.red_at(140, 60), 0.7);
}

// A line from 2 m to 8 m passes a wall at 4 m where 1/z says, at a third of its way on the screen in 1/z: (1/2 - 1/4) /
// (1/2 - 1/8) = 2/3.
TEST(ShapeRaster, DepthIsLinearInItsReciprocal) {
    Paper paper;
    DepthImage depths(width, height);
    for (float& d : depths.depths) d = 4.0f;
    paper.raster.begin(paper.image, &depths);
    const std::array line{at(20.0, 60.0, 2.0), at(170.0, 60.0, 8.0)};
    paper.raster.line(line, 6.0, {red, 1.0, true});
    int last_bright = 0;
    for (int x = 25; x < 165; ++x)
        if (paper.red_at(x, 60) > 0.9) last_bright = x;
    EXPECT_NEAR(last_bright, 20.0 + 150.0 * 2.0 / 3.0, 2.0);
}

TEST(ShapeRaster, ASurfaceIsCoveredOnceWhereTrianglesOverlap) {
    Paper paper;
    std::vector<ScreenCorner> corners;
    for (int k = 0; k < 2; ++k)  // the same square twice
        for (const auto& [x, y] : {std::pair(20.0, 20.0), std::pair(60.0, 20.0), std::pair(60.0, 60.0),
                                   std::pair(20.0, 20.0), std::pair(60.0, 60.0), std::pair(20.0, 60.0)})
            corners.push_back({at(x, y, 5.0 + k), 1.0, red});
    paper.raster.surface(paper.raster.cover(corners), 0.5);
    EXPECT_NEAR(paper.area(), 0.5 * 1600.0, 8.0);
    EXPECT_NEAR(paper.red_at(40, 40), 0.5, 0.01);
}

TEST(ShapeRaster, ATriangleWithCornersFarOutsideCoversThePicture) {
    Paper paper;
    const std::array corners{ScreenCorner{at(-1.0, -1.0), 1.0, red}, ScreenCorner{at(1e10, -1.0), 1.0, red},
                             ScreenCorner{at(-1.0, 1e10), 1.0, red}};
    paper.raster.surface(paper.raster.cover(corners), 1.0);
    EXPECT_NEAR(paper.area(), width * height, 1.0);
}

TEST(ShapeRaster, TouchedTilesContainEveryChangedPixel) {
    Paper paper;
    const Image before = paper.image;
    paper.raster.arrow({at(-30.0, 20.0), at(90.0, 150.0), 4.0, 2}, {red, 1.0, false});
    paper.raster.marker(at(199.0, 3.0), 8.0, MarkerShape::cross, {red, 1.0, false});
    std::vector<char> touched(std::size_t(width * height));
    for (const Rectangle& r : paper.raster.touched().rectangles())
        for (int y = r.y; y < r.y + r.height; ++y)
            for (int x = r.x; x < r.x + r.width; ++x) touched[std::size_t(y * width + x)] = 1;
    int changed = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (std::equal(before.at(x, y), before.at(x, y) + 4, paper.image.at(x, y))) continue;
            ++changed;
            EXPECT_EQ(touched[std::size_t(y * width + x)], 1) << x << ' ' << y;
        }
    EXPECT_GT(changed, 500);
}

TEST(ShapeRaster, ShapesFarOutsideChangeNothing) {
    Paper paper;
    const Image before = paper.image;
    paper.raster.arrow({at(-1e9, -1e9), at(-1e8, 2e9), 4.0, 1}, {red, 1.0, false});
    paper.raster.marker(at(1e12, 50.0), 8.0, MarkerShape::disc, {red, 1.0, false});
    EXPECT_EQ(paper.image, before);
}

}  // namespace
}  // namespace tumble::shape_raster_test
