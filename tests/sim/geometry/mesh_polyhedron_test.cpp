// Boxes and hulls on triangle meshes: each lone triangle against the exact Minkowski difference, then internal edges,
// ridges, valleys and sides.
#include "sim/ccd/separation.h"
#include "sim/geometry/separating_axis.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace tumble::mesh_polyhedron_test {
using namespace tumble::testing;

namespace {

Mat3 turned(const Vec3& axis, double angle) { return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(); }

// Largest separation of hull and triangle along the faces of their Minkowski difference {b - t}, except the one that
// would push the body through to the other side of the triangle.
double exact_separation(const Vec3 (&t)[3], const Vec3& side, const Polyhedron& b, const Pose& pose) {
    std::vector<Vec3> differences;
    for (const Vec3& corner : t)
        for (const Vec3& v : b.vertices) differences.push_back(pose.to_world(v) - corner);
    const Vec3 origin = mean(differences);
    const Polyhedron difference = make_hull(differences, origin);
    double best = -1e300;
    for (const auto& f : difference.faces) {
        if (f.normal.dot(side) > 1.0 - 1e-9) continue;
        best = std::max(best, -(f.normal.dot(origin) + f.offset));
    }
    return best;
}

PolyhedronRef random_body(Random& random, int kind) {
    if (kind % 3 == 0) return box_of({random(0.2, 1.0), random(0.2, 1.0), random(0.2, 1.0)});
    return random_hull(random, 5 + random.below(20), {0.5, random(0.1, 0.5), random(0.1, 0.5)});
}

TriangleMesh folded(double slope, int n) {
    TriangleMesh mesh = grid_mesh(n, 2.0, 0.0);
    for (Vec3& v : mesh.vertices) v.y() = slope * std::abs(v.x());
    return mesh;
}

double lowest(const Polyhedron& b, const Pose& pose) {
    double y = 1e300;
    for (const Vec3& v : b.vertices) y = std::min(y, pose.to_world(v).y());
    return y;
}

SupportPoints cloud_of(std::vector<Vec3> points) {
    SupportPoints cloud;
    cloud.center = mean(points);
    for (Vec3& p : points) {
        p -= cloud.center;
        cloud.reach = std::max(cloud.reach, p.norm());
    }
    cloud.arms = std::move(points);
    return cloud;
}

// True if a body and some triangle overlap, by their Minkowski difference: independent of the tested routine.
bool overlap(const CollisionMesh& s, const Polyhedron& b, const Pose& pose) {
    std::vector<Vec3> points;
    Bounds bounds;
    for (const Vec3& v : b.vertices) bounds.add(points.emplace_back(pose.to_world(v)));
    const SupportPoints cloud = cloud_of(std::move(points));
    bool found = false;
    s.tree.query(bounds, [&](std::uint32_t t) {
        found =
            found || !closest_vector(cloud_of({s.corner(t, 0), s.corner(t, 1), s.corner(t, 2)}), cloud, Vec3::UnitY());
    });
    return found;
}

}  // namespace

TEST(PolyhedronOnTriangle, DepthIsExact) {
    Random random(61);
    int overlapping = 0, apart = 0, near = 0;
    for (int trial = 0; trial < trials(1500); ++trial) {
        TriangleMesh mesh;
        mesh.vertices = {random.vector(1.5), random.vector(1.5), random.vector(1.5)};
        mesh.triangles = {{0, 1, 2}};
        const auto s = surface_of(mesh);
        const auto body = random_body(random, trial);
        const Pose pose = random.pose(0.6);
        const Vec3 n = s->triangles[0].normal;
        const Vec3 t[3] = {mesh.vertices[0], mesh.vertices[1], mesh.vertices[2]};
        const Vec3 side = n.dot(pose.position - t[0]) < 0.0 ? Vec3(-n) : n;
        const double exact = exact_separation(t, side, *body, pose), margin = 0.02;
        const double slack = 2.0 * axis_preference(body->radius);
        const auto found = collide_all(s, {}, body, pose, margin);
        if (exact > margin + 1e-9) {
            EXPECT_TRUE(found.empty()) << exact;
            ++apart;
        } else if (exact < -1e-9) {
            ++overlapping;
            ASSERT_EQ(found.size(), 1u) << exact << " trial " << trial;
            EXPECT_LE(deepest(found), exact + slack) << "too shallow, trial " << trial;
            EXPECT_GE(deepest(found), exact - slack) << "too deep, trial " << trial;
        } else if (!found.empty()) {
            ++near;
            EXPECT_NEAR(deepest(found), exact, slack);
        }
        if (HasFailure()) return;
    }
    EXPECT_GT(overlapping, trials(200));
    EXPECT_GT(apart, trials(300));
}

