// Properties of every pair of shapes: the normal away from A, order of the arguments, rigid motion, distance.
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <functional>

namespace tumble::collide_pairs_test {
using namespace tumble::testing;

namespace {

struct NamedShape {
    std::string name;
    CollisionShape collider;
    bool movable;
};

TriangleMesh bumpy_grid(Random& random) {
    TriangleMesh mesh = grid_mesh(5, 1.5, 0.0);
    for (Vec3& v : mesh.vertices) v.y() = random(-0.15, 0.15);
    return mesh;
}

std::vector<NamedShape> all_shapes(Random& random) {
    return {{"half-space", HalfSpace{random.direction(), random(-0.5, 0.5)}, false},
            {"ball", Ball{random(0.2, 0.8)}, true},
            {"box", box_of({random(0.3, 1.2), random(0.3, 1.2), random(0.3, 1.2)}), true},
            {"hull", random_hull(random, 24, {0.7, 0.5, 0.6}), true},
            {"open surface", surface_of(bumpy_grid(random)), false},
            {"closed surface", surface_of(box_mesh({-0.8, -0.5, -0.6}, {0.8, 0.5, 0.6})), false}};
}

void expect_same(const std::vector<Manifold>& a, const std::vector<Manifold>& b, double sign, double tolerance,
                 const std::function<Vec3(const Vec3&)>& move, const Mat3& turn) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_LT((turn * a[i].normal - sign * b[i].normal).norm(), tolerance);
        EXPECT_EQ(a[i].part, b[i].part);
        ASSERT_EQ(a[i].count, b[i].count);
        for (std::size_t k = 0; k < std::size_t(a[i].count); ++k) {
            EXPECT_LT((move(a[i].points[k].position) - b[i].points[k].position).norm(), tolerance);
            EXPECT_NEAR(a[i].points[k].separation, b[i].points[k].separation, tolerance);
            EXPECT_EQ(a[i].points[k].feature, b[i].points[k].feature);
        }
    }
}

// Calls f for pairs of shapes in random poses near each other, one of them movable.
void for_pairs(std::uint64_t seed, int rounds,
               const std::function<void(const NamedShape&, const Pose&, const NamedShape&, const Pose&)>& f) {
    Random random(seed);
    for (int round = 0; round < rounds; ++round) {
        const auto shapes = all_shapes(random), others = all_shapes(random);
        for (const NamedShape& a : shapes)
            for (const NamedShape& b : others) {
                if (!a.movable && !b.movable) continue;
                SCOPED_TRACE(a.name + " and " + b.name + ", round " + std::to_string(round));
                f(a, random.pose(0.5), b, random.pose(0.5));
            }
    }
}

constexpr double margin = 0.02;

}  // namespace

// The same pair in the other order. Two polyhedra may prefer the other's face: for them the plane must agree.
TEST(Pairs, SwappedArgumentsReverseTheNormal) {
    int found = 0;
    for_pairs(21, 40, [&](const NamedShape& a, const Pose& pose_a, const NamedShape& b, const Pose& pose_b) {
        const auto ab = collide_all(a.collider, pose_a, b.collider, pose_b, margin);
        const auto ba = collide_all(b.collider, pose_b, a.collider, pose_a, margin);
        found += !ab.empty();
        if (a.collider.index() == b.collider.index() && std::holds_alternative<PolyhedronRef>(a.collider)) {
            const double preference = 2e-3;
            ASSERT_EQ(ab.empty(), ba.empty());
            if (!ab.empty()) {
                EXPECT_NEAR(deepest(ab), deepest(ba), preference);
            }
        } else {
            expect_same(
                ab, ba, -1.0, 1e-12, [](const Vec3& p) { return p; }, Mat3::Identity());
        }
    });
    EXPECT_GT(found, 500);
}

TEST(Pairs, RigidMotionMovesTheManifold) {
    Random random(22);
    for_pairs(23, 30, [&](const NamedShape& a, const Pose& pose_a, const NamedShape& b, const Pose& pose_b) {
        const auto here = collide_all(a.collider, pose_a, b.collider, pose_b, margin);
        const Pose motion = random.pose(3.0);
        const auto there = collide_all(a.collider, after(motion, pose_a), b.collider, after(motion, pose_b), margin);
        expect_same(
            here, there, 1.0, 1e-9, [&](const Vec3& p) { return motion.to_world(p); }, motion.rotation);
    });
}

