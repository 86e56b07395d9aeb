// The measure of overlaps, against known overlaps.
#include "harness/penetration.h"
#include "harness/shapes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace tumble::bench {
namespace {

constexpr double quarter = std::numbers::pi / 4.0;

double depth_of(const Body& a, const Body& b) {
    return depth(a, {a.position, a.orientation, {}, {}}, b, {b.position, b.orientation, {}, {}});
}

TEST(Penetration, FacesOfBoxes) {
    const Body a = box({1.0, 1.0, 1.0}, 1.0, {}), b = box({1.0, 2.0, 3.0}, 1.0, {0.99, 0.3, 0.2});
    EXPECT_NEAR(depth_of(a, b), 0.01, 1e-15);
    EXPECT_NEAR(depth_of(b, a), 0.01, 1e-15);
    EXPECT_LT(depth_of(a, box({1.0, 1.0, 1.0}, 1.0, {1.02, 0.0, 0.0})), -0.01);
}

TEST(Penetration, EdgeOnFace) {
    Body b = box({1.0, 1.0, 1.0}, 1.0, {0.0, 0.0, 0.5 + std::sqrt(0.5) - 0.003});
    b.orientation = turn({1.0, 0.0, 0.0}, quarter);
    EXPECT_NEAR(depth_of(box({1.0, 1.0, 1.0}, 1.0, {}), b), 0.003, 1e-14);
}

TEST(Penetration, CrossedEdges) {  // each box stands on an edge; the edges cross at right angles
    Body a = box({1.0, 1.0, 1.0}, 1.0, {}), b = box({1.0, 1.0, 1.0}, 1.0, {0.0, 0.0, std::sqrt(2.0) - 0.002});
    a.orientation = turn({1.0, 0.0, 0.0}, quarter);
    b.orientation = turn({0.0, 1.0, 0.0}, quarter);
    EXPECT_NEAR(depth_of(a, b), 0.002, 1e-14);
}

TEST(Penetration, Spheres) {
    EXPECT_NEAR(depth_of(sphere(0.5, 1.0, {}), sphere(0.25, 1.0, {0.0, 0.7, 0.0})), 0.05, 1e-15);
    EXPECT_NEAR(depth_of(sphere(0.5, 1.0, {0.9, 0.0, 0.0}), box({1.0, 1.0, 1.0}, 1.0, {})), 0.1, 1e-15);
    // A center within the box: out by the nearest side.
    EXPECT_NEAR(depth_of(box({1.0, 1.0, 1.0}, 1.0, {}), sphere(0.1, 1.0, {0.3, 0.0, 0.0})), 0.3, 1e-15);
    EXPECT_NEAR(depth_of(plane({0.0, 0.0, 1.0}, 1.0), sphere(0.5, 1.0, {0.0, 0.0, 1.4})), 0.1, 1e-15);
}

TEST(Penetration, AHexahedronThatIsABox) {
    Body stone = box({1.0, 2.0, 3.0}, 2.0, {0.3, 0.2, 1.49});
    const Vector inertia = stone.principal_inertia();
    stone.corners = stone.outline();
    stone.kind = Kind::hexahedron;
    EXPECT_NEAR(depth_of(stone, floor_box()), 0.01, 1e-14);
    EXPECT_NEAR(depth_of(stone, plane({0.0, 0.0, 1.0}, 0.0)), 0.01, 1e-14);
    EXPECT_NEAR(norm(stone.principal_inertia() - inertia), 0.0, 1e-14);
}

TEST(Penetration, CountsTheNearPairs) {
    Scene scene;
    for (const double x : {0.0, 0.99, 1.995, 3.5}) scene.bodies.push_back(box({1.0, 1.0, 1.0}, 1.0, {x, 0.0, 2.0}));
    scene.bodies.push_back(fixed_box({1.0, 1.0, 1.0}, {0.0, 0.98, 2.0}));
    scene.bodies.push_back(fixed_box({1.0, 1.0, 1.0}, {0.0, 0.98, 2.0}));  // fixed with fixed: no pair
    std::vector<Motion> motions;
    for (const Body& body : scene.bodies) motions.push_back({body.position, body.orientation, {}, {}});
    const Penetration p = penetration(scene, motions);
    EXPECT_EQ(p.pairs, 6);  // 0.01, -0.005, twice 0.02, and twice 0.01 beside the corner
    EXPECT_NEAR(p.largest, 0.02, 1e-14);
}

}  // namespace
}  // namespace tumble::bench
