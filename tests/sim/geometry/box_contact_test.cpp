// Boxes on boxes and on the ground, in typical poses: aligned, rotated, edge on edge, degenerate.
#include "core/vector.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

namespace tumble::box_contact_test {
using namespace tumble::testing;

namespace {

Mat3 turned(const Vec3& axis, double angle) { return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(); }

// Area spanned by the points of a manifold, in order of their angle about the normal.
double contact_area(const Manifold& m) {
    std::vector<Vec3> p;
    for (int i = 0; i < m.count; ++i) p.push_back(m.points[std::size_t(i)].position);
    const Vec3 center = mean(p), t = m.normal.unitOrthogonal(), s = m.normal.cross(t);
    std::sort(p.begin(), p.end(), [&](const Vec3& a, const Vec3& b) {
        return std::atan2(s.dot(a - center), t.dot(a - center)) < std::atan2(s.dot(b - center), t.dot(b - center));
    });
    double area = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i)
        area += 0.5 * m.normal.dot((p[i] - center).cross(p[(i + 1) % p.size()] - center));
    return area;
}

std::set<std::uint64_t> features(const std::vector<Manifold>& found) {
    std::set<std::uint64_t> ids;
    for (const Manifold& m : found)
        for (int i = 0; i < m.count; ++i) ids.insert(m.points[std::size_t(i)].feature);
    return ids;
}

struct BoxKind {
    const char* name;
    PolyhedronRef (*make)(const Vec3&);
};
const BoxKind kinds[] = {
    {"box", box_of}, {"plain", plain_box}, {"hull", [](const Vec3& size) -> PolyhedronRef {
                                                return std::make_shared<const Polyhedron>(
                                                    make_hull(make_box(size).vertices, Vec3::Zero()));
                                            }}};

}  // namespace

TEST(BoxOnBox, AlignedTouchesAtTheFourCorners) {
    for (const BoxKind& kind : kinds) {
        const auto below = kind.make({2.0, 1.0, 2.0}), above = kind.make({1.0, 1.0, 0.5});
        for (const double gap : {0.0, 1e-9, -1e-9, -1e-3, 0.01}) {
            const auto found = collide_all(below, {}, above, {{0.2, 1.0 + gap, 0.1}, Mat3::Identity()}, 0.02);
            ASSERT_EQ(found.size(), 1u) << kind.name << gap;
            const Manifold& m = found[0];
            EXPECT_LT((m.normal - Vec3::UnitY()).norm(), 1e-15);
            ASSERT_EQ(m.count, 4);
            EXPECT_EQ(features(found).size(), 4u);
            for (int i = 0; i < 4; ++i) {
                const ContactPoint& p = m.points[std::size_t(i)];
                EXPECT_NEAR(p.separation, gap, 1e-15);
                EXPECT_NEAR(std::abs(p.position.x() - 0.2), 0.5, 1e-12);
                EXPECT_NEAR(std::abs(p.position.z() - 0.1), 0.25, 1e-12);
                EXPECT_NEAR(p.position.y(), 0.5 + 0.5 * gap, 1e-12);
            }
            EXPECT_NEAR(contact_area(m), 0.5, 1e-12);
        }
    }
}

// Identical boxes exactly stacked: every edge lies over another, and clipping meets only ties.
TEST(BoxOnBox, SameSizeStacked) {
    for (const BoxKind& kind : kinds)
        for (const double shift : {0.0, 1e-16, 1e-13, -1e-10}) {
            const auto box = kind.make({1.0, 1.0, 1.0});
            const auto found = collide_all(box, {}, box, {{shift, 1.0, -shift}, Mat3::Identity()}, 0.02);
            ASSERT_EQ(found.size(), 1u) << kind.name;
            EXPECT_EQ(found[0].count, 4);
            EXPECT_NEAR(contact_area(found[0]), 1.0, 1e-9);
        }
}

