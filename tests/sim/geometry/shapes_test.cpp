// Each kind of shape against brute force: its bounds, mass, rays and collision shape against a dense mesh of its
// surface and sums over a grid of points.
#include "sim/geometry/shapes/shape.h"
#include "sim/random_shapes.h"
#include "support/compounds.h"
#include "support/meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace tumble::shapes_test {
using namespace tumble::testing;

namespace {

/// A shape, its surface as triangles that lie no farther than `error` (m) from it, and its interior.
struct Model {
    Shape shape;
    TriangleMesh surface;
    double error = 0.0;
    std::function<bool(const Vec3&)> inside;
};

TriangleMesh ball_mesh(double radius, const Vec3& center, int splits) {
    TriangleMesh mesh = icosahedron(radius)->mesh;
    for (int i = 0; i < splits; ++i) {
        TriangleMesh finer;
        for (const auto& t : mesh.triangles) {
            const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
            const auto first = std::uint32_t(finer.vertices.size());
            for (const Vec3& v : {a, b, c, Vec3(a + b), Vec3(b + c), Vec3(c + a)})
                finer.vertices.push_back(radius * v.normalized());
            for (const auto& [i0, i1, i2] :
                 {std::array{0u, 3u, 5u}, std::array{3u, 1u, 4u}, std::array{5u, 4u, 2u}, std::array{3u, 4u, 5u}})
                finer.triangles.push_back({first + i0, first + i1, first + i2});
        }
        mesh = std::move(finer);
    }
    for (Vec3& v : mesh.vertices) v += center;
    return mesh;
}

Model box_model(const Vec3& size) {
    return {BoxShape{size}, box_mesh(-0.5 * size, 0.5 * size), 0.0,
            [size](const Vec3& p) { return (p.cwiseAbs().array() <= 0.5 * size.array()).all(); }};
}

Model sphere_model(double radius) {
    return {SphereShape{radius}, ball_mesh(radius, Vec3::Zero(), 4), 2e-3 * radius,
            [radius](const Vec3& p) { return p.norm() <= radius; }};
}

/// A tetrahedron that does not contain its origin.
Model mesh_model() {
    const TriangleMesh mesh = tetrahedron({0.3, 0.1, 0.2}, {1.3, 0.2, 0.1}, {0.4, 1.2, 0.3}, {0.5, 0.4, 1.4});
    const auto inside = [mesh](const Vec3& p) {
        return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& t) {
            const Vec3& a = mesh.vertices[t[0]];
            return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).dot(p - a) <= 0.0;
        });
    };
    return {MeshShape{asset_of(mesh)}, mesh, 0.0, inside};
}

/// A rotated box and a ball beside it.
Model compound_model() {
    const Vec3 size(0.6, 0.4, 0.5), at(0.5, 0.1, -0.2), center(-0.4, 0.2, 0.1);
    const double radius = 0.3;
    const Quat rotation(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -1.0).normalized()));
    TriangleMesh surface = box_mesh(-0.5 * size, 0.5 * size);
    for (Vec3& v : surface.vertices) v = at + rotation * v;
    const TriangleMesh ball = ball_mesh(radius, center, 4);
    const auto first = std::uint32_t(surface.vertices.size());
    surface.vertices.insert(surface.vertices.end(), ball.vertices.begin(), ball.vertices.end());
    for (const auto& t : ball.triangles) surface.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    return {compound_of({part(BoxShape{size}, at, rotation), part(SphereShape{radius}, center)}), surface,
            2e-3 * radius, [=](const Vec3& p) {
                const Vec3 in_box = rotation.conjugate() * (p - at);
                return (p - center).norm() <= radius || (in_box.cwiseAbs().array() <= 0.5 * size.array()).all();
            }};
}

double extent_along(const std::vector<Vec3>& points, const Vec3& direction) {
    double most = -infinity;
    for (const Vec3& p : points) most = std::max(most, direction.dot(p));
    return most;
}

void expect_bounds(const Model& model) {
    const Bounds bounds = local_bounds(model.shape);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(bounds.max[axis], extent_along(model.surface.vertices, Vec3::Unit(axis)), model.error + 1e-12);
        EXPECT_NEAR(-bounds.min[axis], extent_along(model.surface.vertices, -Vec3::Unit(axis)), model.error + 1e-12);
    }
    const BoundingSphere sphere = bounding_sphere(model.shape);
    double farthest = 0.0;
    for (const Vec3& v : model.surface.vertices) farthest = std::max(farthest, (v - sphere.center).norm());
    EXPECT_NEAR(sphere.radius, farthest, model.error + 1e-12);
    Random random(1);
    for (int trial = 0; trial < trials(300); ++trial) {
        const Vec3 direction = random.direction();
        double most = -infinity;
        visit_extent(model.shape,
                     [&](const Vec3& center, double radius) { most = std::max(most, direction.dot(center) + radius); });
        EXPECT_NEAR(most, extent_along(model.surface.vertices, direction), model.error + 1e-12);
    }
}

