// Manifolds of more than four points: which points are added, which stay.
#include "sim/geometry/manifold_growth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble::manifold_growth_test {

namespace {

/// The corners of a regular polygon on which a face lies, tilted a little about z.
std::vector<ContactPoint> polygon(int corners, double tilt) {
    std::vector<ContactPoint> points;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / corners;
        ContactPoint& p = points.emplace_back();
        p.position = Vec3(std::cos(angle), 0.0, std::sin(angle));
        p.separation = -1e-3 - tilt * p.position.x();
        p.feature = std::uint64_t(i);
    }
    return points;
}

std::vector<ContactPoint> octagon(double tilt) { return polygon(8, tilt); }

struct Found {
    explicit Found(const std::vector<ContactPoint>& points) {
        first.normal = Vec3::UnitY();
        keep_best_points(points, first, reduced);
    }
    Manifold first;
    std::vector<ContactPoint> reduced;
};

/// The largest angle between neighboring points, seen from the middle, rad.
double largest_gap(const std::vector<Manifold>& manifolds) {
    std::vector<double> angles;
    for (const Manifold& m : manifolds)
        for (int i = 0; i < m.count; ++i)
            angles.push_back(std::atan2(m.points[std::size_t(i)].position.z(), m.points[std::size_t(i)].position.x()));
    std::sort(angles.begin(), angles.end());
    double gap = angles.front() + 2.0 * std::numbers::pi - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
    return gap;
}

}  // namespace

// On one half of its corners, and then tilted towards a reduced one: it is added, and none is removed.
TEST(Growth, AddsPointsThatSank) {
    const Found level(octagon(0.0));
    ASSERT_EQ(level.reduced.size(), 4u);
    for (const ContactPoint& missed : level.reduced) {
        std::vector<ContactPoint> points = octagon(0.0);
        for (ContactPoint& p : points) p.separation -= 5e-4 * p.position.dot(missed.position);
        Found tilted(points);
        const Manifold more = grow(std::span(&level.first, 1), 1.0, tilted.first, tilted.reduced);
        ASSERT_EQ(tilted.first.count, 4);
        for (int i = 0; i < 4; ++i) EXPECT_TRUE(level.first.has(tilted.first.points[std::size_t(i)].feature));
        ASSERT_EQ(more.count, 1);
        EXPECT_TRUE(more.more);
        EXPECT_EQ(more.points[0].feature, missed.feature);
    }
}

// And back again: all five stay, though a new choice would be another.
TEST(Growth, RemovesNoPoint) {
    const Found level(octagon(0.0));
    Found tilted(octagon(5e-4));
    std::vector<Manifold> both(2);
    both[1] = grow(std::span(&level.first, 1), 1.0, tilted.first, tilted.reduced);
    both[0] = tilted.first;
    for (const double tilt : {0.0, -2e-5, 3e-4}) {
        Found now(octagon(tilt));
        const Manifold more = grow(both, 1.0, now.first, now.reduced);
        ASSERT_EQ(now.first.count, both[0].count);
        ASSERT_EQ(more.count, both[1].count) << tilt;
        for (int i = 0; i < now.first.count; ++i) EXPECT_TRUE(both[0].has(now.first.points[std::size_t(i)].feature));
        for (int i = 0; i < more.count; ++i) EXPECT_TRUE(both[1].has(more.points[std::size_t(i)].feature));
    }
}

// A corner that has gone is replaced; where all of the first manifold's have gone, the second becomes the first.
TEST(Growth, IsNeverWithoutAFirstManifold) {
    const Found level(octagon(0.0));
    std::vector<ContactPoint> left;
    for (const ContactPoint& p : octagon(0.0))
        if (!level.first.has(p.feature)) left.push_back(p);
    Manifold second;
    second.more = true;
    for (const ContactPoint& p : left) second.points[std::size_t(second.count++)] = p;
    const std::vector<Manifold> both = {level.first, second};
    std::vector<ContactPoint> points = left;
    ContactPoint extra = left[0];
    extra.feature += 100;
    extra.separation = 0.01;
    points.push_back(extra);
    Found now(points);
    const Manifold more = grow(both, 1.0, now.first, now.reduced);
    EXPECT_EQ(now.first.count + more.count, 4 + int(now.first.has(extra.feature) || more.has(extra.feature)));
    EXPECT_GT(now.first.count, 0);
}

