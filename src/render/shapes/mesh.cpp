#include "render/shapes/drawn_shape.h"

#include "render/shapes/drawing_style.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

RenderMesh make_render_mesh(const MeshShape& shape) {
    const std::shared_ptr<const MeshAsset>& asset = shape.asset;
    RenderMesh proxy;
    proxy.asset = asset;
    proxy.paint = shape.paint();
    proxy.closed = closed(shape);
    if (proxy.paint)  // the inside is visible through holes
        for (const MeshMaterial& material : proxy.paint->materials)
            proxy.closed = proxy.closed && !material.has_holes();
    Bounds bounds;
    for (const MeshAsset::Vertex& v : asset->vertices) bounds.add(Vec3(v.position[0], v.position[1], v.position[2]));
    proxy.bound_center = bounds.center();
    proxy.half_extent = 0.5 * bounds.extent();
    return proxy;
}

/// Barycentric coordinates of the intersection of a ray with the triangle; their sum is 1.
std::array<double, 3> corner_shares(const std::array<Vec3, 3>& corners, const Vec3& ray) {
    std::array<double, 3> shares;
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        shares[i] = corners[(i + 1) % 3].cross(corners[(i + 2) % 3]).dot(ray);
        sum += shares[i];
    }
    for (double& share : shares) share /= sum;
    return shares;
}

}  // namespace

void set_proxy(RenderBody& proxy, const MeshShape& mesh, std::vector<RenderMesh>& meshes) {
    const std::shared_ptr<const MeshAsset>& asset = mesh.asset;
    if (asset == nullptr || asset->vertices.empty() || asset->indices.empty()) return;
    proxy.kind = DrawKind::mesh;
    const auto known = std::find_if(meshes.begin(), meshes.end(), [&](const RenderMesh& other) {
        return other.asset == asset && other.paint == mesh.paint();
    });
    proxy.mesh = std::size_t(known - meshes.begin());
    if (known == meshes.end()) meshes.push_back(make_render_mesh(mesh));
    const RenderMesh& shared = meshes[proxy.mesh];
    proxy.half_extent = shared.half_extent;
    proxy.bound_center = shared.bound_center;
    proxy.bound_radius = shared.half_extent.norm();
    proxy.ao_radius =
        std::max(ao_radius_of(shared.half_extent), 1e-3 * proxy.bound_radius);  // a flat mesh has no thickness
    proxy.pattern_cell = style::pattern_cell_of_radius * proxy.ao_radius;
}

double reach(const MeshShape& mesh) {
    double squared = 0.0;
    if (mesh.asset)
        for (const MeshAsset::Vertex& v : mesh.asset->vertices)
            squared = std::max(squared, Vec3(v.position[0], v.position[1], v.position[2]).squaredNorm());
    return std::sqrt(squared);
}

bool closed(const MeshShape& mesh) {
    const Closedness form = closedness(mesh.asset->mesh);
    return form.closed() && form.signed_volume > 0.0;
}

std::vector<SurfaceCorner> surface_triangles(const MeshShape& mesh) {
    std::vector<SurfaceCorner> corners;
    for (const std::uint32_t index : mesh.asset->indices) {
        const MeshAsset::Vertex& v = mesh.asset->vertices[index];
        corners.push_back(
            {Vec3(v.position[0], v.position[1], v.position[2]), Vec3(v.normal[0], v.normal[1], v.normal[2])});
    }
    return corners;
}

void cast_rays(const MeshShape& mesh, const PartPlace& place, RayTarget& target) {
    std::vector<Vec3> vertices;
    vertices.reserve(mesh.asset->vertices.size());
    for (const MeshAsset::Vertex& v : mesh.asset->vertices)
        vertices.push_back(place.origin + place.axes * Vec3(v.position[0], v.position[1], v.position[2]));
    target.add_triangles(vertices, mesh.asset->indices);
}

Color encoded(const std::array<float, 3>& linear) {
    const auto channel = [&](std::size_t c) {
        const double light = linear[c] > 0.0f ? std::min(double(linear[c]), 1.0) : 0.0;
        return std::uint8_t(std::lround(255.0 * linear_to_srgb(light)));
    };
    return {channel(0), channel(1), channel(2)};
}

Color painted_color(const MeshShape& mesh, const PartPlace& place, std::uint32_t triangle, const Vec3& ray) {
    const MeshPaint& paint = *mesh.paint();
    const std::size_t first = 3 * std::size_t(triangle);
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const MeshAsset::Vertex& v = mesh.asset->vertices[mesh.asset->indices[first + i]];
        corners[i] = place.origin + place.axes * Vec3(v.position[0], v.position[1], v.position[2]);
    }
    const std::array<double, 3> shares = corner_shares(corners, ray);
    std::array<float, 2> uv{};
    std::array<float, 3> color{};
    for (std::size_t i = 0; i < 3; ++i) {
        const MeshPaint::Corner& corner = paint.corners[first + i];
        for (std::size_t k = 0; k < 2; ++k) uv[k] += float(shares[i]) * corner.uv[k];
        for (std::size_t k = 0; k < 3; ++k) color[k] += float(shares[i]) * corner.color[k];
    }
    return encoded(color_at(paint.materials[paint.material_of_triangle[triangle]], uv, color));
}

Vec3 surface_normal(const MeshShape& mesh, const PartPlace& place, std::uint32_t triangle, const Vec3& ray, double) {
    std::array<Vec3, 3> corners, normals;
    for (std::size_t i = 0; i < 3; ++i) {
        const MeshAsset::Vertex& v = mesh.asset->vertices[mesh.asset->indices[3 * std::size_t(triangle) + i]];
        corners[i] = place.origin + place.axes * Vec3(v.position[0], v.position[1], v.position[2]);
        normals[i] = Vec3(v.normal[0], v.normal[1], v.normal[2]);
    }
    const std::array<double, 3> shares = corner_shares(corners, ray);
    const Vec3 flat = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    Vec3 normal = shares[0] * normals[0] + shares[1] * normals[1] + shares[2] * normals[2];
    if (!(normal.norm() > 0.0)) normal = place.axes.transpose() * flat;
    return (flat.dot(ray) > 0.0 ? -1.0 : 1.0) * normal.normalized();
}

}  // namespace tumble