// A square over the same square rotated by 45 degrees: a regular octagon of area 2 (sqrt 2 - 1). Four points of it span
// at least 1/sqrt 2 of that (the largest square in the octagon), and none lies outside it.
TEST(BoxOnBox, RotatedByFortyFiveDegrees) {
    for (const BoxKind& kind : kinds) {
        const auto box = kind.make({1.0, 1.0, 1.0});
        const Pose above{{0.0, 0.9999, 0.0}, turned(Vec3::UnitY(), std::numbers::pi / 4)};
        const auto found = collide_all(box, {}, box, above, 0.02);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0].count, 4);
        const double octagon = 2.0 * (std::numbers::sqrt2 - 1.0);
        EXPECT_LE(contact_area(found[0]), octagon + 1e-12);
        EXPECT_GE(contact_area(found[0]), octagon / std::numbers::sqrt2 - 1e-12) << kind.name;
        for (int i = 0; i < 4; ++i) {
            const Vec3 p = found[0].points[std::size_t(i)].position;
            EXPECT_LE(std::max(std::abs(p.x()), std::abs(p.z())), 0.5 + 1e-12);
            EXPECT_LE(std::abs(p.x()) + std::abs(p.z()), std::sqrt(0.5) + 1e-12);
        }
    }
}

TEST(BoxOnBox, CrossedEdgesTouchAtOnePoint) {
    for (const BoxKind& kind : kinds) {
        const auto box = kind.make({2.0, 2.0, 2.0});
        const double top = std::numbers::sqrt2;  // of an edge on top
        for (const double gap : {-0.05, -1e-4, 0.01}) {
            const Pose below{Vec3::Zero(), turned(Vec3::UnitX(), std::numbers::pi / 4)};
            const Pose above{{0.1, 2.0 * top + gap, 0.2}, turned(Vec3::UnitZ(), std::numbers::pi / 4)};
            const auto found = collide_all(box, below, box, above, 0.02);
            ASSERT_EQ(found.size(), 1u) << kind.name << gap;
            ASSERT_EQ(found[0].count, 1);
            EXPECT_LT((found[0].normal - Vec3::UnitY()).norm(), 1e-12);
            EXPECT_NEAR(found[0].points[0].separation, gap, 1e-12);
            EXPECT_LT((found[0].points[0].position - Vec3(0.1, top + 0.5 * gap, 0.0)).norm(), 1e-12);
        }
    }
}

// The shortcuts for boxes against the general routine, overlapping or near.
TEST(BoxOnBox, AsBoxAndAsHullAgree) {
    Random random(31);
    int found = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const Vec3 size_a(random(0.2, 2.0), random(0.2, 2.0), random(0.2, 2.0)),
            size_b(random(0.2, 2.0), random(0.2, 2.0), 1.0);
        const Pose a = random.pose(0.7), b = random.pose(0.7);
        const auto quick = collide_all(box_of(size_a), a, box_of(size_b), b, 0.02);
        const auto plain = collide_all(plain_box(size_a), a, plain_box(size_b), b, 0.02);
        // Corner to corner, nearer than the margin by the axis but not face to face, either may give no manifold.
        if (quick.size() != plain.size()) {
            EXPECT_GT(deepest(quick.empty() ? plain : quick), 0.0);
            continue;
        }
        if (quick.empty()) continue;
        ++found;
        EXPECT_LT((quick[0].normal - plain[0].normal).norm(), 1e-12);
        ASSERT_EQ(quick[0].count, plain[0].count);
        EXPECT_EQ(features(quick), features(plain));
        for (std::size_t i = 0; i < std::size_t(quick[0].count); ++i)
            EXPECT_LT((quick[0].points[i].position - plain[0].points[i].position).norm(), 1e-12);
    }
    EXPECT_GT(found, 300);
}

