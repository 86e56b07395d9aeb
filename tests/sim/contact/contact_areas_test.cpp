// Contact areas of several manifolds: which faces share one, its centroid and its mean distance.
#include "sim/contact/model/contact_areas.h"
#include "sim/geometry/contact_area.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace tumble::contact_areas_test {
namespace {

// A rectangle in the plane y = height, touching.
Manifold rectangle(std::uint32_t a, std::uint32_t b, double x0, double x1, double z0, double z1, double height = 0.0) {
    Manifold m;
    m.a = a;
    m.b = b;
    m.normal = Vec3::UnitY();
    m.count = 4;
    const Vec3 corners[] = {{x0, height, z0}, {x1, height, z0}, {x1, height, z1}, {x0, height, z1}};
    for (std::size_t i = 0; i < 4; ++i) {
        m.points[i].position = corners[i];
        m.points[i].feature = i;
    }
    spread_pressure(contact_area(corners, m.normal), m);
    return m;
}

// Body 0 rests on the others.
struct Scene {
    std::vector<Body> bodies;
    std::vector<Manifold> manifolds;
    ContactIslands islands{0};
    ContactAreas areas;

    explicit Scene(std::size_t count) : bodies(count), islands(count) {
        for (Body& body : bodies) {
            body.type = BodyType::fixed;
            body.radius = 1.0;
            body.friction = 0.5;
        }
        bodies[0].type = BodyType::dynamic;
    }
    void find() {
        const std::uint32_t awake[] = {0};
        islands.find(body_pairs(manifolds), bodies, awake);
        areas.find(islands.repeated(), manifolds, bodies);
    }
};

double mean_by_sum(double x0, double x1, double z0, double z1, const Vec3& from) {
    double sum = 0.0;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k)
            sum += std::hypot(x0 + (x1 - x0) * (i + 0.5) / n - from.x(), z0 + (z1 - z0) * (k + 0.5) / n - from.z());
    return sum / (n * n);
}

}  // namespace

TEST(ContactAreas, MeanDistanceFromAnyPoint) {
    const Manifold m = rectangle(0, 1, 0.0, 1.0, 0.0, 0.3);
    for (const Vec3& from : {Vec3(0.5, 0.0, 0.15), Vec3(0.0, 0.0, 0.0), Vec3(0.2, 0.0, 0.29), Vec3(1.5, 0.0, 0.1),
                             Vec3(0.3, 0.0, -0.05), Vec3(-3.0, 0.0, 4.0)}) {
        const double expected = mean_by_sum(0.0, 1.0, 0.0, 0.3, from);
        EXPECT_NEAR(mean_distance(m, from), expected, 3e-3 * expected) << from.transpose();
    }
}

// Also in any order of the corners, and for an octagon of which four corners are kept.
TEST(ContactAreas, MeanDistanceOfReducedPoints) {
    Manifold m = rectangle(0, 1, 0.0, 1.0, 0.0, 0.3);
    const double expected = mean_distance(m, {1.5, 0.0, 0.1});
    std::swap(m.points[1], m.points[2]);
    EXPECT_NEAR(mean_distance(m, {1.5, 0.0, 0.1}), expected, 1e-12);

    std::vector<ContactPoint> octagon, reduced;
    for (int i = 0; i < 8; ++i) {
        const double angle = 0.25 * 3.14159265358979323846 * i;
        ContactPoint& p = octagon.emplace_back();
        p.position = Vec3(std::cos(angle), 0.0, std::sin(angle));
        p.feature = std::uint64_t(i);
    }
    Manifold whole;
    whole.normal = Vec3::UnitY();
    keep_best_points(octagon, whole, reduced);
    spread_pressure(contact_area(octagon, whole.normal), whole);
    ASSERT_EQ(whole.count, 4);
    EXPECT_NEAR(whole.area, 2.0 * std::sqrt(2.0), 1e-6);
    // Mean distance of a disc of the same area, from its rim: 32 R / (9 pi).
    const double rim = std::sqrt(whole.area / 3.14159265358979323846);
    EXPECT_NEAR(mean_distance(whole, {rim, 0.0, 0.0}), 32.0 * rim / (9.0 * 3.14159265358979323846), 0.01 * rim);
}

