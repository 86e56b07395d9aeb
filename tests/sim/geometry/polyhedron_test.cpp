// Boxes and hulls: planes, edges, Euler's formula, coplanar merging, degenerate and extreme inputs.
#include "core/error.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace tumble::polyhedron_test {
using namespace tumble::testing;

namespace {

// Invariants of every convex polyhedron. `size`: the scale of its points.
void expect_sound(const Polyhedron& p, double size) {
    EXPECT_EQ(int(p.vertices.size()) - int(p.edges.size()) + int(p.faces.size()), 2);
    const Vec3 inside = mean(p.vertices);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> left_of;  // directed edge -> face
    std::set<std::uint32_t> used;
    for (std::uint32_t f = 0; f < p.faces.size(); ++f) {
        const Polyhedron::Face& face = p.faces[f];
        EXPECT_NEAR(face.normal.norm(), 1.0, 1e-14);
        EXPECT_LT(face.normal.dot(inside), face.offset);
        ASSERT_GE(face.vertices.size(), 3u);
        for (const Vec3& v : p.vertices) EXPECT_LT(face.normal.dot(v) - face.offset, 1e-12 * size);
        Vec3 area = Vec3::Zero();
        for (std::size_t i = 0; i < face.vertices.size(); ++i) {
            const std::uint32_t a = face.vertices[i], b = face.vertices[(i + 1) % face.vertices.size()];
            used.insert(a);
            EXPECT_LT(std::abs(face.normal.dot(p.vertices[a]) - face.offset), 1e-12 * size);
            EXPECT_TRUE(left_of.emplace(std::make_pair(a, b), f).second) << "a directed edge twice";
            area += (p.vertices[a] - inside).cross(p.vertices[b] - inside);
        }
        EXPECT_GT(area.dot(face.normal), 0.0) << "clockwise";
    }
    EXPECT_EQ(used.size(), p.vertices.size());
    EXPECT_EQ(left_of.size(), 2 * p.edges.size());
    for (const Polyhedron::Edge& e : p.edges) {
        EXPECT_NE(e.left, e.right);
        ASSERT_TRUE(left_of.count({e.tail, e.head}) && left_of.count({e.head, e.tail}));
        EXPECT_EQ(left_of.at({e.tail, e.head}), e.left);
        EXPECT_EQ(left_of.at({e.head, e.tail}), e.right);
    }
    for (const Vec3& v : p.vertices) {
        EXPECT_LE(v.norm(), p.radius);
        EXPECT_TRUE(p.bounds.overlaps({v, v}));
    }
}

}  // namespace

TEST(Box, HasEightCornersSixFacesTwelveEdges) {
    const Polyhedron p = make_box({1.0, 2.0, 3.0});
    EXPECT_EQ(p.vertices.size(), 8u);
    EXPECT_EQ(p.faces.size(), 6u);
    EXPECT_EQ(p.edges.size(), 12u);
    for (int f = 0; f < 6; ++f) {
        const Vec3 normal = Vec3::Unit(f / 2) * (f % 2 ? -1.0 : 1.0);
        EXPECT_EQ(p.faces[std::size_t(f)].normal, normal);
        EXPECT_EQ(p.faces[std::size_t(f)].offset, 0.5 * (1.0 + f / 2));
    }
    EXPECT_DOUBLE_EQ(p.surface_area(), 22.0);
    EXPECT_DOUBLE_EQ(p.radius, 0.5 * std::sqrt(14.0));
    expect_sound(p, 3.0);
}

TEST(Hull, OfRandomPointsIsSoundAndHoldsThemAll) {
    Random random(1);
    for (int trial = 0; trial < 60; ++trial) {
        const double size = trial % 3 == 0 ? 1e-4 : trial % 3 == 1 ? 1.0 : 1e4;
        const Vec3 stretch = trial % 4 == 0 ? Vec3(1.0, 0.02, 0.5) : Vec3(1.0, 0.8, 0.6);
        std::vector<Vec3> cloud;
        const int points = 4 + random.below(60);
        for (int i = 0; i < points; ++i) cloud.push_back(size * stretch.cwiseProduct(random.vector(1.0)));
        const Vec3 origin = mean(cloud);
        const Polyhedron p = make_hull(cloud, origin);
        expect_sound(p, size);
        for (const Vec3& c : cloud) EXPECT_LT(outside(p, c - origin), 1e-12 * size);
    }
}

// Points far from their own origin: the error is that of double precision at that distance.
TEST(Hull, FarOffKeepsItsDigits) {
    Random random(2);
    std::vector<Vec3> near, far;
    const Vec3 shift(1e4, -2e4, 3e4);
    for (int i = 0; i < 30; ++i) {
        near.push_back(random.vector(1.0));
        far.push_back(near.back() + shift);
    }
    const Polyhedron p = make_hull(near, Vec3::Zero()), q = make_hull(far, shift);
    expect_sound(q, 1.0);
    EXPECT_EQ(p.vertices.size(), q.vertices.size());
    EXPECT_EQ(p.faces.size(), q.faces.size());
    EXPECT_NEAR(p.surface_area(), q.surface_area(), 1e-9);
}

TEST(Hull, CoplanarPointsMakeOneFace) {
    for (const double size : {1e-4, 1.0, 1e4}) {
        std::vector<Vec3> points;
        for (int i = 0; i <= 6; ++i)
            for (int j = 0; j <= 6; ++j)
                for (int k = 0; k <= 6; ++k)
                    if (i % 6 == 0 || j % 6 == 0 || k % 6 == 0)
                        points.push_back(size * Vec3(i / 6.0, j / 6.0, k / 6.0));
        const Polyhedron p = make_hull(points, size * Vec3::Constant(0.5));
        EXPECT_EQ(p.faces.size(), 6u);
        EXPECT_EQ(p.edges.size(), 12u);
        EXPECT_EQ(p.vertices.size(), 8u);
        EXPECT_NEAR(p.surface_area(), 6.0 * size * size, 1e-12 * size * size);
        expect_sound(p, size);
    }
}

