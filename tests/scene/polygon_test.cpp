#include "core/vector.h"
#include "scene/mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tumble::polygon_test {
namespace {

/// The vector areas of the triangles, summed, and the sum of their sizes: equal if no triangle folds over.
void expect_cut(const std::vector<Vec3>& corners, double tolerance = 1e-12) {
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
    EXPECT_NEAR((sum - whole).norm(), 0.0, tolerance);
    EXPECT_NEAR(sizes, whole.norm(), tolerance);
}

TEST(Polygon, ConvexOnesAndOnesWithDentsKeepTheirAreaInEveryPlane) {
    for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(-0.5, 0.8, 0.2), Vec3(0, -1, 0)}) {
        const Quat turn = rotation_between(Vec3(0, 0, 1), normal);
        const auto placed = [&](std::vector<Vec3> points) {
            for (Vec3& p : points) p = turn * p + Vec3(3, -2, 5);
            return points;
        };
        expect_cut(placed({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
        expect_cut(placed({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}));
        expect_cut(placed({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}}));  // an arrow head
        expect_cut(
            placed({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}));  // U
        expect_cut(placed({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}));  // a corner on a side
        std::vector<Vec3> star;
        for (int k = 0; k < 40; ++k) {
            const double r = k % 2 ? 0.3 : 1.0, a = k * M_PI / 20.0;
            star.push_back({r * std::cos(a), r * std::sin(a), 0});
        }
        expect_cut(placed(star));
    }
}

double turn(const Vec3& a, const Vec3& b, const Vec3& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The same ears by the simplest method: each corner in order against all others. For polygons in x and y.
std::vector<std::array<std::uint32_t, 3>> cut_plainly(const std::vector<Vec3>& p) {
    std::vector<std::uint32_t> left;
    for (std::uint32_t i = 0; i < p.size(); ++i) left.push_back(i);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t at = 1, tried = 0; left.size() > 3;) {
        const std::size_t n = left.size();
        at %= n;
        const std::array<std::uint32_t, 3> t{left[(at + n - 1) % n], left[at], left[(at + 1) % n]};
        bool ear = turn(p[t[0]], p[t[1]], p[t[2]]) > 0.0;
        for (std::size_t i = 2; i < n - 1; ++i) {
            const Vec3& q = p[left[(at + i) % n]];
            if (turn(p[t[0]], p[t[1]], q) >= 0.0 && turn(p[t[1]], p[t[2]], q) >= 0.0 &&
                turn(p[t[2]], p[t[0]], q) >= 0.0)
                ear = false;
        }
        if (!ear && ++tried < n) {
            ++at;
            continue;
        }
        triangles.push_back(t);
        left.erase(left.begin() + std::ptrdiff_t(at));
        tried = 0;
    }
    triangles.push_back({left[0], left[1], left[2]});
    return triangles;
}

TEST(Polygon, EarsEqualThoseOfTheSimpleMethod) {
    std::mt19937 random(7);
    const auto fraction = [&] { return double(random()) / 4294967296.0; };
    for (std::size_t n = 4; n < 80; ++n) {
        std::vector<Vec3> star, tangle, lattice, cluster{{1e9, 0, 0}, {0, 1e9, 0}}, fine;
        for (std::size_t i = 0; i < n; ++i) {
            const double angle = 2.0 * M_PI * double(i) / double(n), radius = i % 2 ? 0.2 + 0.8 * fraction() : 0.1;
            star.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
            tangle.push_back({fraction(), fraction(), 0});                       // crosses itself
            lattice.push_back({double(random() % 5), double(random() % 5), 0});  // points more than once
            cluster.push_back({1e-3 * fraction(), 1e-3 * fraction(), 0});        // all in one cell
            fine.push_back(
                {1.0 + std::ldexp(random() % 9, -46), 1.0 + std::ldexp(random() % 9, -46), 0});  // within rounding
        }
        for (auto* p : {&star, &tangle, &lattice, &cluster, &fine}) {
            double area = 0.0;  // projected in the same way: clockwise polygons are seen from below
            for (std::size_t i = 0; i < p->size(); ++i) area += turn((*p)[0], (*p)[i], (*p)[(i + 1) % p->size()]);
            if (area < 0.0)
                for (Vec3& v : *p) v.y() = -v.y();
            if (area == 0.0) continue;  // no side is visible
            EXPECT_EQ(cut_polygon(*p), cut_plainly(*p)) << n;
        }
    }
}

TEST(Polygon, DozensOfLargeOnesTakeASecond) {
    // 40 combs of 2000 corners, whose teeth hide most ears. No time is asserted, but the simple method takes over a
    // minute.
    std::vector<Vec3> comb;
    for (int i = 0; i < 1000; ++i) comb.push_back({double(i), i % 2 ? 0.0 : -1000.0, 0});
    for (int i = 999; i >= 0; --i) comb.push_back({double(i), i % 2 ? 1.0 : -999.5, 0});
    for (int i = 0; i < 40; ++i) EXPECT_EQ(cut_polygon(comb).size(), 1998u);
    expect_cut(comb, 1e-6);
}

TEST(Polygon, APolygonThatIsNotSimpleIsCutAsWell) {
    EXPECT_EQ(cut_polygon({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u);  // a bow tie
    EXPECT_EQ(cut_polygon(std::vector<Vec3>(6, Vec3(1, 2, 3))).size(), 4u);           // all in one point
    EXPECT_TRUE(cut_polygon({{0, 0, 0}, {1, 0, 0}}).empty());
}

}  // namespace
}  // namespace tumble::polygon_test