/// Sums over the middles of the cells of a grid.
void expect_mass(const Model& model) {
    constexpr int cells = 90;
    constexpr double density = 700.0, tolerance = 0.01;
    const Bounds bounds = local_bounds(model.shape);
    const Vec3 cell = bounds.extent() / cells;
    MassProperties sum;
    Mat3 second = Mat3::Zero();  // integral of x x^T dm
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
            for (int k = 0; k < cells; ++k) {
                const Vec3 p = bounds.min + cell.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5));
                if (!model.inside(p)) continue;
                sum.mass += 1.0;
                sum.center_of_mass += p;
                second += p * p.transpose();
            }
    const double scale = density * cell.prod();
    sum.center_of_mass /= sum.mass;
    second = scale * (second - sum.mass * sum.center_of_mass * sum.center_of_mass.transpose());
    sum.mass *= scale;
    sum.inertia = second.trace() * Mat3::Identity() - second;
    const MassProperties mass = mass_properties(model.shape, density);
    EXPECT_NEAR(mass.mass, sum.mass, tolerance * sum.mass);
    EXPECT_LT((mass.center_of_mass - sum.center_of_mass).norm(), tolerance * bounds.extent().norm());
    EXPECT_LT((mass.inertia - sum.inertia).norm(), tolerance * sum.inertia.norm());
}

/// First triangle that a ray meets: one linear system for each.
double hit_of_triangles(const TriangleMesh& mesh, const Vec3& from, const Vec3& direction) {
    double nearest = infinity;
    for (const auto& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        Mat3 m;
        m << direction, a - mesh.vertices[t[1]], a - mesh.vertices[t[2]];
        const Vec3 at = m.fullPivLu().solve(a - from);
        if (std::abs(m.determinant()) > 1e-14 && at.y() >= 0.0 && at.z() >= 0.0 && at.y() + at.z() <= 1.0 &&
            at.x() > 0.0)
            nearest = std::min(nearest, at.x());
    }
    return nearest;
}

void expect_rays(const Model& model, int count) {
    Random random(2);
    const BoundingSphere sphere = bounding_sphere(model.shape);
    int hits = 0, differ = 0;
    for (int trial = 0; trial < trials(count); ++trial) {
        const Vec3 from = sphere.center + 2.0 * sphere.radius * random.direction();
        const Vec3 direction = 0.7 * (sphere.center + random.vector(0.6 * sphere.radius) - from);
        const double found = first_hit(model.shape, from, direction);
        const double expected = hit_of_triangles(model.surface, from, direction);
        if (std::isinf(found) && std::isinf(expected)) continue;
        ++hits;
        // A ray that grazes a curved surface may miss its mesh.
        if (!(std::abs(found - expected) * direction.norm() <= 3.0 * model.error + 1e-9)) ++differ;
    }
    EXPECT_GT(hits, trials(count) / 4);
    EXPECT_LE(differ, model.error > 0.0 ? hits / 10 : 0);
}

/// The collision shape, from its own origin.
void expect_collider(const Model& model, bool convex) {
    ColliderCache cache;
    const Vec3 origin = mass_properties(model.shape, 1000.0).center_of_mass;
    const CollisionShape collider = make_collider(model.shape, {false, origin, 1000.0}, cache);
    std::vector<Vec3> points;
    for (const Vec3& v : model.surface.vertices) points.push_back(v - origin);
    double farthest = 0.0;
    for (const Vec3& p : points) farthest = std::max(farthest, p.norm());
    EXPECT_GE(bounding_radius(collider), farthest - 1e-12);
    EXPECT_LE(bounding_radius(collider), 1.2 * farthest);
    Random random(3);
    for (int trial = 0; trial < trials(50); ++trial) {
        const Pose pose = random.pose(5.0);
        Bounds bounds;
        for (const Vec3& p : points) bounds.add(pose.to_world(p));
        const Bounds found = world_bounds(collider, pose);
        EXPECT_TRUE((found.min.array() <= bounds.min.array() + 1e-12).all());
        EXPECT_TRUE((found.max.array() >= bounds.max.array() - 1e-12).all());
        EXPECT_LE(found.extent().norm(), 2.0 * bounds.extent().norm());
    }
    if (!convex) return;
    EXPECT_NEAR(bounding_radius(collider), farthest, model.error + 1e-12);
    const RoundedHull hull = rounded_hull(collider);
    double reach = 0.0, area = 0.0;
    for (const Vec3& p : hull.points) reach = std::max(reach, p.norm());
    EXPECT_NEAR(hull.reach, reach, 1e-12);
    constexpr int directions = 2000;
    for (int trial = 0; trial < directions; ++trial) {
        const Vec3 direction = random.direction();
        EXPECT_TRUE(model.inside(origin + 0.999 * depth(collider) * direction));
        const std::vector<Vec3> core(hull.points.begin(), hull.points.end());
        EXPECT_NEAR(extent_along(core, direction) + hull.radius, extent_along(points, direction), model.error + 1e-12);
        const Vec3 p = random.vector(1.1 * farthest);
        EXPECT_EQ(contains(collider, p, 0.0), model.inside(p + origin));
        for (const auto& t : model.surface.triangles) {
            const Vec3& a = points[t[0]];
            area += 0.25 * std::abs((points[t[1]] - a).cross(points[t[2]] - a).dot(direction)) / directions;
        }
    }
    EXPECT_NEAR(mean_projected_area(collider), area, 0.02 * area);
}

