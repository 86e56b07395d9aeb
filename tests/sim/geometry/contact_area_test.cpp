// Uniform pressure over a contact area, and the points that represent it.
#include "sim/geometry/contact_area.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::contact_area_test {
using namespace tumble::testing;

namespace {

// A convex polygon in a plane normal to a random direction, far from the origin.
struct Polygon {
    Vec3 normal, first, second, origin;
    std::vector<Vec3> corners;

    explicit Polygon(Random& random)
        : normal(random.vector(1.0).normalized()),
          first(normal.unitOrthogonal()),
          second(normal.cross(first)),
          origin(random.vector(1000.0)) {}
    void add(double x, double y) { corners.push_back(origin + x * first + y * second); }
    Manifold manifold() const {
        std::vector<ContactPoint> points, reduced;
        for (std::size_t i = 0; i < corners.size(); ++i) points.push_back({corners[i], 0.0, i});
        Manifold m;
        m.normal = normal;
        keep_best_points(points, m, reduced);
        return m;
    }
};

}  // namespace

// Rectangles: ((a^2 d + b^2 d ...) in closed form), with d the diagonal: d/6 + b^2/(12 a) ln((a + d)/b) + a^2/(12 b)
// ln((b + d)/a).
TEST(ContactArea, OfRectangles) {
    Random random(3);
    for (const double b : {1.0, 0.5, 0.25, 0.1, 0.01}) {
        const double a = 1.0, d = std::hypot(a, b);
        const double expected =
            d / 6.0 + b * b / (12.0 * a) * std::log((a + d) / b) + a * a / (12.0 * b) * std::log((b + d) / a);
        for (const double sense : {1.0, -1.0}) {
            Polygon p(random);
            p.add(0.0, 0.0);
            p.add(a, 0.0);
            p.add(a, b);
            p.add(0.0, b);
            const ContactArea area = contact_area(p.corners, sense * p.normal);
            EXPECT_NEAR(area.mean_distance, expected, 2e-3 * expected) << b;
            EXPECT_LT((area.centroid - (p.origin + 0.5 * a * p.first + 0.5 * b * p.second)).norm(), 1e-12) << b;
        }
    }
}

TEST(ContactArea, OfDiscsIsTwoThirdsOfTheRadius) {
    Random random(4);
    for (const int corners : {3, 5, 12, 31, 64, 128}) {
        Polygon p(random);
        // The mean over a regular polygon: two thirds of that along an edge, where r = h / cos.
        const double half = 3.14159265358979323846 / corners, h = std::cos(half), s = std::sin(half);
        for (int i = 0; i < corners; ++i) p.add(std::cos(2.0 * half * i), std::sin(2.0 * half * i));
        const double along = 0.5 * (s + h * h * std::asinh(s / h)) / s;
        const ContactArea area = contact_area(p.corners, p.normal);
        EXPECT_NEAR(area.mean_distance, 2.0 / 3.0 * along, 2e-3);
        EXPECT_LT((area.centroid - p.origin).norm(), 1e-12);
        // The loads of the four kept points have the disc's center as their centroid.
        Manifold m = p.manifold();
        spread_pressure(area, m);
        const ContactArea again = contact_area(m);
        EXPECT_LT((again.centroid - p.origin).norm(), 1e-6) << corners;
        EXPECT_NEAR(again.mean_distance, area.mean_distance, 1e-6);
        EXPECT_NEAR(m.spread, area.mean_distance, 1e-6);  // all points lie on the circle
    }
}

// For lines, and polygons that are nearly lines: the middle and a quarter of the length.
TEST(ContactArea, OfLines) {
    Random random(5);
    for (const double width : {0.0, 1e-9, 1e-4}) {
        Polygon p(random);
        p.add(-1.0, 0.0);
        p.add(1.0, 0.0);
        if (width > 0.0) p.add(1.0, width);
        if (width > 0.0) p.add(-1.0, width);
        const ContactArea area = contact_area(p.corners, p.normal);
        EXPECT_NEAR(area.mean_distance, 0.5, 1e-3) << width;
        EXPECT_LT((area.centroid - p.origin).norm(), 1e-4) << width;
        Manifold m = p.manifold();
        spread_pressure(area, m);
        EXPECT_NEAR(m.spread, 0.5, 1e-3);
        for (int i = 0; i < m.count; ++i) EXPECT_NEAR(m.share[std::size_t(i)], 1.0f, 1e-5f);
    }
}

// For any area, no point has a negative share, and the centroid is right where the points allow it.
TEST(ContactArea, SharesOfRandomPolygons) {
    Random random(6);
    int exact = 0;
    for (int trial = 0; trial < 500; ++trial) {
        Polygon p(random);
        std::vector<double> angles(std::size_t(3 + trial % 9));
        for (double& angle : angles) angle = random(0.0, 6.283);
        std::sort(angles.begin(), angles.end());
        const double squeeze = random(0.05, 1.0);
        for (const double angle : angles) p.add(std::cos(angle), squeeze * std::sin(angle));
        const ContactArea area = contact_area(p.corners, p.normal);
        Manifold m = p.manifold();
        spread_pressure(area, m);
        float sum = 0.0f;
        for (int i = 0; i < m.count; ++i) {
            EXPECT_GE(m.share[std::size_t(i)], 0.099f);
            sum += m.share[std::size_t(i)];
        }
        EXPECT_NEAR(sum, float(m.count), 1e-5f);
        EXPECT_GT(m.spread, 0.0f);
        EXPECT_LE(m.spread, 1.0f);
        exact += (contact_area(m).centroid - area.centroid).norm() < 1e-6;
    }
    EXPECT_GT(exact, 450);
}

}  // namespace tumble::contact_area_test
