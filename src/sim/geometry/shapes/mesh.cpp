#include "sim/geometry/shapes/mesh.h"

#include "core/error.h"
#include "core/triangle_mesh.h"
#include "sim/geometry/shapes/shape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace tumble {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;  // vertex indices, the lower first

// Orients triangles so that each component is wound as its first triangle. One-sided components (Moebius strips) stay
// as they are and get no index.
void turn_to_sheets(std::vector<CollisionMesh::Triangle>& triangles) {
    std::vector<std::array<std::uint32_t, 3>> vertices;
    vertices.reserve(triangles.size());
    for (const CollisionMesh::Triangle& triangle : triangles) vertices.push_back(triangle.vertices);
    const MeshComponents sheets = find_sheets(vertices);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (sheets.sheet[t] == MeshComponents::none) continue;
        CollisionMesh::Triangle& triangle = triangles[t];
        triangle.sheet = sheets.sheet[t];
        if (!sheets.flipped[t]) continue;
        std::swap(triangle.vertices[1], triangle.vertices[2]);
        triangle.normal = -triangle.normal;
    }
}

}  // namespace

CollisionMesh make_collision_mesh(const TriangleMesh& mesh, const Vec3& origin) {
    CollisionMesh s;
    s.closed = closedness(mesh).closed();
    for (const Vec3& v : mesh.vertices) {
        s.vertices.push_back(v - origin);
        s.radius = std::max(s.radius, s.vertices.back().norm());
    }
    std::vector<Bounds> bounds;
    for (const auto& t : mesh.triangles) {
        const Vec3 &a = s.vertices[t[0]], &b = s.vertices[t[1]], &c = s.vertices[t[2]];
        const Vec3 n = (b - a).cross(c - a);
        if (n.norm() == 0.0) continue;
        CollisionMesh::Triangle triangle;
        triangle.vertices = t;
        triangle.normal = n.normalized();
        s.triangles.push_back(triangle);
        Bounds box;
        for (const std::uint32_t v : t) box.add(s.vertices[v]);
        bounds.push_back(box);
    }
    if (s.triangles.empty()) throw InputError("the mesh has no triangle with an area");
    if (!s.closed) turn_to_sheets(s.triangles);
    std::map<Edge, std::vector<std::pair<std::uint32_t, int>>> users;
    s.fan_start.assign(s.vertices.size() + 1, 0);
    for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
        const auto& v = s.triangles[t].vertices;
        for (int i = 0; i < 3; ++i) {
            users[std::minmax(v[std::size_t(i)], v[std::size_t((i + 1) % 3)])].emplace_back(t, i);
            ++s.fan_start[v[std::size_t(i)] + 1];
        }
    }
    std::partial_sum(s.fan_start.begin(), s.fan_start.end(), s.fan_start.begin());
    s.fan.resize(s.fan_start.back());
    std::vector<std::uint32_t> next = s.fan_start;
    for (std::uint32_t t = 0; t < s.triangles.size(); ++t)
        for (const std::uint32_t v : s.triangles[t].vertices) s.fan[next[v]++] = t;
    for (const auto& [ends, list] : users) {
        for (const auto& [t, i] : list) s.triangles[t].edge[i] = s.edge_count;
        ++s.edge_count;
        if (list.size() != 2) continue;
        const auto opposite = [&](const std::pair<std::uint32_t, int>& user) {
            return std::int32_t(s.triangles[user.first].vertices[(user.second + 2) % 3]);
        };
        s.triangles[list[0].first].across[list[0].second] = opposite(list[1]);
        s.triangles[list[1].first].across[list[1].second] = opposite(list[0]);
    }
    s.ring_start.assign(s.vertices.size() + 1, 0);
    for (const auto& [ends, list] : users)
        for (const std::uint32_t v : {ends.first, ends.second}) ++s.ring_start[v + 1];
    std::partial_sum(s.ring_start.begin(), s.ring_start.end(), s.ring_start.begin());
    s.ring.resize(s.ring_start.back());
    next = s.ring_start;
    for (const auto& [ends, list] : users) {
        s.ring[next[ends.first]++] = ends.second;
        s.ring[next[ends.second]++] = ends.first;
    }
    s.tree = BoundsTree(std::move(bounds));
    return s;
}