// 1e4 m from the origin a double still resolves 2e-12 m.
TEST(Pairs, FarFromTheOriginNothingChanges) {
    for_pairs(24, 30, [&](const NamedShape& a, const Pose& pose_a, const NamedShape& b, const Pose& pose_b) {
        const auto here = collide_all(a.collider, pose_a, b.collider, pose_b, margin);
        const Vec3 shift(1e4, -1e4, 1e4);
        const auto there = collide_all(a.collider, {pose_a.position + shift, pose_a.rotation}, b.collider,
                                       {pose_b.position + shift, pose_b.rotation}, margin);
        expect_same(
            here, there, 1.0, 1e-7, [&](const Vec3& p) { return Vec3(p + shift); }, Mat3::Identity());
    });
}

// Pushing B along the normal opens the gap by as much: the normal points away from A, and the separation is measured
// along it. For convex pairs that overlap, one push by the depth separates them.
TEST(Pairs, PushingAlongTheNormalSeparates) {
    for_pairs(25, 40, [&](const NamedShape& a, const Pose& pose_a, const NamedShape& b, const Pose& pose_b) {
        if (a.name.ends_with("surface") || b.name.ends_with("surface")) return;
        const auto found = collide_all(a.collider, pose_a, b.collider, pose_b, margin);
        if (found.empty()) return;
        ASSERT_EQ(found.size(), 1u);
        EXPECT_NEAR(found[0].normal.norm(), 1.0, 1e-12);
        const double depth = -deepest(found);
        const Pose freed{pose_b.position + (depth + margin + 3e-3) * found[0].normal, pose_b.rotation};
        EXPECT_TRUE(collide_all(a.collider, pose_a, b.collider, freed, margin).empty()) << depth;
    });
}

TEST(Pairs, DistantPairsGiveNoManifold) {
    Random random(26);
    for_pairs(27, 10, [&](const NamedShape& a, const Pose& pose_a, const NamedShape& b, const Pose& pose_b) {
        // A movable shape well outside, not inside of a half-space.
        const double reach =
            (a.movable ? bounding_radius(a.collider) : 4.0) + (b.movable ? bounding_radius(b.collider) : 4.0);
        Vec3 way = random.direction();
        if (const auto* s = std::get_if<HalfSpace>(&a.collider)) way = pose_a.rotation * s->normal;
        if (const auto* s = std::get_if<HalfSpace>(&b.collider)) way = -(pose_b.rotation * s->normal);
        const Pose away{pose_a.position + (reach + 1.0) * way, pose_b.rotation};
        EXPECT_TRUE(collide_all(a.collider, pose_a, b.collider, away, margin).empty());
    });
}

// Every point and normal is finite in any relative pose: same centers, same poses.
TEST(Pairs, CoincidentCentersAreFinite) {
    for_pairs(28, 10, [&](const NamedShape& a, const Pose& pose_a, const NamedShape& b, const Pose& pose_b) {
        for (const Pose& other : {Pose{pose_a.position, pose_b.rotation}, pose_a}) {
            const auto found = collide_all(a.collider, pose_a, b.collider, other, margin);
            for (const Manifold& m : found) {
                EXPECT_NEAR(m.normal.norm(), 1.0, 1e-9);
                ASSERT_GE(m.count, 1);
                for (int i = 0; i < m.count; ++i) {
                    EXPECT_TRUE(m.points[std::size_t(i)].position.allFinite());
                    EXPECT_TRUE(std::isfinite(m.points[std::size_t(i)].separation));
                }
            }
            if (a.movable && b.movable) {
                ASSERT_EQ(found.size(), 1u);
                EXPECT_LT(deepest(found), -0.1);
            }
        }
    });
}

TEST(Pairs, ImmovablePairsNeverTouch) {
    Random random(29);
    for (const NamedShape& a : all_shapes(random))
        for (const NamedShape& b : all_shapes(random)) {
            if (a.movable || b.movable) continue;
            EXPECT_TRUE(collide_all(a.collider, {}, b.collider, {}, 1.0).empty());
        }
}

}  // namespace tumble::collide_pairs_test
