// Balls against half-spaces, balls and polyhedra: compared with the nearest of all their features.
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace tumble::ball_contact_test {
using namespace tumble::testing;

namespace {

// The point of a convex polyhedron nearest to an outside point: the nearest of all triangles of all faces, each by its
// plane, edges and corners.
Vec3 nearest_point(const Polyhedron& shape, const Vec3& p) {
    Vec3 best = shape.vertices[0];
    const auto take = [&](const Vec3& q) {
        if ((q - p).norm() < (best - p).norm()) best = q;
    };
    for (const auto& face : shape.faces)
        for (std::size_t k = 2; k < face.vertices.size(); ++k) {
            const Vec3 t[3] = {shape.vertices[face.vertices[0]], shape.vertices[face.vertices[k - 1]],
                               shape.vertices[face.vertices[k]]};
            const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]).normalized(), foot = p - n.dot(p - t[0]) * n;
            bool inside = true;
            for (int i = 0; i < 3; ++i) {
                const Vec3 edge = t[(i + 1) % 3] - t[i];
                inside = inside && n.dot(edge.cross(foot - t[i])) >= 0.0;
                take(t[i] + std::clamp(edge.dot(p - t[i]) / edge.squaredNorm(), 0.0, 1.0) * edge);
            }
            if (inside) take(foot);
        }
    return best;
}

}  // namespace

TEST(BallOnPolyhedron, OutsideMatchesBruteForce) {
    Random random(41);
    int found = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const auto shape = trial % 2 ? random_hull(random, 12, {1.0, 0.6, 0.4}) : box_of({1.0, 0.5, 1.5});
        const Vec3 center = random.direction() * random(0.4, 2.0);
        if (outside(*shape, center) <= 1e-6) continue;
        const double radius = random(0.1, 0.8);
        const Vec3 nearest = nearest_point(*shape, center);
        const double separation = (center - nearest).norm() - radius;
        const Pose pose = random.pose(3.0);
        const auto manifolds =
            collide_all(shape, pose, Ball{radius}, {pose.to_world(center), random.turn().toRotationMatrix()}, 0.05);
        if (std::abs(separation - 0.05) < 1e-12) continue;
        ASSERT_EQ(manifolds.size(), separation < 0.05 ? 1u : 0u) << separation;
        if (manifolds.empty()) continue;
        ++found;
        EXPECT_NEAR(deepest(manifolds), separation, 1e-12);
        const Vec3 normal = pose.rotation.transpose() * manifolds[0].normal;
        EXPECT_LT((normal - (center - nearest).normalized()).norm(), 1e-9);
        const Vec3 at = pose.to_body(manifolds[0].points[0].position);
        EXPECT_LT((at - nearest - 0.5 * separation * normal).norm(), 1e-11);
    }
    EXPECT_GT(found, 200);
}

TEST(BallOnPolyhedron, CenterInsideLeavesByTheNearestFace) {
    Random random(42);
    int inside = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const auto shape = trial % 2 ? random_hull(random, 16, {1.0, 0.6, 0.4}) : box_of({1.0, 0.5, 1.5});
        const Vec3 center = random.vector(0.5);
        const double depth = -outside(*shape, center);
        if (depth <= 0.0) continue;
        ++inside;
        const Pose pose = random.pose(3.0);
        const auto found = collide_all(shape, pose, Ball{0.1}, {pose.to_world(center), Mat3::Identity()}, 0.0);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_NEAR(deepest(found), -depth - 0.1, 1e-12);
        // Pushed out along the normal by the depth, the ball just touches.
        const Vec3 freed = center + (depth + 0.1) * (pose.rotation.transpose() * found[0].normal);
        EXPECT_NEAR(outside(*shape, freed), 0.1, 1e-12);
    }
    EXPECT_GT(inside, 50);
}