bool CollisionMesh::owns_normal(const Triangle& triangle, const Vec3& normal) const {
    constexpr double slack = 1e-9;  // sine of the angle allowed for rounding
    const auto farther = [&](std::uint32_t to, std::uint32_t from) {
        const Vec3 edge = vertices[to] - vertices[from];
        return normal.dot(edge) > slack * edge.norm();
    };
    const auto& v = triangle.vertices;
    std::size_t top = 0;
    for (const std::size_t i : {1u, 2u})
        if (farther(v[i], v[top])) top = i;
    const std::size_t next = (top + 1) % 3, last = (top + 2) % 3;
    const bool with_next = !farther(v[top], v[next]), with_last = !farther(v[top], v[last]);
    if (with_next && with_last) return true;  // the triangle's own normal
    if (with_next || with_last) {
        const std::int32_t beyond = triangle.across[with_next ? top : last];
        return beyond < 0 || !farther(std::uint32_t(beyond), v[top]);
    }
    return std::none_of(ring.begin() + ring_start[v[top]], ring.begin() + ring_start[v[top] + 1],
                        [&](std::uint32_t w) { return farther(w, v[top]); });
}

NearestOnTriangle nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d1 <= 0.0 && d2 <= 0.0) return {a, 4};
    if (d3 >= 0.0 && d4 <= d3) return {b, 5};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {a + d1 / (d1 - d3) * ab, 1};
    if (d6 >= 0.0 && d5 <= d6) return {c, 6};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {a + d2 / (d2 - d6) * ac, 3};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 2};
    const double scale = 1.0 / (va + vb + vc);
    return {a + vb * scale * ab + vc * scale * ac, 0};
}

void visit_extent(const MeshShape& mesh, const ExtentVisitor& visit) {
    for (const Vec3& v : mesh.asset->mesh.vertices) visit(v, 0.0);
}

