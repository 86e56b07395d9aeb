// Compounds: mass by the parallel axis theorem, contacts part by part, the first impact over all pairs of parts.
#include "sim/ccd/time_of_impact.h"
#include "sim/dynamics/body_builder.h"
#include "sim/random_shapes.h"
#include "support/bodies.h"
#include "support/compounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble::compound_test {
using namespace tumble::testing;

namespace {

Body built(const Shape& shape, double density = 1000.0, std::optional<double> mass = {}) {
    BodyDescription d;
    d.shape = shape;
    d.density = density;
    d.mass = mass;
    return BodyBuilder().build(d, IntegratorKind::symplectic_euler);
}

void expect_inertia(const Body& body, const Mat3& inertia, double tolerance) {
    EXPECT_LT((body.inertia_body - inertia).cwiseAbs().maxCoeff(), tolerance * inertia.trace()) << body.inertia_body;
}

const Compound& compound_in(const Body& body) { return *std::get<std::shared_ptr<const Compound>>(body.collider); }

CompoundShape random_compound(Random& random) {
    std::vector<CompoundPart> parts;
    const int count = 2 + random.below(4);
    for (int i = 0; i < count; ++i) {
        const Vec3 at = random.vector(0.5);
        if (i % 2 == 0)
            parts.push_back(
                part(BoxShape{Vec3(random(0.1, 0.6), random(0.1, 0.6), random(0.1, 0.6))}, at, Quat(random.turn())));
        else
            parts.push_back(part(SphereShape{random(0.1, 0.3)}, at));
    }
    return compound_of(std::move(parts));
}

}  // namespace

TEST(CompoundMass, ABoxOfEightBoxesIsTheBox) {
    const Vec3 size(0.7, 1.1, 0.3);
    const Body whole = built(BoxShape{size}), parts = built(box_of_eight(size));
    EXPECT_NEAR(parts.mass, whole.mass, 1e-14 * whole.mass);
    EXPECT_LT(parts.center_of_mass.norm(), 1e-16);
    expect_inertia(parts, whole.inertia_body, 1e-15);
    EXPECT_NEAR(parts.radius, whole.radius, 1e-15);
}

// The same L as a large box less a small one.
TEST(CompoundMass, AnLBlock) {
    const Body ell = built(compound_of(
        {part(BoxShape{Vec3(0.9, 0.3, 0.3)}, {0.0, 0.0, 0.0}), part(BoxShape{Vec3(0.3, 0.6, 0.3)}, {0.3, 0.45, 0.0})}));
    const double large = 0.9 * 0.9 * 0.3 * 1000.0, small = 0.6 * 0.6 * 0.3 * 1000.0, mass = large - small;
    const Vec3 large_at(0.0, 0.3, 0.0), small_at(-0.15, 0.45, 0.0);
    const Vec3 center = (large * large_at - small * small_at) / mass;
    EXPECT_NEAR(ell.mass, mass, 1e-12);
    EXPECT_LT((ell.center_of_mass - center).norm(), 1e-15);
    const auto about_center = [&](const Vec3& size, double m, const Vec3& at) {
        const Vec3 d = at - center, s = size.cwiseProduct(size);
        Mat3 own = Mat3::Zero();
        own.diagonal() = m / 12.0 * Vec3(s.y() + s.z(), s.z() + s.x(), s.x() + s.y());
        return Mat3(own + m * (d.squaredNorm() * Mat3::Identity() - d * d.transpose()));
    };
    expect_inertia(ell, about_center({0.9, 0.9, 0.3}, large, large_at) - about_center({0.6, 0.6, 0.3}, small, small_at),
                   1e-14);
    EXPECT_GT(std::abs(ell.inertia_body(0, 1)), 1.0);  // an L's axes differ from those of its frame
}

TEST(CompoundMass, ADumbbellOfTwoDensities) {
    const double r = 0.2, d = 0.5;
    CompoundPart light = part(SphereShape{r}, {-d, 0.0, 0.0}), heavy = part(SphereShape{r}, {d, 0.0, 0.0});
    heavy.density = 3000.0;
    const Body body = built(compound_of({light, heavy}), 1000.0);
    const double m = 1000.0 * 4.0 / 3.0 * M_PI * r * r * r;
    EXPECT_NEAR(body.mass, 4.0 * m, 1e-12 * m);
    EXPECT_LT((body.center_of_mass - Vec3(0.5 * d, 0.0, 0.0)).norm(), 1e-15);
    const double own = 0.4 * 4.0 * m * r * r;
    const double across = own + m * 2.25 * d * d + 3.0 * m * 0.25 * d * d;
    Mat3 inertia = Mat3::Zero();
    inertia.diagonal() = Vec3(own, across, across);
    expect_inertia(body, inertia, 1e-15);
    // For a given mass: the same mass ratios.
    const Body scaled = built(compound_of({light, heavy}), 1000.0, 8.0);
    EXPECT_NEAR(scaled.mass, 8.0, 1e-14);
    expect_inertia(scaled, 8.0 / (4.0 * m) * inertia, 1e-15);
    EXPECT_EQ(scaled.center_of_mass, body.center_of_mass);
}