// The center on the surface, to the last digit: (center - nearest point) has no direction.
TEST(BallOnPolyhedron, CenterOnTheSurface) {
    Random random(43);
    for (int trial = 0; trial < 200; ++trial) {
        const auto shape = trial % 2 ? random_hull(random, 16, {1.0, 0.6, 0.4}) : box_of({1.0, 0.5, 1.5});
        const Pose pose = random.pose(3.0);
        for (const auto& face : shape->faces) {
            std::vector<Vec3> corners;
            for (const std::uint32_t v : face.vertices) corners.push_back(shape->vertices[v]);
            // Middle of the face, of an edge, a corner; also a hair off.
            for (const Vec3& on : {mean(corners), Vec3(0.5 * (corners[0] + corners[1])), corners[0]})
                for (const double off : {0.0, 1e-17, 1e-16, 1e-15, 1e-12, -1e-16}) {
                    const Vec3 center = on + off * face.normal;
                    const auto found =
                        collide_all(shape, pose, Ball{0.2}, {pose.to_world(center), Mat3::Identity()}, 0.0);
                    ASSERT_EQ(found.size(), 1u);
                    ASSERT_NEAR(found[0].normal.norm(), 1.0, 1e-12);
                    EXPECT_NEAR(deepest(found), -0.2, 1e-11);
                    // Away from the shape: a small displacement along it leaves the shape.
                    EXPECT_GT(outside(*shape, center + 1e-6 * (pose.rotation.transpose() * found[0].normal)), 0.0);
                }
            // Over the middle of a face the normal is the face's, however near.
            const Vec3 above = mean(corners) + 1e-13 * face.normal;
            const auto found = collide_all(shape, pose, Ball{0.2}, {pose.to_world(above), Mat3::Identity()}, 0.0);
            ASSERT_EQ(found.size(), 1u);
            EXPECT_LT((found[0].normal - pose.rotation * face.normal).norm(), 1e-9);
        }
    }
}

TEST(BallOnBall, DistanceNormalAndMiddle) {
    Random random(44);
    for (int trial = 0; trial < 200; ++trial) {
        const Vec3 p = random.vector(100.0), way = random.direction();
        const double ra = random(0.01, 2.0), rb = random(0.01, 2.0), gap = random(-0.01, 0.03);
        const auto found =
            collide_all(Ball{ra}, {p, Mat3::Identity()}, Ball{rb}, {p + (ra + rb + gap) * way, Mat3::Identity()}, 0.02);
        ASSERT_EQ(found.size(), gap < 0.02 ? 1u : 0u);
        if (found.empty()) continue;
        EXPECT_NEAR(deepest(found), gap, 1e-12);
        EXPECT_LT((found[0].normal - way).norm(), 1e-10);
        EXPECT_LT((found[0].points[0].position - p - (ra + 0.5 * gap) * way).norm(), 1e-11);
    }
}

// Nearer than the square root of the smallest number: still a direction, never NaN.
TEST(BallOnBall, NearlySameCenter) {
    for (const double d : {0.0, 1e-320, 1e-200, 1e-160, 1e-30}) {
        const auto found = collide_all(Ball{0.5}, {}, Ball{0.5}, {{d, 0.0, 0.0}, Mat3::Identity()}, 0.01);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_NEAR(found[0].normal.norm(), 1.0, 1e-6) << d;
        EXPECT_NEAR(deepest(found), -1.0, 1e-12);
    }
}

// After an overflow of the state a contact may have any value, but must exist: the end of the step then reports the
// body.
TEST(BallOnPolyhedron, ACenterThatIsNotANumber) {
    const Vec3 nowhere = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_LE(collide_all(box_of({1.0, 0.5, 1.5}), Pose{}, Ball{0.3}, {nowhere, Mat3::Identity()}, 0.05).size(), 1u);
}

TEST(BallOnHalfSpace, RotatedAndMovedPlane) {
    Random random(45);
    for (int trial = 0; trial < 200; ++trial) {
        const HalfSpace space{random.direction(), random(-3.0, 3.0)};
        const Pose pose = random.pose(10.0);
        const Vec3 on = pose.to_world(space.offset * space.normal + 4.0 * space.normal.unitOrthogonal());
        const Vec3 normal = pose.rotation * space.normal;
        const double gap = random(-3.0, 0.019);  // deep: also with the center below
        const auto found = collide_all(space, pose, Ball{0.5}, {on + (0.5 + gap) * normal, Mat3::Identity()}, 0.02);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_LT((found[0].normal - normal).norm(), 1e-14);
        EXPECT_NEAR(deepest(found), gap, 1e-12);
        EXPECT_LT((found[0].points[0].position - on - 0.5 * gap * normal).norm(), 1e-12);
    }
}

}  // namespace tumble::ball_contact_test
