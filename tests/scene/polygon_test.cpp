#include "scene/polygon.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble {
namespace {

/// The vector areas of the triangles, summed, and the sum of their sizes: equal when nothing folds over.
void expect_cut(const std::vector<Vec3>& corners) {
    Vec3 whole = Vec3::Zero(), sum = Vec3::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) whole += 0.5 * corners[i].cross(corners[(i + 1) % corners.size()]);
    double sizes = 0.0;
    const auto triangles = cut_polygon(corners);
    EXPECT_EQ(triangles.size(), corners.size() - 2);
    for (const auto& t : triangles) {
        const Vec3 area = 0.5 * (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]);
        sum += area;
        sizes += area.norm();
    }
    EXPECT_NEAR((sum - whole).norm(), 0.0, 1e-12);
    EXPECT_NEAR(sizes, whole.norm(), 1e-12);
}

TEST(Polygon, ConvexOnesAndOnesWithDentsKeepTheirAreaInEveryPlane) {
    for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(-0.5, 0.8, 0.2), Vec3(0, -1, 0)}) {
        const Quat turn = Quat::FromTwoVectors(Vec3(0, 0, 1), normal);
        const auto placed = [&](std::vector<Vec3> points) {
            for (Vec3& p : points) p = turn * p + Vec3(3, -2, 5);
            return points;
        };
        expect_cut(placed({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
        expect_cut(placed({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}));
        expect_cut(placed({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}}));                          // an arrow head
        expect_cut(
            placed({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}));  // U
        expect_cut(placed({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}));               // a corner on a side
        std::vector<Vec3> star;
        for (int k = 0; k < 40; ++k) {
            const double r = k % 2 ? 0.3 : 1.0, a = k * M_PI / 20.0;
            star.push_back({r * std::cos(a), r * std::sin(a), 0});
        }
        expect_cut(placed(star));
    }
}

TEST(Polygon, WhatIsNotSimpleIsCutAllTheSame) {
    EXPECT_EQ(cut_polygon({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u);   // a bow tie
    EXPECT_EQ(cut_polygon(std::vector<Vec3>(6, Vec3(1, 2, 3))).size(), 4u);            // all in one point
    EXPECT_TRUE(cut_polygon({{0, 0, 0}, {1, 0, 0}}).empty());
}

}  // namespace
}  // namespace tumble
