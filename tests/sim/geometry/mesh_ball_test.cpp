// Balls on triangle meshes: against the nearest points of all triangles, one side or both, internal edges, ridges and
// valleys.
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tumble::mesh_ball_test {
using namespace tumble::testing;

namespace {

// Nearest point of a triangle by brute force: its plane, its edges, its corners.
Vec3 nearest_of(const Vec3& p, const Vec3 (&t)[3]) {
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    const Vec3 foot = p - n.dot(p - t[0]) * n;
    bool inside = true;
    Vec3 best = t[0];
    for (int i = 0; i < 3; ++i) {
        const Vec3 &a = t[i], edge = t[(i + 1) % 3] - a;
        inside = inside && n.dot(edge.cross(foot - a)) >= 0.0;
        const Vec3 on = a + std::clamp(edge.dot(p - a) / edge.squaredNorm(), 0.0, 1.0) * edge;
        if ((on - p).norm() < (best - p).norm()) best = on;
    }
    return inside ? foot : best;
}

double least_distance(const CollisionMesh& s, const Vec3& p) {
    double least = 1e300;
    for (std::uint32_t i = 0; i < s.triangles.size(); ++i) {
        const Vec3 t[3] = {s.corner(i, 0), s.corner(i, 1), s.corner(i, 2)};
        least = std::min(least, (p - nearest_of(p, t)).norm());
    }
    return least;
}

TriangleMesh bumpy(Random& random, int n) {
    TriangleMesh mesh = grid_mesh(n, 2.0, 0.0);
    for (Vec3& v : mesh.vertices) v += Vec3(random(-0.05, 0.05), random(-0.3, 0.3), random(-0.05, 0.05));
    return mesh;
}

// Two strips that meet at x = 0, rising (or falling) by `slope` to both sides.
TriangleMesh roof(double slope, int n) {
    TriangleMesh mesh = grid_mesh(n, 2.0, 0.0);
    for (Vec3& v : mesh.vertices) v.y() = slope * std::abs(v.x());
    return mesh;
}

}  // namespace

TEST(BallOnSurface, NearestPointIsAmongTheContacts) {
    Random random(51);
    int touched = 0;
    for (int trial = 0; trial < trials(400); ++trial) {
        const auto s = surface_of(bumpy(random, 2 + random.below(12)));
        const Pose pose = random.pose(4.0);
        const Vec3 center(random(-1.8, 1.8), random(-1.0, 1.0), random(-1.8, 1.8));
        const double radius = random(0.1, 0.6), margin = 0.05, least = least_distance(*s, center);
        const auto found = collide_all(s, pose, Ball{radius}, {pose.to_world(center), Mat3::Identity()}, margin);
        if (least > radius + margin + 1e-12) {
            EXPECT_TRUE(found.empty());
            continue;
        }
        ++touched;
        EXPECT_NEAR(deepest(found), least - radius, 1e-12);
        for (const Manifold& m : found) {
            // Each contact is a local minimum of the distance: no nearer point within a small patch around it.
            ASSERT_EQ(m.count, 1);
            const ContactPoint& p = m.points[0];
            const Vec3 on = pose.to_body(p.position - 0.5 * p.separation * m.normal);
            EXPECT_LT(least_distance(*s, on), 1e-12);
            EXPECT_NEAR((on - center).norm(), p.separation + radius, 1e-12);
            EXPECT_LT((pose.rotation.transpose() * m.normal - (center - on).normalized()).norm(), 1e-9);
            EXPECT_LE(p.separation, margin);
            for (int k = 0; k < 25; ++k) {
                const Vec3 aside = on + random.vector(1e-6);
                Vec3 best = on;
                for (std::uint32_t i = 0; i < s->triangles.size(); ++i) {
                    const Vec3 t[3] = {s->corner(i, 0), s->corner(i, 1), s->corner(i, 2)};
                    const Vec3 q = nearest_of(aside, t);
                    if ((q - on).norm() < 3e-6 && (q - center).norm() < (best - center).norm()) best = q;
                }
                EXPECT_GT((best - center).norm(), (on - center).norm() - 1e-10) << "the mesh is nearer beside it";
            }
            if (HasFailure()) return;
        }
    }
    EXPECT_GT(touched, trials(100) - 1);
}

// Triangles smaller than the ball's cap: only the floor's normal may occur, at any position of the ball.
TEST(BallOnSurface, FlatFloorHasOneNormalAtAnyResolution) {
    Random random(52);
    for (const int n : {1, 4, 20, 60}) {
        const auto floor = surface_of(grid_mesh(n, 2.0, 0.0));
        for (int trial = 0; trial < 200; ++trial) {
            Vec3 at(random(-1.5, 1.5), 0.3 + random(-0.002, 0.02), random(-1.5, 1.5));
            if (trial % 4 == 0) at.x() = 4.0 * random.below(n + 1) / n - 2.0;  // over internal edges
            if (trial % 8 == 0) at.z() = 4.0 * random.below(n + 1) / n - 2.0;  // over corners
            if (trial % 16 == 1) at.z() = at.x();                              // over diagonals, for some
            const auto found = collide_all(floor, {}, Ball{0.3}, {at, Mat3::Identity()}, 0.05);
            ASSERT_FALSE(found.empty());
            for (const Manifold& m : found) {
                EXPECT_LT((m.normal - Vec3::UnitY()).norm(), 1e-7) << n << " at " << at.transpose();
                EXPECT_NEAR(m.points[0].separation, at.y() - 0.3, 1e-12);
            }
        }
    }
}

TEST(BallOnSurface, RidgeLeansValleyDoesNot) {
    for (const int n : {2, 10, 40}) {
        const auto ridge = surface_of(roof(-0.5, n)), valley = surface_of(roof(0.5, n));
        for (const double x : {0.0, 0.01, -0.02, 0.1}) {
            const Vec3 over(x, 0.3, 0.07);
            const auto found = collide_all(ridge, {}, Ball{0.3}, {over, Mat3::Identity()}, 0.02);
            // Right above a convex ridge the normal is the direction from the ridge, one contact.
            ASSERT_EQ(found.size(), 1u) << n << x;
            EXPECT_LT((found[0].normal - Vec3(x, 0.3, 0.0).normalized()).norm(), 1e-12);
        }
        // In the valley: both slopes, with their own normals, and no other contact.
        const Vec3 up = Vec3(-0.5, 1.0, 0.0).normalized(), other(-up.x(), up.y(), 0.0);
        const Vec3 in(0.0, 0.3 / up.y(), 0.07);
        const auto found = collide_all(valley, {}, Ball{0.3}, {in, Mat3::Identity()}, 0.02);
        bool left = false, right = false;
        for (const Manifold& m : found) {
            EXPECT_NEAR(m.points[0].separation, 0.0, 1e-12);
            left = left || (m.normal - up).norm() < 1e-7;
            right = right || (m.normal - other).norm() < 1e-7;
            EXPECT_LT(std::min((m.normal - up).norm(), (m.normal - other).norm()), 1e-7);
        }
        EXPECT_TRUE(left && right) << n;
    }
}

TEST(BallOnSurface, ClosedPushesOutOnlyOpenBothWays) {
    const auto closed = surface_of(box_mesh({-1, -1, -1}, {1, 1, 1})), open = surface_of(grid_mesh(4, 1.0, 0.0));
    EXPECT_TRUE(closed->closed);
    EXPECT_FALSE(open->closed);
    for (const double y : {0.25, -0.25}) {
        const auto found = collide_all(open, {}, Ball{0.3}, {{0.1, y, 0.2}, Mat3::Identity()}, 0.0);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_LT((found[0].normal - Vec3(0.0, y, 0.0).normalized()).norm(), 1e-12);
        EXPECT_NEAR(deepest(found), -0.05, 1e-12);
    }
    const auto outside_face = collide_all(closed, {}, Ball{0.3}, {{0.1, 1.25, 0.2}, Mat3::Identity()}, 0.0);
    ASSERT_EQ(outside_face.size(), 1u);
    EXPECT_LT((outside_face[0].normal - Vec3::UnitY()).norm(), 1e-12);
    EXPECT_TRUE(
        collide_all(closed, {}, Ball{0.3}, {{0.1, 0.95, 0.2}, Mat3::Identity()}, 0.0).empty());  // one side only
    // At an edge and at a corner of the closed box: the direction from it.
    for (const Vec3& way : {Vec3(1.0, 1.0, 0.0), Vec3(1.0, 1.0, 1.0), Vec3(1.0, 0.2, 0.0), Vec3(0.3, 1.0, 0.1)}) {
        const Vec3 on(1.0, 1.0, way.z() > 0.0 ? 1.0 : 0.3);
        const auto found = collide_all(closed, {}, Ball{0.3}, {on + 0.29 * way.normalized(), Mat3::Identity()}, 0.0);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_LT((found[0].normal - way.normalized()).norm(), 1e-12);
        EXPECT_NEAR(deepest(found), -0.01, 1e-12);
    }
}

// The center on the mesh itself leaves only the triangle's direction.
TEST(BallOnSurface, CenterOnTheSurfaceIsFinite) {
    Random random(53);
    for (int trial = 0; trial < 100; ++trial) {
        const auto s = surface_of(bumpy(random, 5));
        const auto i = std::uint32_t(random.below(int(s->triangles.size())));
        const double u = random(0.0, 1.0), v = random(0.0, 1.0 - u);
        for (const Vec3& center : {s->corner(i, 0), Vec3(0.5 * (s->corner(i, 0) + s->corner(i, 1))),
                                   Vec3(s->corner(i, 0) + u * (s->corner(i, 1) - s->corner(i, 0)) +
                                        v * (s->corner(i, 2) - s->corner(i, 0)))}) {
            const auto found = collide_all(s, {}, Ball{0.1}, {center, Mat3::Identity()}, 0.0);
            ASSERT_FALSE(found.empty());
            EXPECT_NEAR(deepest(found), -0.1, 1e-12);
            for (const Manifold& m : found) EXPECT_NEAR(m.normal.norm(), 1.0, 1e-9);
        }
    }
}

// 125,000 triangles: the tree finds the few near ones (without it this test would take minutes).
TEST(BallOnSurface, LargeMeshStaysQuick) {
    Random random(54);
    const auto s = surface_of(grid_mesh(trials(250), 50.0, 0.1));
    for (int trial = 0; trial < trials(20000); ++trial) {
        const Vec3 on(random(-49, 49), 0.0, random(-49, 49));
        const Vec3 n = Vec3(-0.1, 1.0, 0.0).normalized();
        const auto found =
            collide_all(s, {}, Ball{0.5}, {on + Vec3(0.0, 0.1 * on.x(), 0.0) + 0.499 * n, Mat3::Identity()}, 0.01);
        ASSERT_GE(found.size(), 1u);
        EXPECT_NEAR(deepest(found), -0.001, 1e-9);
    }
}

}  // namespace tumble::mesh_ball_test