/// Twice as large: all lengths.
void expect_enlarged(const Shape& shape, const Shape& larger) {
    const Bounds before = local_bounds(shape), after = local_bounds(larger);
    EXPECT_LT((after.max - 2.0 * before.max).norm(), 1e-12);
    EXPECT_LT((after.min - 2.0 * before.min).norm(), 1e-12);
    EXPECT_NEAR(mass_properties(larger, 1.0).mass, 8.0 * mass_properties(shape, 1.0).mass, 1e-12);
}

TEST(Shapes, Box) {
    const Model model = box_model({0.5, 0.8, 1.1});
    expect_bounds(model);
    expect_mass(model);
    expect_rays(model, 2000);
    expect_collider(model, true);
    expect_enlarged(model.shape, enlarged(std::get<BoxShape>(model.shape), 2.0));
}

TEST(Shapes, Sphere) {
    const Model model = sphere_model(0.7);
    expect_bounds(model);
    expect_mass(model);
    expect_rays(model, 60);
    expect_collider(model, true);
    expect_enlarged(model.shape, enlarged(std::get<SphereShape>(model.shape), 2.0));
}

TEST(Shapes, MeshAndItsHull) {
    const Model model = mesh_model();
    expect_bounds(model);
    expect_mass(model);
    expect_rays(model, 2000);
    expect_collider(model, true);
}

TEST(Shapes, Compound) {
    const Model model = compound_model();
    expect_bounds(model);
    expect_mass(model);
    expect_rays(model, 60);
    expect_collider(model, false);
}

TEST(Shapes, FixedMesh) {
    const Model model = mesh_model();
    ColliderCache cache;
    const Vec3 origin(0.2, 0.1, 0.4);
    const CollisionShape collider = make_collider(model.shape, {true, origin, 1000.0}, cache);
    EXPECT_EQ(contact_surface(collider), ContactSurface::triangles);
    EXPECT_EQ(part_count(collider), 4u);
    double farthest = 0.0;
    Bounds bounds;
    for (const Vec3& v : model.surface.vertices) {
        bounds.add(Vec3(v - origin));
        farthest = std::max(farthest, (v - origin).norm());
    }
    EXPECT_NEAR(bounding_radius(collider), farthest, 1e-12);
    EXPECT_LT((world_bounds(collider, {}).max - bounds.max).norm(), 1e-12);
    using Surface = std::shared_ptr<const CollisionMesh>;
    EXPECT_EQ(std::get<Surface>(make_collider(model.shape, {true, origin, 1000.0}, cache)), std::get<Surface>(collider))
        << "made twice";
}

TEST(Shapes, Plane) {
    const PlaneShape plane{Vec3(1.0, 2.0, -2.0) / 3.0, 0.4};
    Random random(4);
    for (int trial = 0; trial < trials(300); ++trial) {
        const Vec3 from = random.vector(3.0), direction = random.vector(1.0);
        const double hit = first_hit(plane, from, direction);
        const auto height = [&](double t) { return plane.normal.dot(from + t * direction) - plane.offset; };
        if (std::isinf(hit)) {
            EXPECT_TRUE(height(0.0) <= 0.0 || height(1e6) > 0.0);
        } else {
            EXPECT_GT(height(0.0), 0.0);
            EXPECT_NEAR(height(hit), 0.0, 1e-9 * (1.0 + hit));
        }
    }
    EXPECT_TRUE(endless(plane));
    EXPECT_TRUE(local_bounds(Shape(plane)).empty());
    EXPECT_EQ(mass_properties(Shape(plane), 1000.0).mass, 0.0);
    EXPECT_EQ(enlarged(plane, 2.0).offset, 0.8);
    ColliderCache cache;
    const CollisionShape collider = make_collider(Shape(plane), {}, cache);
    EXPECT_TRUE(std::isinf(bounding_radius(collider)));
    EXPECT_TRUE(std::isinf(world_bounds(collider, {}).extent().x()));
}

}  // namespace
}  // namespace tumble::shapes_test
