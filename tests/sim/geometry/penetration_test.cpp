// Convex pairs against the exact result: the faces of the Minkowski difference {b - a}, built by make_hull from all
// differences of vertices. The largest of the signed distances of the origin outside those faces is the separation
// along the best axis (negative: the depth of the overlap).
#include "sim/geometry/separating_axis.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

namespace tumble::penetration_test {
using namespace tumble::testing;

namespace {

struct Exact {
    double separation;
    Vec3 normal;  // away from A, world
};

Exact exact_separation(const Polyhedron& a, const Pose& pose_a, const Polyhedron& b, const Pose& pose_b) {
    std::vector<Vec3> differences;
    for (const Vec3& va : a.vertices)
        for (const Vec3& vb : b.vertices) differences.push_back(pose_b.to_world(vb) - pose_a.to_world(va));
    const Vec3 origin = mean(differences);
    const Polyhedron difference = make_hull(differences, origin);
    Exact best{-1e300, Vec3::Zero()};
    for (const auto& f : difference.faces) {
        const double separation = -(f.normal.dot(origin) + f.offset);
        if (separation > best.separation) best = {separation, -f.normal};
    }
    return best;
}

// The same number computed without a hull: separations along many directions never exceed it.
double separation_along(const Vec3& n, const Polyhedron& a, const Pose& pose_a, const Polyhedron& b,
                        const Pose& pose_b) {
    double reach_a = -1e300, reach_b = 1e300;
    for (const Vec3& v : a.vertices) reach_a = std::max(reach_a, n.dot(pose_a.to_world(v)));
    for (const Vec3& v : b.vertices) reach_b = std::min(reach_b, n.dot(pose_b.to_world(v)));
    return reach_b - reach_a;
}

struct Tally {
    int overlapping = 0, apart = 0, edges = 0;
};

void check_pair(const PolyhedronRef& a, const Pose& pose_a, const PolyhedronRef& b, const Pose& pose_b, double margin,
                Tally& tally) {
    const double radius = std::min(a->radius, b->radius), slack = face_over_edges(radius) + 1e-10 * radius;
    const Exact exact = exact_separation(*a, pose_a, *b, pose_b);
    const std::vector<Manifold> found = collide_all(a, pose_a, b, pose_b, margin);
    if (exact.separation > margin + 1e-10) {
        EXPECT_TRUE(found.empty()) << exact.separation;
        ++tally.apart;
        return;
    }
    // Nearer than the margin but corner to corner: no two faces or edges overlap, and no manifold is required.
    if (exact.separation > -1e-10) return;
    ASSERT_EQ(found.size(), 1u);
    ++tally.overlapping;
    const Manifold& m = found[0];
    ASSERT_GE(m.count, 1);
    EXPECT_NEAR(m.normal.norm(), 1.0, 1e-12);
    const double along = separation_along(m.normal, *a, pose_a, *b, pose_b);
    EXPECT_LE(along, exact.separation + 1e-10 * radius);  // no axis separates better than the exact one
    EXPECT_GE(along, exact.separation - slack) << "the axis is not that of least overlap";
    // The deepest point is as deep as the axis: the manifold contains the vertex that must be pushed out.
    EXPECT_GE(deepest(found), along - 1e-10 * radius);
    EXPECT_LE(deepest(found), along + 3.0 * slack) << "the deepest point is missing, " << m.count << " points";
    // Nor is it shallower: an overlap without a point would not be stopped.
    EXPECT_LE(deepest(found), exact.separation + 2.0 * axis_preference(radius)) << "of " << exact.separation;
    tally.edges += m.points[0].feature >> 62 == 1;
    for (int i = 0; i < m.count; ++i) {
        const ContactPoint& p = m.points[std::size_t(i)];
        // Half the separation from either point is a point of either body (the preferred axis may miss the best one's
        // place by more than its depth).
        EXPECT_LT(outside(*a, pose_a.to_body(p.position - 0.5 * p.separation * m.normal)), 10.0 * slack);
        EXPECT_LT(outside(*b, pose_b.to_body(p.position + 0.5 * p.separation * m.normal)), 10.0 * slack);
        EXPECT_LE(p.separation, margin);
    }
}

}  // namespace

TEST(Penetration, BoxAgainstBox) {
    Random random(11);
    Tally tally;
    for (int trial = 0; trial < trials(400); ++trial) {
        const auto a = box_of({random(0.2, 2.0), random(0.2, 2.0), random(0.2, 2.0)});
        const auto b = box_of({random(0.2, 2.0), random(0.2, 2.0), random(0.2, 2.0)});
        check_pair(a, random.pose(0.6), b, random.pose(0.6), 0.02, tally);
    }
    EXPECT_GT(tally.overlapping, trials(70) - 1);
    EXPECT_GT(tally.apart, trials(30) - 1);
    EXPECT_GT(tally.edges, trials(20) - 1);
}

TEST(Penetration, HullAgainstBoxEitherWay) {
    Random random(12);
    Tally tally;
    for (int trial = 0; trial < trials(300); ++trial) {
        const auto hull = random_hull(random, 5 + random.below(20), {1.0, random(0.1, 1.0), random(0.1, 1.0)});
        const auto box = box_of({random(0.2, 2.0), random(0.2, 2.0), random(0.2, 2.0)});
        const Pose p = random.pose(0.6), q = random.pose(0.6);
        check_pair(hull, p, box, q, 0.02, tally);
        check_pair(box, q, hull, p, 0.02, tally);
    }
    EXPECT_GT(tally.overlapping, trials(140) - 1);
    EXPECT_GT(tally.edges, trials(20) - 1);
}

TEST(Penetration, HullAgainstHull) {
    Random random(13);
    Tally tally;
    for (int trial = 0; trial < trials(300); ++trial) {
        const auto a = random_hull(random, 4 + random.below(16), {1.0, random(0.05, 1.0), random(0.05, 1.0)});
        const auto b = random_hull(random, 4 + random.below(16), {1.0, random(0.05, 1.0), random(0.05, 1.0)});
        check_pair(a, random.pose(0.7), b, random.pose(0.7), 0.02, tally);
    }
    EXPECT_GT(tally.overlapping, trials(70) - 1);
    EXPECT_GT(tally.edges, trials(20) - 1);
}

// Just touching, as bodies at rest do: pairs pushed along the exact normal until they overlap slightly.
TEST(Penetration, ShallowOverlaps) {
    Random random(14);
    Tally tally;
    for (int trial = 0; trial < trials(400); ++trial) {
        const auto a = random_hull(random, 4 + random.below(20), {1.0, random(0.1, 1.0), random(0.1, 1.0)});
        const auto b = trial % 2 ? box_of({random(0.2, 2.0), random(0.2, 2.0), random(0.2, 2.0)})
                                 : random_hull(random, 4 + random.below(20), {1.0, random(0.1, 1.0), random(0.1, 1.0)});
        const Pose pose_a = random.pose(1.0);
        Pose pose_b = random.pose(1.0);
        const Exact exact = exact_separation(*a, pose_a, *b, pose_b);
        if (exact.separation > 0.0) continue;
        const double depth = trial % 3 == 0 ? 1e-7 : trial % 3 == 1 ? 1e-4 : 1e-2;
        pose_b.position += (-depth - exact.separation) * exact.normal;
        check_pair(a, pose_a, b, pose_b, 0.02, tally);
    }
    EXPECT_GT(tally.overlapping, trials(70) - 1);
}

// Small faces, as on rounded meshes, meet a box's edge beyond their borders.
TEST(Penetration, RoundedHullAtABoxesEdge) {
    Random random(17);
    Tally tally;
    for (int trial = 0; trial < trials(200); ++trial) {
        std::vector<Vec3> points;
        for (int i = 0; i < 150; ++i)
            points.push_back(0.3 * random.direction().cwiseProduct(Vec3(1.0, random(0.99, 1.0), 1.0)));
        const auto round = std::make_shared<const Polyhedron>(make_hull(points, mean(points)));
        const auto box = box_of({random(0.2, 1.0), random(0.2, 1.0), random(0.2, 1.0)});
        const Pose pose_a = random.pose(1.0);
        Pose pose_b = random.pose(1.0);
        const Exact exact = exact_separation(*round, pose_a, *box, pose_b);
        pose_b.position += (-random(1e-4, 1e-2) - exact.separation) * exact.normal;
        check_pair(round, pose_a, box, pose_b, 0.02, tally);
    }
    EXPECT_GT(tally.overlapping, trials(50) - 1);
    EXPECT_GT(tally.edges, trials(10) - 1);
}

// The reference itself: no sampled direction exceeds the Minkowski difference's best face.
TEST(Penetration, ReferenceBoundsSampledDirections) {
    Random random(15);
    for (int trial = 0; trial < 20; ++trial) {
        const auto a = random_hull(random, 12, {1.0, 0.7, 0.4}), b = random_hull(random, 12, {0.5, 0.7, 1.0});
        const Pose pose_a = random.pose(0.4), pose_b = random.pose(0.4);
        const Exact exact = exact_separation(*a, pose_a, *b, pose_b);
        if (exact.separation > 0.0) continue;
        EXPECT_NEAR(separation_along(exact.normal, *a, pose_a, *b, pose_b), exact.separation, 1e-12);
        for (int k = 0; k < 2000; ++k)
            EXPECT_LE(separation_along(random.direction(), *a, pose_a, *b, pose_b), exact.separation + 1e-12);
    }
}

// Face to face at a gap inside the margin: the gap is found, and its four corners.
TEST(Penetration, GapsInsideTheMarginAreFound) {
    Random random(16);
    for (int trial = 0; trial < trials(100); ++trial) {
        const Pose world = random.pose(5.0);
        const double gap = random(1e-6, 0.019);
        const auto a = box_of({1.0, 1.0, 1.0});
        const Pose above{{random(-0.4, 0.4), 0.75 + gap, random(-0.4, 0.4)},
                         Eigen::AngleAxisd(random(-3.0, 3.0), Vec3::UnitY()).toRotationMatrix()};
        for (const auto& b : {box_of({0.5, 0.5, 0.5}), plain_box({0.5, 0.5, 0.5})}) {
            const auto found = collide_all(a, world, b, after(world, above), 0.02);
            ASSERT_EQ(found.size(), 1u);
            EXPECT_GE(found[0].count, 3);
            EXPECT_NEAR(deepest(found), gap, 1e-12);
            EXPECT_LT((found[0].normal - world.rotation.col(1)).norm(), 1e-12);
            EXPECT_TRUE(collide_all(a, world, b, after(world, above), gap - 1e-9).empty());
        }
    }
}

}  // namespace tumble::penetration_test