TEST(BoxOnBox, FeaturesStayTheSameUnderSmallMotion) {
    Random random(32);
    int changed = 0, total = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const auto a = box_of({2.0, 1.0, 2.0}), b = box_of({1.0, 1.0, 1.0});
        // Resting flat, rotated about the vertical, with the amplitude of a solver's jitter.
        const Pose at{{random(-0.9, 0.9), 0.9999, random(-0.9, 0.9)}, turned(Vec3::UnitY(), random(0.05, 1.5))};
        const auto before = collide_all(a, {}, b, at, 0.02);
        for (int k = 0; k < 5; ++k) {
            const Pose moved{at.position + random.vector(1e-5), turned(random.direction(), 1e-5) * at.rotation};
            const auto now = collide_all(a, {}, b, moved, 0.02);
            ASSERT_EQ(now.size(), 1u);
            EXPECT_LT((now[0].normal - before[0].normal).norm(), 1e-4);
            ++total;
            changed += features(now) != features(before);
        }
    }
    EXPECT_LE(changed, total / 100);  // a corner right on an edge may come and go
}

// Only ties: corner on corner, corner on edge, edge along edge, face edges exactly over each other.
TEST(BoxOnBox, DegenerateTouchesAreFiniteAndShallow) {
    const double diagonal = std::sqrt(3.0);
    const Mat3 on_corner = rotation_between(Vec3(1.0, 1.0, 1.0), Vec3::UnitY()).toRotationMatrix();
    const Mat3 on_edge = turned(Vec3::UnitX(), std::numbers::pi / 4);
    struct Case {
        Mat3 below, above;
        Vec3 at;
    };
    const Case cases[] = {{on_corner, on_corner, {0.0, 2.0 * diagonal, 0.0}},                  // corner on corner
                          {on_edge, on_corner, {0.0, std::numbers::sqrt2 + diagonal, 0.0}},    // corner on edge
                          {on_edge, on_edge, {0.0, 2.0 * std::numbers::sqrt2, 0.0}},           // edge along edge
                          {Mat3::Identity(), on_edge, {0.0, 1.0 + std::numbers::sqrt2, 0.0}},  // edge on face
                          {Mat3::Identity(), on_corner, {0.0, 1.0 + diagonal, 0.0}},           // corner on face
                          {Mat3::Identity(), Mat3::Identity(), {2.0, 2.0, 0.0}},               // edges side by side
                          {Mat3::Identity(), Mat3::Identity(), {2.0, 2.0, 2.0}}};              // corners side by side
    for (const BoxKind& kind : kinds) {
        const auto box = kind.make({2.0, 2.0, 2.0});
        for (const Case& c : cases)
            for (const double gap : {0.0, -1e-12, -1e-6, -1e-3}) {
                const Pose above{c.at * (1.0 + gap / c.at.norm()), c.above};
                const auto found = collide_all(box, {Vec3::Zero(), c.below}, box, above, 0.02);
                if (gap <= -1e-6) {
                    ASSERT_EQ(found.size(), 1u) << kind.name << " " << c.at.transpose() << " " << gap;
                }
                for (const Manifold& m : found) {
                    EXPECT_NEAR(m.normal.norm(), 1.0, 1e-12);
                    EXPECT_GT(m.normal.dot(c.at), 0.0);
                    for (int i = 0; i < m.count; ++i) {
                        EXPECT_TRUE(m.points[std::size_t(i)].position.allFinite());
                        EXPECT_GE(m.points[std::size_t(i)].separation, gap - 1e-9)
                            << kind.name << " " << c.at.transpose();
                    }
                }
            }
    }
}

TEST(BoxOnGround, FlatEdgeAndCorner) {
    const HalfSpace ground{Vec3::UnitY(), 0.25};
    for (const BoxKind& kind : kinds) {
        const auto box = kind.make({1.0, 2.0, 3.0});
        const auto flat = collide_all(ground, {}, box, {{5.0, 1.2, 1.0}, Mat3::Identity()}, 0.01);
        ASSERT_EQ(flat.size(), 1u);
        EXPECT_EQ(flat[0].count, 4);
        EXPECT_NEAR(contact_area(flat[0]), 3.0, 1e-12);
        EXPECT_NEAR(deepest(flat), -0.05, 1e-12);
        EXPECT_NEAR(flat[0].points[0].position.y(), 0.225, 1e-12);  // halfway between the surfaces
        const auto edge = collide_all(ground, {}, box, {{0.0, 1.2, 0.0}, turned(Vec3::UnitZ(), 0.4)}, 0.01);
        ASSERT_EQ(edge.size(), 1u);
        EXPECT_EQ(edge[0].count, 2);
        const auto corner = collide_all(ground, {}, box, {{0.0, 1.7, 0.0}, turned({1.0, 0.3, 0.7}, 0.5)}, 0.01);
        ASSERT_EQ(corner.size(), 1u);
        EXPECT_EQ(corner[0].count, 1);
    }
}