MassProperties mesh_mass(const TriangleMesh& mesh, double density) {
    // Relative to the middle of the bounds, so that a mesh far from its origin loses no digits.
    const Vec3 apex = mesh.bounds().center();
    double volume = 0.0;
    Vec3 first = Vec3::Zero();   // integral of x dV
    Mat3 second = Mat3::Zero();  // integral of x x^T dV
    for (const auto& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - apex, b = mesh.vertices[t[1]] - apex, c = mesh.vertices[t[2]] - apex;
        const double det = a.dot(b.cross(c));  // six times the tetrahedron's signed volume
        const Vec3 sum = a + b + c;
        volume += det / 6.0;
        first += det / 24.0 * sum;
        // Integral of x x^T over the tetrahedron (0, a, b, c): det/120 (aa + bb + cc + (a+b+c)(a+b+c)).
        second += det / 120.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
    MassProperties p;
    p.mass = density * volume;
    const Vec3 center = first / volume;
    const Mat3 covariance = density * (second - volume * center * center.transpose());
    p.inertia = covariance.trace() * Mat3::Identity() - covariance;
    p.center_of_mass = apex + center;
    return p;
}

namespace {

/// A plate along the triangles, thin beside their size.
MassProperties shell_mass(const TriangleMesh& mesh, double thickness, double density) {
    const Vec3 apex = mesh.bounds().center();
    double area = 0.0;
    Vec3 first = Vec3::Zero();   // integral of x dA
    Mat3 second = Mat3::Zero();  // integral of x x^T dA
    for (const auto& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - apex, b = mesh.vertices[t[1]] - apex, c = mesh.vertices[t[2]] - apex;
        const double one = 0.5 * (b - a).cross(c - a).norm();
        const Vec3 sum = a + b + c;
        area += one;
        first += one / 3.0 * sum;
        second += one / 12.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
    }
    const double per_area = density * thickness;  // kg/m^2
    const Vec3 center = first / area;
    const Mat3 covariance = per_area * (second - area * center * center.transpose());
    return {per_area * area, apex + center, covariance.trace() * Mat3::Identity() - covariance};
}

/// The surface of a convex polyhedron.
TriangleMesh triangles_of(const Polyhedron& hull) {
    TriangleMesh mesh;
    mesh.vertices = hull.vertices;
    for (const Polyhedron::Face& face : hull.faces)
        for (std::size_t i = 2; i < face.vertices.size(); ++i)
            mesh.triangles.push_back({face.vertices[0], face.vertices[i - 1], face.vertices[i]});
    return mesh;
}

/// The corners by which a moving mesh collides. A shell that is flatter than its thickness gets both sides: its hull
/// alone would have no volume.
std::vector<Vec3> hull_points(const MeshShape& shape) {
    const std::vector<Vec3>& vertices = shape.asset->mesh.vertices;
    if (shape.mass_from != MassFrom::shell) return vertices;
    const PrincipalInertia inertia = principal_inertia(shell_mass(shape.asset->mesh, 1.0, 1.0).inertia);
    Eigen::Index across = 0;  // a plate has its largest moment about its normal
    inertia.moments.maxCoeff(&across);
    const Vec3 normal = inertia.axes * Vec3::Unit(across);
    double low = infinity, high = -infinity;
    for (const Vec3& v : vertices) {
        low = std::min(low, normal.dot(v));
        high = std::max(high, normal.dot(v));
    }
    if (high - low >= shape.thickness) return vertices;
    std::vector<Vec3> both;
    for (const double side : {-0.5, 0.5})
        for (const Vec3& v : vertices) both.push_back(v + side * shape.thickness * normal);
    return both;
}

}  // namespace

MassProperties mass_properties(const MeshShape& mesh, double density) {
    const TriangleMesh& surface = mesh.asset->mesh;
    switch (mesh.mass_from) {
        case MassFrom::shell:
            return shell_mass(surface, mesh.thickness, density);
        case MassFrom::hull:
            return mesh_mass(triangles_of(make_hull(surface.vertices, Vec3::Zero())), density);
        case MassFrom::solid:
            break;
    }
    // A mesh that moves is closed, but the slivers without area that closed it may be gone; a fixed one may be open.
    const MassProperties solid = mesh_mass(surface, density);
    return solid.mass > 0.0 ? solid : MassProperties{};
}

/// Moeller and Trumbore 1997, Fast, Minimum Storage Ray/Triangle Intersection.
double first_hit(const MeshShape& shape, const Vec3& from, const Vec3& direction) {
    const TriangleMesh& mesh = shape.asset->mesh;
    double nearest = infinity;
    for (const auto& t : mesh.triangles) {
        const Vec3 &a = mesh.vertices[t[0]], ab = mesh.vertices[t[1]] - a, ac = mesh.vertices[t[2]] - a;
        const Vec3 p = direction.cross(ac), to = from - a;
        const double determinant = ab.dot(p);
        if (determinant == 0.0) continue;
        const double u = to.dot(p) / determinant;
        if (u < 0.0 || u > 1.0) continue;
        const Vec3 q = to.cross(ab);
        const double v = direction.dot(q) / determinant;
        if (v < 0.0 || u + v > 1.0) continue;
        const double at = ac.dot(q) / determinant;
        if (at > 0.0) nearest = std::min(nearest, at);
    }
    return nearest;
}

CollisionShape make_collider(const MeshShape& mesh, const ColliderRequest& request, ColliderCache& cache) {
    const MeshAsset& asset = *mesh.asset;
    ColliderCache::Mesh& made = cache.meshes[{&asset, mesh.mass_from, mesh.thickness}];
    try {
        if (request.fixed) {
            if (!made.surface)
                made.surface = std::make_shared<CollisionMesh>(make_collision_mesh(asset.mesh, request.origin));
            return made.surface;
        }
        if (!made.hull && asset.convex)
            if (auto hull = convex_polyhedron(asset.mesh, request.origin))
                made.hull = std::make_shared<Polyhedron>(std::move(*hull));
        if (!made.hull) made.hull = std::make_shared<Polyhedron>(make_hull(hull_points(mesh), request.origin));
        return made.hull;
    } catch (const InputError& error) {
        const std::string what = error.what();
        throw InputError(SourceLocation{asset.file, 0, 0}, what.substr(what.find("error: ") + 7));
    }
}

}  // namespace tumble