// Four tiles under a square: the centroid and the mean distance of the square.
TEST(ContactAreas, TilesAreOneArea) {
    Scene scene(5);
    scene.manifolds = {rectangle(0, 1, -0.3, 0.1, -0.2, 0.0), rectangle(0, 2, 0.1, 0.7, -0.2, 0.0),
                       rectangle(0, 3, -0.3, 0.1, 0.0, 0.8), rectangle(0, 4, 0.1, 0.7, 0.0, 0.8)};
    scene.find();
    ASSERT_EQ(scene.areas.areas().size(), 1u);
    const SharedArea& area = scene.areas.areas()[0];
    EXPECT_EQ(area.count, 4u);
    EXPECT_LT((area.centroid - Vec3(0.2, 0.0, 0.3)).norm(), 1e-7);
    EXPECT_NEAR(area.mean_distance, 0.38259785823210635, 1e-3);
    EXPECT_NEAR(area.radius, std::sqrt(0.5), 1e-6);
}

// The moved body may be A or B; faces of another plane, another direction, lines, and kinematic bodies stay apart.
TEST(ContactAreas, OnlyFacesOfOnePlaneShare) {
    Scene scene(8);
    std::swap(scene.bodies[0], scene.bodies[3]);  // the body that rests
    Manifold below = rectangle(3, 4, 0.0, 1.0, 0.0, 1.0), step = rectangle(3, 5, 1.0, 2.0, 0.0, 1.0, 0.01),
             line = rectangle(3, 6, 2.0, 3.0, 0.0, 1.0), carried = rectangle(3, 7, 3.0, 4.0, 0.0, 1.0);
    Manifold above = rectangle(1, 3, -1.0, 0.0, 0.0, 1.0), aside = rectangle(2, 3, -1.0, 0.0, 0.0, 1.0);
    above.normal = -above.normal;
    aside.normal = Vec3::UnitX();
    line.count = 2;
    scene.bodies[7].type = BodyType::kinematic;
    scene.bodies[7].track = std::make_shared<const KeyframeTrack>(std::vector<Keyframe>(1), Interpolation::linear);
    scene.manifolds = {above, aside, below, step, line, carried};
    const std::uint32_t awake[] = {3};
    scene.islands.find(body_pairs(scene.manifolds), scene.bodies, awake);
    scene.areas.find(scene.islands.repeated(), scene.manifolds, scene.bodies);
    ASSERT_EQ(scene.areas.areas().size(), 1u);
    const auto members = scene.areas.members(scene.areas.areas()[0]);
    EXPECT_EQ(std::vector<std::uint32_t>(members.begin(), members.end()), (std::vector<std::uint32_t>{0, 2}));
    EXPECT_TRUE(scene.areas.holds(2));
    EXPECT_FALSE(scene.areas.holds(3));
}

// One pair of faces with a second manifold shares nothing; beside another face it belongs to the area.
TEST(ContactAreas, SecondManifoldsFollowTheirFirst) {
    Scene scene(3);
    Manifold first = rectangle(0, 1, 0.0, 1.0, 0.0, 1.0), more = first;
    more.more = true;
    scene.manifolds = {first, more};
    scene.find();
    EXPECT_TRUE(scene.areas.empty());
    scene.manifolds.push_back(rectangle(0, 2, 1.0, 2.0, 0.0, 1.0));
    scene.find();
    ASSERT_EQ(scene.areas.areas().size(), 1u);
    EXPECT_EQ(scene.areas.areas()[0].count, 3u);
    EXPECT_LT((scene.areas.areas()[0].centroid - Vec3(1.0, 0.0, 0.5)).norm(), 1e-7);
}

}  // namespace tumble::contact_areas_test