// The same in a rotated frame, where rounding bends the planes.
TEST(Hull, CoplanarPointsMakeOneFaceRotated) {
    Random random(3);
    for (int trial = 0; trial < 20; ++trial) {
        const Pose pose = random.pose(2.0);
        std::vector<Vec3> points;
        for (int i = 0; i <= 5; ++i)
            for (int j = 0; j <= 5; ++j)
                for (int k = 0; k <= 5; ++k)
                    if (i % 5 == 0 || j % 5 == 0 || k % 5 == 0)
                        points.push_back(pose.to_world({i / 5.0, j / 2.5, k / 5.0}));
        const Polyhedron p = make_hull(points, mean(points));
        EXPECT_EQ(p.faces.size(), 6u);
        EXPECT_EQ(p.vertices.size(), 8u);
        EXPECT_NEAR(p.surface_area(), 10.0, 1e-12);
        expect_sound(p, 2.0);
    }
}

TEST(Hull, OfManyPointsOnASphere) {
    Random random(4);
    std::vector<Vec3> points;
    for (int i = 0; i < 500; ++i) points.push_back(random.direction());
    const Polyhedron p = make_hull(points, Vec3::Zero());
    EXPECT_EQ(p.vertices.size(), 500u);
    EXPECT_EQ(p.faces.size(), 996u);  // all triangles: 2 V - 4
    expect_sound(p, 1.0);
    for (int trial = 0; trial < 100; ++trial) {
        const Vec3 d = random.direction();
        const double farthest = d.dot(p.vertices[p.support(d)]);
        for (const Vec3& v : p.vertices) EXPECT_LE(d.dot(v), farthest);
    }
}

// Meshes from files of six digits: nearly flat, nearly round, rounded. The climb to the farthest vertex must not end on
// a local maximum by rounding, and the planes must contain all points.
TEST(Hull, RoundedTessellationsAreClimbed) {
    Random random(6);
    for (const double digits : {1e-6, 1e-4}) {
        std::vector<Vec3> barrel, ball, slab;
        const auto rounded = [&](const Vec3& p) { return Vec3((p / digits).array().round() * digits); };
        for (int i = 0; i < 48; ++i)
            for (int k = 0; k <= 10; ++k) {
                const double t = 2.0 * 3.14159265358979 * i / 48, s = 3.14159265358979 * k / 10;
                barrel.push_back(rounded({std::cos(t), 0.2 * k - 1.0, std::sin(t)}));
                ball.push_back(rounded({std::cos(t) * std::sin(s), std::cos(s), std::sin(t) * std::sin(s)}));
                slab.push_back(rounded({0.05 * i, k % 2 * 0.1, 0.05 * k}));
            }
        for (const auto& points : {barrel, ball, slab}) {
            const Vec3 origin = mean(points);
            const Polyhedron p = make_hull(points, origin);
            expect_sound(p, 1.0);
            for (int trial = 0; trial < 300; ++trial) {
                Vec3 d = random.direction();
                if (trial % 3 == 0) d = p.faces[std::size_t(random.below(int(p.faces.size())))].normal;
                if (trial % 3 == 1) d = Vec3::Unit(trial % 9 / 3) * (trial % 2 ? 1.0 : -1.0);
                const auto start = std::uint32_t(random.below(int(p.vertices.size())));
                const double found = d.dot(p.vertices[p.support(d, start)]);
                for (const Vec3& point : points) EXPECT_LE(d.dot(point - origin), found + 1e-12);
            }
        }
    }
}

TEST(Hull, RepeatedPointsAreOne) {
    std::vector<Vec3> points;
    const Polyhedron box = make_box({1.0, 1.0, 1.0});
    for (int i = 0; i < 5; ++i) points.insert(points.end(), box.vertices.begin(), box.vertices.end());
    const Polyhedron p = make_hull(points, Vec3::Zero());
    EXPECT_EQ(p.vertices.size(), 8u);
    expect_sound(p, 1.0);
}

TEST(Hull, WithoutVolumeIsAnInputError) {
    Random random(5);
    std::vector<Vec3> plane, line, same(10, Vec3(1.0, 2.0, 3.0));
    const Mat3 turn = random.turn().toRotationMatrix();
    for (int i = 0; i < 20; ++i) {
        plane.push_back(turn * Vec3(random(-1, 1), random(-1, 1), 0.3));
        line.push_back(Vec3(1.0, 2.0, -1.0) * random(-1, 1));
    }
    EXPECT_THROW(make_hull(plane, Vec3::Zero()), InputError);
    EXPECT_THROW(make_hull(line, Vec3::Zero()), InputError);
    EXPECT_THROW(make_hull(same, Vec3::Zero()), InputError);
    EXPECT_THROW(make_hull({}, Vec3::Zero()), InputError);
    EXPECT_THROW(make_hull({Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()}, Vec3::Zero()), InputError);
}

// A long pole and a thin plate are hulls like any other.
TEST(Hull, SlenderShapes) {
    for (const Vec3& size : {Vec3(100.0, 0.01, 0.01), Vec3(10.0, 10.0, 1e-3)}) {
        const Polyhedron box = make_box(size);
        const Polyhedron p = make_hull(box.vertices, Vec3::Zero());
        EXPECT_EQ(p.faces.size(), 6u);
        EXPECT_EQ(p.vertices.size(), 8u);
        expect_sound(p, size.maxCoeff());
    }
}

}  // namespace tumble::polyhedron_test
