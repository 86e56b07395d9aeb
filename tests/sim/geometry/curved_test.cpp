// Curved bodies: the axis of largest separation against brute force over all directions, masses, rays, manifolds.
#include "support/curved.h"
#include "core/error.h"
#include "scene/load.h"
#include "sim/geometry/curved_axis.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace tumble::curved_test {
using namespace tumble::testing;

namespace {

using CurvedRef = std::shared_ptr<const CurvedBody>;

CurvedShape random_shape(Random& random, int kind) {
    switch (kind) {
        case 0:
            return capsule(random(0.1, 1.0), random(0.1, 2.0));
        case 1:
            return cylinder(random(0.1, 1.0), random(0.1, 2.0));
        case 2:
            return cone(random(0.1, 1.0), random(0.1, 2.0), random.below(2) ? 0.0 : random(0.1, 1.0));
        default:
            return ellipsoid({random(0.2, 1.0), random(0.2, 1.0), random(0.2, 1.0)});
    }
}

CurvedRef body_of(const CurvedShape& shape) {
    ColliderCache cache;
    const Vec3 center = mass_properties(shape, 1.0).center_of_mass;
    return std::get<CurvedRef>(make_collider(shape, {false, center, 1.0}, cache));
}

/// Along a direction: a lower bound of the distance.
double separation_along(const ConvexShape& a, const ConvexShape& b, const Vec3& n) {
    return n.dot(b.support(-n) - a.support(n)) - a.rounding - b.rounding;
}

CurvedAxis best_axis(const ConvexShape& a, const ConvexShape& b) {
    CurvedAxisSearch search(a, b);
    search.find_flat(infinity);
    return search.find_best();
}

/// The largest separation over directions: the best of many, refined by random steps.
double brute_separation(const ConvexShape& a, const ConvexShape& b, Random& random) {
    const auto separation = [&](const Vec3& n) { return separation_along(a, b, n); };
    std::vector<std::pair<double, Vec3>> tried;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 n = random.direction();
        tried.emplace_back(separation(n), n);
    }
    std::partial_sort(tried.begin(), tried.begin() + 4, tried.end(),
                      [](const auto& l, const auto& r) { return l.first > r.first; });
    double most = -infinity;
    for (int k = 0; k < 4; ++k) {
        auto [best, n] = tried[std::size_t(k)];
        for (double step = 0.2; step > 1e-9; step *= 0.6)
            for (int i = 0; i < 12; ++i) {
                const Vec3 next = (n + step * random.direction()).normalized();
                const double s = separation(next);
                if (!(s > best)) continue;
                best = s;
                n = next;
                i = -1;
            }
        most = std::max(most, best);
    }
    return most;
}

}  // namespace

// Masses, centers and moments of inertia of the reference table, whose values MuJoCo 2.2.2 gives too.
TEST(Curved, MassesOfTheReferenceTable) {
    const auto expect = [](const CurvedShape& shape, double mass, double center, const Vec3& inertia) {
        const MassProperties p = mass_properties(shape, 1000.0);
        EXPECT_NEAR(p.mass, mass, 1e-12 * mass);
        EXPECT_NEAR(p.center_of_mass.y(), center, 1e-12);
        EXPECT_LT((p.inertia - Mat3(inertia.asDiagonal())).norm(), 1e-12 * inertia.norm());
    };
    expect(cylinder(0.5, 2.0), 1570.7963267948966, 0.0, {621.77354602297992, 196.34954084936208, 621.77354602297992});
    expect(capsule(0.5, 2.0), 2094.3951023931955, 0.0, {1394.0817400304708, 248.70941840919196, 1394.0817400304708});
    expect(cone(0.5, 2.0), 523.59877559829887, -0.5, {98.174770424681039, 39.269908169872415, 98.174770424681039});
    expect(cone(0.5, 1.0, 0.25), 458.14892864851151, 0.39285714285714286 - 0.5,
           {53.031907238332168, 38.042723539563902, 53.031907238332168});
    expect(ellipsoid({0.5, 0.3, 0.2}), 125.66370614359173, 0.0,
           {3.2672563597333850, 7.2884949563283203, 8.5451320177642377});
}