// More points than a manifold holds: the kept ones span the area, the deepest among them.
TEST(HullOnGround, ManyCornersAreSpannedByFour) {
    for (const int sides : {5, 6, 12, 64}) {
        std::vector<Vec3> points;
        for (int i = 0; i < sides; ++i)
            for (const double y : {-0.5, 0.5}) {
                const double t = 2.0 * std::numbers::pi * i / sides;
                points.emplace_back(std::cos(t), y, std::sin(t));
            }
        const auto prism = std::make_shared<const Polyhedron>(make_hull(points, Vec3::Zero()));
        ASSERT_EQ(prism->faces.size(), std::size_t(sides) + 2);
        const double whole = 0.5 * sides * std::sin(2.0 * std::numbers::pi / sides);
        const auto found =
            collide_all(HalfSpace{Vec3::UnitY(), 0.0}, {}, prism, {{3.0, 0.49, -2.0}, Mat3::Identity()}, 0.01);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0].count, 4);
        EXPECT_GT(contact_area(found[0]), 0.6 * whole) << sides;
        // The center of mass lies over the contact: the hull stands.
        const auto on_box =
            collide_all(box_of({4.0, 1.0, 4.0}), {}, prism, {{0.3, 0.99, -0.2}, Mat3::Identity()}, 0.01);
        ASSERT_EQ(on_box.size(), 1u);
        EXPECT_EQ(on_box[0].count, 4);
        EXPECT_GT(contact_area(on_box[0]), 0.6 * whole) << sides;
    }
}

// The routine for boxes against the one for all polyhedra: the same manifolds, including features.
TEST(BoxOnBox, SameAsAnyPolyhedron) {
    Random random(91);
    int touching = 0, edges = 0, others = 0;
    for (int i = 0; i < trials(10000); ++i) {
        const Vec3 size_a = random.vector(0.5) + Vec3::Constant(0.8), size_b = random.vector(0.5) + Vec3::Constant(0.8);
        // Half of them lie nearly flat: on top, or beside.
        const Pose pose_a = random.pose(1.0);
        Pose b_in_a = random.pose(0.9);
        if (i % 2 == 0) {
            b_in_a.rotation = turned(random.direction(), random(0.0, 0.05));
            b_in_a.position[i / 2 % 3] = 0.5 * (size_a + size_b)[i / 2 % 3] + random(-0.03, 0.03);
        }
        const Pose pose_b = after(pose_a, b_in_a);
        const auto expected = collide_all(plain_box(size_a), pose_a, plain_box(size_b), pose_b, 0.03);
        const auto found = collide_all(box_of(size_a), pose_a, box_of(size_b), pose_b, 0.03);
        ASSERT_EQ(found.size(), expected.size()) << i;
        if (found.empty()) continue;
        ++touching;
        const Manifold &m = found[0], &e = expected[0];
        if ((m.normal - e.normal).norm() > 1e-9 || m.count != e.count) {  // two axes that overlap equally, to rounding
            ++others;
            continue;
        }
        edges += (m.points[0].feature >> 62) == 1;
        for (std::size_t k = 0; k < std::size_t(m.count); ++k) {
            EXPECT_EQ(m.points[k].feature, e.points[k].feature) << i;
            EXPECT_LT((m.points[k].position - e.points[k].position).norm(), 1e-9) << i;
            EXPECT_NEAR(m.points[k].separation, e.points[k].separation, 1e-9) << i;
        }
    }
    EXPECT_GT(touching, trials(5000));
    EXPECT_GT(edges, trials(250));
    EXPECT_LE(others, touching / 1000);
}

}  // namespace tumble::box_contact_test