TEST(CompoundMass, PartsMayBeRotatedAndOverlap) {
    Random random(7);
    const Quat q(random.turn());
    const Vec3 size(0.3, 0.5, 0.9);
    const Body one = built(BoxShape{size}), turned = built(compound_of({part(BoxShape{size}, {1.0, 2.0, 3.0}, q)}));
    EXPECT_LT((turned.center_of_mass - Vec3(1.0, 2.0, 3.0)).norm(), 1e-15);
    const Mat3 turn = q.toRotationMatrix();
    expect_inertia(turned, turn * one.inertia_body * turn.transpose(), 1e-15);
    const Body twice = built(compound_of({part(BoxShape{size}, Vec3::Zero()), part(BoxShape{size}, Vec3::Zero())}));
    EXPECT_NEAR(twice.mass, 2.0 * one.mass, 1e-12);
    expect_inertia(twice, 2.0 * one.inertia_body, 1e-15);
}

// A mesh part's center of mass need not be its origin.
TEST(CompoundMass, MeshParts) {
    const auto cube = asset_of(box_mesh({1.0, 0.0, 0.0}, {2.0, 1.0, 1.0}));
    const Body body =
        built(compound_of({part(MeshShape{cube}, {-1.0, 0.0, 0.0}), part(MeshShape{cube}, Vec3::Zero())}));
    const Body box = built(BoxShape{Vec3(2.0, 1.0, 1.0)});
    EXPECT_LT((body.center_of_mass - Vec3(1.0, 0.5, 0.5)).norm(), 1e-15);
    expect_inertia(body, box.inertia_body, 1e-14);
    EXPECT_NEAR(body.radius, box.radius, 1e-15);
    EXPECT_LT((compound_in(body).tree.bounds().extent() - Vec3(2.0, 1.0, 1.0)).norm(), 1e-14);
}

// Against all pairs of parts one by one; every pair of parts has its own part index.
TEST(CompoundContact, IsTheUnionOverItsParts) {
    Random random(7);
    CollisionScratch scratch;
    int manifolds = 0;
    std::ptrdiff_t touching_found = 0, touching_expected = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const Body a = built(random_compound(random));
        const Body others[] = {built(random_compound(random)), built(BoxShape{Vec3(0.5, 0.3, 0.8)}),
                               built(SphereShape{0.4})};
        std::vector<CollisionShape> colliders{HalfSpace{random.direction(), random(-0.5, 0.5)},
                                              surface_of(grid_mesh(4, 1.0, 0.2))};
        for (const Body& other : others) colliders.push_back(other.collider);
        const Pose pose_a = random.pose(0.5), pose_b = random.pose(0.5);
        for (const CollisionShape& b : colliders) {
            for (const bool swapped : {false, true}) {
                std::vector<Manifold> found, expected;
                if (swapped)
                    collide(b, a.collider, {pose_b, pose_a, 0.05, scratch, found});
                else
                    collide(a.collider, b, {pose_a, pose_b, 0.05, scratch, found});
                for (const Compound::Part& p : compound_in(a).parts) {
                    std::vector<std::pair<CollisionShape, Pose>> pieces{{b, pose_b}};
                    if (const auto* whole = std::get_if<std::shared_ptr<const Compound>>(&b)) {
                        pieces.clear();
                        for (const Compound::Part& q : (*whole)->parts)
                            pieces.push_back({q.collider, part_pose(pose_b, q)});
                    }
                    for (const auto& [shape, pose] : pieces) {
                        if (swapped)
                            collide(shape, p.collider, {pose, part_pose(pose_a, p), 0.05, scratch, expected});
                        else
                            collide(p.collider, shape, {part_pose(pose_a, p), pose, 0.05, scratch, expected});
                    }
                }
                // Points nearer than the margin along an axis may be farther apart than it: both results may then skip
                // them.
                const auto touching = [](const std::vector<Manifold>& list) {
                    return std::count_if(list.begin(), list.end(), [](const Manifold& m) {
                        return std::any_of(m.points.begin(), m.points.begin() + m.count,
                                           [](const ContactPoint& p) { return p.separation < 0.0; });
                    });
                };
                ASSERT_LE(found.size(), expected.size());
                touching_found += touching(found);
                touching_expected += touching(expected);
                std::vector<std::uint32_t> parts;
                for (const Manifold& m : found) {
                    parts.push_back(m.part);
                    EXPECT_TRUE(std::any_of(expected.begin(), expected.end(), [&](const Manifold& e) {
                        return e.count == m.count && (e.normal - m.normal).norm() < 1e-15 &&
                               (e.points[0].position - m.points[0].position).norm() < 1e-15;
                    }));
                }
                std::sort(parts.begin(), parts.end());
                // A body may rest on one triangle with several normals; otherwise the part indices are distinct.
                if (!std::holds_alternative<std::shared_ptr<const CollisionMesh>>(b)) {
                    EXPECT_EQ(std::adjacent_find(parts.begin(), parts.end()), parts.end());
                }
                manifolds += int(found.size());
            }
        }
    }
    EXPECT_GT(manifolds, 2000);
    // Contacts within the body, where parts overlap, are skipped.
    EXPECT_GT(double(touching_found), 0.9 * double(touching_expected));
}