// Distances, and depths of shallow overlaps.
TEST(Curved, SeparationIsTheLargestOfAllDirections) {
    Random random(1);
    int touching = 0;
    for (int trial = 0; trial < trials(700); ++trial) {
        const CurvedRef body = body_of(random_shape(random, trial % 4));
        const ConvexShape b = convex_shape(*body, random.pose(1.3));
        const int other = (trial / 4) % 7;
        const CurvedRef curved = body_of(random_shape(random, other % 4));
        const Polyhedron box = make_box({random(0.2, 2.0), random(0.2, 2.0), random(0.2, 2.0)});
        const PolyhedronRef hull = random_hull(random, 12, {0.7, 0.5, 0.6});
        const ConvexShape a = other < 4    ? convex_shape(*curved, Pose())
                              : other == 4 ? convex_shape(box, Pose())
                              : other == 5 ? convex_shape(Ball{random(0.1, 1.0)}, Pose())
                                           : convex_shape(*hull, Pose());
        const CurvedAxis axis = best_axis(a, b);
        const double expected = brute_separation(a, b, random);
        if (expected < -0.1 * std::min(a.size, b.size)) continue;  // any way out will do
        ++touching;
        EXPECT_GT(axis.separation, expected - 1e-12) << "trial " << trial;
        EXPECT_NEAR(axis.separation, separation_along(a, b, axis.normal), 1e-15) << "trial " << trial;
        const CurvedAxis swapped = best_axis(b, a);
        EXPECT_NEAR(swapped.separation, axis.separation, 1e-13) << "trial " << trial;
        EXPECT_LT((swapped.normal + axis.normal).norm(), 1e-6) << "trial " << trial;
    }
    EXPECT_GT(touching, trials(700) / 3);
}

// The same body far from the origin and turned, and moved by little.
TEST(Curved, ManifoldsFollowTheBodies) {
    Random random(2);
    int found = 0;
    for (int trial = 0; trial < trials(600); ++trial) {
        const CollisionShape a = body_of(random_shape(random, trial % 4)),
                             b = body_of(random_shape(random, trial / 4 % 4));
        const Pose pose_a = random.pose(0.7), pose_b = random.pose(0.7), move = random.pose(3.0);
        const auto moved = [&](const Pose& p) { return Pose{move.to_world(p.position), move.rotation * p.rotation}; };
        const auto here = collide_all(a, pose_a, b, pose_b, 0.05),
                   there = collide_all(a, moved(pose_a), b, moved(pose_b), 0.05),
                   swapped = collide_all(b, pose_b, a, pose_a, 0.05);
        ASSERT_EQ(here.size(), there.size());
        ASSERT_EQ(here.size(), swapped.size());
        if (here.empty() || deepest(here) < -0.02) continue;
        ++found;
        EXPECT_LT((move.rotation * here[0].normal - there[0].normal).norm(), 1e-6);
        EXPECT_NEAR(deepest(here), deepest(there), 1e-9);
        EXPECT_NEAR(deepest(here), deepest(swapped), 2e-3);
        for (int i = 0; i < here[0].count; ++i) {
            const ContactPoint& p = here[0].points[std::size_t(i)];
            // The ends lie on both surfaces, or outside of them by the gap.
            EXPECT_TRUE(contains(a, pose_a.to_body(p.position - 0.5 * p.separation * here[0].normal), 1e-6));
            EXPECT_TRUE(contains(b, pose_b.to_body(p.position + 0.5 * p.separation * here[0].normal), 1e-6));
        }
    }
    EXPECT_GT(found, trials(600) / 20);
}

TEST(Curved, ManifoldsOnAPlaneHaveThePointsOfTheirFeatures) {
    const CollisionShape plane = HalfSpace{Vec3::UnitY(), 0.0};
    const auto points = [&](const CurvedShape& shape, double height, const Quat& rotation) {
        const auto found =
            collide_all(plane, Pose(), body_of(shape), {height * Vec3::UnitY(), rotation.toRotationMatrix()}, 1e-3);
        EXPECT_EQ(found.size(), 1u);
        return found.empty() ? Manifold() : found[0];
    };
    const Quat lying(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitX()));
    const Manifold can = points(cylinder(0.3, 1.0), 0.5, Quat::Identity());
    EXPECT_EQ(can.count, 4);
    EXPECT_NEAR(double(can.area), pi * 0.09, 1e-6);
    double distance = 0.0;  // mean distance of a disc: two thirds of its radius
    for (int i = 0; i < 4; ++i) distance += 0.25 * double(can.spread) * (can.points[std::size_t(i)].position).norm();
    EXPECT_NEAR(distance, 0.2, 1e-6);
    EXPECT_EQ(points(cylinder(0.3, 1.0), 0.3, lying).count, 2);
    EXPECT_EQ(points(capsule(0.3, 1.0), 0.3, lying).count, 2);
    EXPECT_EQ(points(capsule(0.3, 1.0), 0.8, Quat::Identity()).count, 1);
    EXPECT_EQ(points(ellipsoid({0.5, 0.3, 0.2}), 0.3, Quat::Identity()).count, 1);
    EXPECT_EQ(points(cone(0.3, 1.0), 0.25, Quat::Identity()).count, 4);
}