// A body on a flat floor has the floor's normal only, and its own lowest corner as the deepest point.
TEST(PolyhedronOnSurface, FlatFloorHasOneNormalAtAnyResolution) {
    Random random(62);
    for (const int n : {1, 4, 20, 40}) {
        const auto floor = surface_of(grid_mesh(n, 2.0, 0.0));
        for (int trial = 0; trial < 40; ++trial) {
            const auto body = random_body(random, trial);
            Pose pose{{random(-1.2, 1.2), 1.0, random(-1.2, 1.2)}, random.turn().toRotationMatrix()};
            if (trial % 4 == 0) pose.rotation.setIdentity();
            const double gap = random(-1e-3, 0.01);
            pose.position.y() += gap - lowest(*body, pose);
            const auto found = collide_all(floor, {}, body, pose, 0.02);
            ASSERT_FALSE(found.empty());
            // The deepest of more than four points is kept to within a thousandth of the patch.
            EXPECT_NEAR(deepest(found), gap, 1e-3 * body->radius) << n << " " << trial;
            for (const Manifold& m : found) EXPECT_LT((m.normal - Vec3::UnitY()).norm(), 1e-12) << n << " " << trial;
        }
    }
}

// The footprint of a box on a tessellated floor is spanned by the contacts of all triangles together.
TEST(PolyhedronOnSurface, FlatBoxStandsOnItsWholeFootprint) {
    for (const int n : {1, 3, 16}) {
        const auto floor = surface_of(grid_mesh(n, 2.0, 0.0));
        for (const double angle : {0.0, 0.3, std::numbers::pi / 4}) {
            const Pose pose{{0.13, 0.4999, -0.21}, turned(Vec3::UnitY(), angle)};
            const auto box = box_of({1.0, 1.0, 0.6});
            Bounds footprint;
            for (const Manifold& m : collide_all(floor, {}, box, pose, 0.01))
                for (int i = 0; i < m.count; ++i) footprint.add(pose.to_body(m.points[std::size_t(i)].position));
            EXPECT_NEAR(footprint.min.x(), -0.5, 1e-9) << n;
            EXPECT_NEAR(footprint.max.x(), 0.5, 1e-9);
            EXPECT_NEAR(footprint.min.z(), -0.3, 1e-9);
            EXPECT_NEAR(footprint.max.z(), 0.3, 1e-9);
        }
    }
}

// In a valley only the slopes' own normals push.
TEST(PolyhedronOnSurface, ValleyNormalsAreTheSlopes) {
    Random random(63);
    const Vec3 left = Vec3(-0.5, 1.0, 0.0).normalized(), right(-left.x(), left.y(), 0.0);
    for (const int n : {2, 8, 20}) {
        const auto valley = surface_of(folded(0.5, n));
        for (int trial = 0; trial < 60; ++trial) {
            const auto body = random_body(random, trial);
            Pose pose{{random(-0.1, 0.1), 2.0, random(-0.5, 0.5)}, random.turn().toRotationMatrix()};
            double gap = 1e300;  // lowered until it touches one slope or both
            for (const Vec3& v : body->vertices) {
                const Vec3 p = pose.to_world(v);
                gap = std::min(gap, p.y() - 0.5 * std::abs(p.x()));
            }
            pose.position.y() -= gap + 1e-4;
            const auto found = collide_all(valley, {}, body, pose, 0.005);
            ASSERT_FALSE(found.empty());
            EXPECT_LT(deepest(found), 0.0);
            for (const Manifold& m : found)
                EXPECT_LT(std::min((m.normal - left).norm(), (m.normal - right).norm()), 1e-9) << n << " " << trial;
        }
    }
}

// A box lying across a convex ridge touches it with its bottom face: the normal may be the box's.
TEST(PolyhedronOnSurface, RidgeCarriesAFlatBox) {
    for (const int n : {2, 10}) {
        const auto ridge = surface_of(folded(-0.5, n));
        const auto found =
            collide_all(ridge, {}, box_of({1.0, 0.2, 0.6}), {{0.05, 0.0995, 0.03}, Mat3::Identity()}, 0.001);
        ASSERT_FALSE(found.empty());
        EXPECT_NEAR(deepest(found), -0.0005, 1e-9);
        Bounds line;
        for (const Manifold& m : found) {
            EXPECT_LT((m.normal - Vec3::UnitY()).norm(), 1e-9);
            for (int i = 0; i < m.count; ++i) line.add(m.points[std::size_t(i)].position);
        }
        EXPECT_NEAR(line.min.z(), -0.27, 1e-9);
        EXPECT_NEAR(line.max.z(), 0.33, 1e-9);
    }
}