// At any depth: a body deep in a plane after a fast step is not mistaken for a contact at its own internal edge.
TEST(CompoundContact, OverlappingPartsAreHeldAtAnyDepth) {
    const Body body =
        built(compound_of({part(SphereShape{0.3}, {0.0, 0.1, 0.0}), part(SphereShape{0.3}, {0.0, -0.1, 0.0}),
                           part(BoxShape{{0.4, 0.4, 0.4}}, Vec3::Zero())}));
    CollisionScratch scratch;
    for (const double depth : {1e-6, 0.01, 0.1, 0.3, 0.6, 1.2}) {
        std::vector<Manifold> found;
        const Pose pose{{0.0, 0.4 - depth, 0.0}, Mat3::Identity()};
        collide(HalfSpace{Vec3::UnitY(), 0.0}, body.collider, {Pose{}, pose, 0.01, scratch, found});
        double deepest = 0.0;
        for (const Manifold& m : found)
            for (int i = 0; i < m.count; ++i) deepest = std::min(deepest, m.points[std::size_t(i)].separation);
        EXPECT_NEAR(deepest, -depth, 1e-12);
    }
}

namespace {

struct Flying {
    Body body;
    Trajectory path;
    explicit Flying(const Body& b, const Vec3& acceleration = {0.0, -9.81, 0.0})
        : body(b), path(Trajectory::flight(b, acceleration)) {}
    MovingBody moving_body() const { return {&body, &path, 0.0}; }
};

Body standing(const CollisionShape& collider) {
    Body body;
    body.type = BodyType::fixed;
    body.collider = collider;
    body.radius = bounding_radius(collider);
    return body;
}

}  // namespace

TEST(CompoundImpact, ABoxOfEightBoxesHitsWhenTheBoxDoes) {
    Random random(7);
    ImpactSearch search;
    const Vec3 size(1.0, 0.6, 0.2);
    Body grid = standing(surface_of(grid_mesh(3, 4.0, 0.1))), ground = standing(HalfSpace{Vec3::UnitY(), 0.0});
    const Flying obstacles[] = {
        Flying(ground, Vec3::Zero()), Flying(grid, Vec3::Zero()),
        Flying(free_ball(0.5, 1.0, {0.0, 0.5, 0.0}, Vec3::Zero())),
        Flying(free_box({0.8, 0.8, 0.8}, 1.0, {0.0, 0.5, 0.0}, Vec3::Zero(), random.turn(), random.vector(2.0)))};
    int hits = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const Vec3 at(random(-0.5, 0.5), random(2.0, 3.0), random(-0.5, 0.5)), v(0.0, random(-8.0, -4.0), 0.0),
            w = random.vector(trial % 2 ? 5.0 : 50.0);
        const Quat q(random.turn());
        const Flying whole(free_body(BoxShape{size}, 1.0, at, v, q, w)),
            parts(free_body(box_of_eight(size), 1.0, at, v, q, w));
        for (const Flying& obstacle : obstacles) {
            const TimeOfImpact first = search.find(obstacle.moving_body(), whole.moving_body(), 2.0);
            const TimeOfImpact second = search.find(parts.moving_body(), obstacle.moving_body(), 2.0);
            EXPECT_EQ(first.kind == TimeOfImpact::Kind::none, second.kind == TimeOfImpact::Kind::none);
            if (first.kind != TimeOfImpact::Kind::impact) continue;
            EXPECT_NEAR(first.time, second.time, 1e-11);
            ++hits;
        }
    }
    EXPECT_GT(hits, 150);
}

// Through the hole of a link, where a hull would be hit.
TEST(CompoundImpact, ABallFliesThroughALink) {
    ImpactSearch search;
    const Flying link(
        free_body(square_link(1.0, 0.2), 1.0, Vec3::Zero(), Vec3::Zero(), Quat::Identity(), {0.0, 0.0, 3.0}),
        Vec3::Zero());
    const auto time = [&](double radius, double x) {
        const Flying ball(free_ball(radius, 1.0, {x, 0.0, 2.0}, {0.0, 0.0, -4.0}), Vec3::Zero());
        return search.find(link.moving_body(), ball.moving_body(), 1.0);
    };
    EXPECT_EQ(time(0.29, 0.0).kind, TimeOfImpact::Kind::none);
    const TimeOfImpact hit = time(0.31, 0.0);
    ASSERT_EQ(hit.kind, TimeOfImpact::Kind::impact);
    // The inner edges at 0.3 from the axis, 0.1 towards the ball: where 0.31^2 = 0.3^2 + depth^2.
    EXPECT_NEAR(hit.time, (2.0 - 0.1 - std::sqrt(0.31 * 0.31 - 0.3 * 0.3)) / 4.0, 1e-12);
}

}  // namespace tumble::compound_test