// Eight of sixteen corners can be kept: one that sank is added, and the points stay all around, though those on the far
// side are higher.
TEST(Growth, ReplacesANeighborWhereThereIsNoRoom) {
    std::vector<ContactPoint> points = polygon(16, 0.0);
    std::vector<Manifold> both(2);
    both[1].more = true;
    for (std::size_t i = 0; i < 8; ++i) {
        Manifold& m = both[i % 2];
        m.points[std::size_t(m.count++)] = points[2 * i];
    }
    points[5].separation = -2e-3;
    points[12].separation = 1e-3;
    Found now(points);
    const Manifold more = grow(both, 1.0, now.first, now.reduced);
    EXPECT_EQ(now.first.count + more.count, 8);
    EXPECT_TRUE(now.first.has(5) || more.has(5));
    both = {now.first, more};
    EXPECT_LT(largest_gap(both), 2.0);
}

// Eight neighboring corners touch, and the others are farther off: none of these takes the place of one that touches.
TEST(Growth, OnlyPointsThatDoNotTouchGiveWay) {
    std::vector<ContactPoint> points = polygon(64, 0.0);
    for (std::size_t i = 8; i < points.size(); ++i) points[i].separation = 5e-3;
    std::vector<Manifold> both(2);
    both[1].more = true;
    for (std::size_t i = 0; i < 8; ++i) {
        Manifold& m = both[i / 4];
        m.points[std::size_t(m.count++)] = points[i];
    }
    Found now(points);
    const Manifold more = grow(both, 1.0, now.first, now.reduced);
    for (std::uint64_t i = 0; i < 8; ++i) EXPECT_TRUE(now.first.has(i) || more.has(i)) << i;
}

// Tilted further and further around, on all corners: the middle always lies between the points.
TEST(Growth, PointsDoNotGatherOnOneSide) {
    const auto tilted = [](double towards) {
        std::vector<ContactPoint> points = polygon(64, 0.0);
        for (ContactPoint& p : points)
            p.separation -= 5e-4 * p.position.dot(Vec3(std::cos(towards), 0.0, std::sin(towards)));
        return points;
    };
    std::vector<Manifold> both{Found(polygon(64, 0.0)).first};
    for (int k = 0; k < 100; ++k) {
        Found now(tilted(0.7 * k));
        const Manifold more = grow(both, 1.0, now.first, now.reduced);
        both.assign(1, now.first);
        if (more.count > 0) both.push_back(more);
        EXPECT_LT(largest_gap(both), 2.0) << k;
    }
}

// Searched anew, tilted to another side: the kept points are insufficient.
TEST(Growth, IsNeededWhereReducedPointsSank) {
    const Found level(polygon(64, 0.0));
    for (const bool held : {false, true}) {
        std::vector<ContactPoint> points = polygon(64, 0.0);
        const Vec3 to = held ? level.first.points[0].position : Vec3(std::cos(0.8), 0.0, std::sin(0.8));
        for (ContactPoint& p : points) p.separation -= 1e-2 * p.position.dot(to);
        const Found tilted(points);
        EXPECT_EQ(missed(std::span(&level.first, 1), tilted.first, tilted.reduced, 1.0), !held);
    }
}

TEST(Growth, OtherFacesStartAnew) {
    const Found level(octagon(0.0));
    std::vector<ContactPoint> points = octagon(5e-4);
    for (ContactPoint& p : points) p.feature += std::uint64_t(1) << 42;
    Found now(points);
    const Manifold before = now.first;
    EXPECT_EQ(grow(std::span(&level.first, 1), 1.0, now.first, now.reduced).count, 0);
    for (int i = 0; i < 4; ++i)
        EXPECT_EQ(now.first.points[std::size_t(i)].feature, before.points[std::size_t(i)].feature);
}

}  // namespace tumble::manifold_growth_test