TEST(PolyhedronOnSurface, ClosedPushesOutOnlyOpenBothWays) {
    const auto open = surface_of(grid_mesh(4, 2.0, 0.0)), closed = surface_of(box_mesh({-2, -1, -2}, {2, 0, 2}));
    const auto box = box_of({0.4, 0.4, 0.4});
    for (const double y : {0.19, -0.19}) {
        for (const auto& s : {open, closed}) {
            const auto found = collide_all(s, {}, box, {{0.31, y, 0.17}, turned(Vec3::UnitY(), 0.4)}, 0.001);
            if (s == closed && y < 0.0) {
                EXPECT_TRUE(found.empty());
                continue;
            }
            ASSERT_FALSE(found.empty());
            EXPECT_NEAR(deepest(found), -0.01, 1e-12);
            for (const Manifold& m : found) EXPECT_LT((m.normal - Vec3(0.0, y > 0 ? 1.0 : -1.0, 0.0)).norm(), 1e-12);
        }
    }
}

// Against the closed mesh of a box from outside: as against the box itself.
TEST(PolyhedronOnSurface, ClosedBoxMeshMatchesTheBox) {
    Random random(64);
    const Vec3 half(0.8, 0.5, 0.6);
    const auto mesh = surface_of(box_mesh(-half, half));
    const auto same = box_of(2.0 * half);
    int touched = 0;
    for (int trial = 0; trial < 600; ++trial) {
        const auto body = random_body(random, trial);
        Pose pose = random.pose(1.2);
        if (outside(*same, pose.position) < 0.05) continue;  // a center inside is specific to the solid
        const auto solid = collide_all(same, {}, body, pose, 0.0);
        if (solid.empty()) continue;
        // Out to a shallow overlap, as for contacts in motion.
        pose.position += (-deepest(solid) - 1e-4) * solid[0].normal;
        const auto shallow = collide_all(same, {}, body, pose, 0.0), found = collide_all(mesh, {}, body, pose, 0.0);
        if (shallow.empty() || deepest(shallow) > -5e-5 || deepest(shallow) < -2e-4) continue;
        ++touched;
        ASSERT_FALSE(found.empty()) << trial;
        EXPECT_LT(deepest(found), 0.0);
        EXPECT_GT(deepest(found), -2.0 * axis_preference(body->radius) - 2e-4) << trial;
    }
    EXPECT_GT(touched, 60);
}

// Flat, long and thick bodies on hills and in hollows: the mesh pushes them off the side that they are on, though they
// are behind the planes of triangles beyond a hill. For either winding of the triangles.
TEST(PolyhedronOnSurface, WavyGroundPushesOffOneSide) {
    Random random(65);
    for (const bool wound_alike : {true, false}) {
        TriangleMesh mesh = wavy_mesh(24, 6.0);
        for (auto& t : mesh.triangles)
            if (!wound_alike && random.below(2) == 0) std::swap(t[0], t[1]);
        const auto ground = surface_of(mesh);
        for (int trial = 0; trial < trials(400); ++trial) {
            const double thin = random(0.02, 0.06);
            const auto body = trial % 4 == 0   ? box_of({thin, random(0.3, 1.5), random(0.3, 1.5)})
                              : trial % 4 == 1 ? box_of({thin, thin, random(0.4, 1.5)})
                              : trial % 4 == 2 ? random_hull(random, 12, {0.6, random(0.05, 0.3), random(0.1, 0.5)})
                                               : box_of({random(0.1, 1.0), random(0.1, 1.0), random(0.1, 1.0)});
            Pose pose{{random(-4.0, 4.0), 0.0, random(-4.0, 4.0)}, random.turn().toRotationMatrix()};
            const double side = trial % 8 < 4 ? 1.0 : -1.0;  // from above, or from below
            double outside = side * 4.0, inside = wavy_height(pose.position.x(), pose.position.z());
            while (std::abs(outside - inside) > 1e-9) {
                pose.position.y() = 0.5 * (outside + inside);
                (overlap(*ground, *body, pose) ? inside : outside) = pose.position.y();
            }
            const double depth = 0.2 * body->inner_radius;
            pose.position.y() = outside - side * depth;
            const auto found = collide_all(ground, {}, body, pose, 0.01);
            ASSERT_FALSE(found.empty()) << trial;
            EXPECT_GE(deepest(found), -1.001 * depth - 2.0 * axis_preference(body->radius))
                << trial << " " << wound_alike;
            // An edge across a crease may be detected slightly late.
            EXPECT_LT(deepest(found), 0.2 * body->inner_radius) << trial << " " << wound_alike;
            for (const Manifold& m : found) EXPECT_GT(side * m.normal.y(), 0.0) << trial << " " << wound_alike;
        }
    }
}

}  // namespace tumble::mesh_polyhedron_test