// The first points on rays: on the surface, and none nearer.
TEST(Curved, RaysMeetTheSurface) {
    Random random(4);
    int hits = 0;
    for (int trial = 0; trial < trials(4000); ++trial) {
        const CurvedShape shape = random_shape(random, trial % 4);
        const CurvedRef body = body_of(shape);
        const Vec3 center = mass_properties(shape, 1.0).center_of_mass;
        const Vec3 from = 4.0 * random.direction(), to = random.vector(0.8);
        const double found = first_hit(shape, from, to - from);
        bool inside = false;  // the ray comes into the body before
        for (int k = 0; k < 200 && !inside; ++k) {
            const double t = 2.0 * k / 200.0;
            inside = t < found - 1e-9 && body->contains(from + t * (to - from) - center, -1e-9);
        }
        EXPECT_FALSE(inside) << "trial " << trial;
        if (std::isinf(found)) continue;
        ++hits;
        const Vec3 at = from + found * (to - from), normal = normal_at(shape, at);
        EXPECT_TRUE(body->contains(at - center, 1e-9)) << "trial " << trial;
        EXPECT_FALSE(body->contains(at - center, -1e-6)) << "trial " << trial;
        EXPECT_NEAR(normal.dot(at - center), body->extent(normal), 1e-9) << "trial " << trial;
    }
    EXPECT_GT(hits, trials(4000) / 4);
}

// Equal shapes share the triangles for drawing, each of which lies near the surface and faces outward.
TEST(Curved, AreDrawnAsClosedSurfaces) {
    for (const CurvedShape& shape :
         {capsule(0.3, 0.5), cylinder(0.3, 0.5), cone(0.3, 0.5), cone(0.3, 0.5, 0.1), ellipsoid({0.3, 0.2, 0.5})}) {
        const Closedness form = closedness(shape.drawn->mesh);
        EXPECT_TRUE(form.closed());
        const double volume = mass_properties(shape, 1.0).mass;
        EXPECT_NEAR(form.signed_volume, volume, 0.01 * volume);
        for (const MeshAsset::Vertex& v : shape.drawn->vertices) {
            const Vec3 p(v.position[0], v.position[1], v.position[2]);
            const Vec3 normal(v.normal[0], v.normal[1], v.normal[2]);
            const Vec3 center = mass_properties(shape, 1.0).center_of_mass;
            EXPECT_NEAR(normal.dot(p - center), body_of(shape)->extent(normal), 1e-6);
        }
    }
}

TEST(Curved, ScenesHaveTheirKeys) {
    const auto shape_of = [](const std::string& keys) {
        return std::get<CurvedShape>(
            parse_scene("format = 1\n[[body]]\nshape = { type = " + keys + " }\n", "scene.toml").bodies[0].shape);
    };
    const CurvedShape can = shape_of("\"cylinder\", radius = 0.25, height = 2");
    EXPECT_EQ(can.kind, CurvedKind::cylinder);
    EXPECT_EQ(can.top_radius, 0.25);
    EXPECT_EQ(shape_of("\"cone\", radius = 0.25, height = 2").top_radius, 0.0);
    EXPECT_EQ(shape_of("\"cone\", radius = 0.25, height = 2, top_radius = 0.5").top_radius, 0.5);
    EXPECT_EQ(shape_of("\"capsule\", radius = 0.25, height = 2").height, 2.0);
    EXPECT_EQ(shape_of("\"ellipsoid\", radii = [1, 2, 3]").radii, Vec3(1.0, 2.0, 3.0));
    EXPECT_THROW(shape_of("\"cylinder\", radius = 0.25, height = 2, top_radius = 0.1"), InputError);
    EXPECT_THROW(shape_of("\"cone\", radius = 0.25, height = 2, top_radius = -0.1"), InputError);
    EXPECT_THROW(shape_of("\"capsule\", radius = 0, height = 2"), InputError);
    EXPECT_THROW(shape_of("\"ellipsoid\", radius = 1"), InputError);
}

}  // namespace tumble::curved_test
