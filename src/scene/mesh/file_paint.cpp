#include "scene/mesh/mesh_file.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

std::uint8_t channel(double linear) {
    return std::uint8_t(std::lround(255.0 * linear_to_srgb(linear > 0.0 ? std::min(linear, 1.0) : 0.0)));
}

/// Numbers that are not finite become 0: a file may have any.
template <std::size_t N>
std::array<float, N> finite(std::array<float, N> values) {
    for (float& value : values)
        if (!std::isfinite(value)) value = 0.0f;
    return values;
}

/// The mean over the surface, with the mean of each texture.
Color mean_color(const MeshPaint& paint, const TriangleMesh& mesh) {
    Vec3 sum = Vec3::Zero();
    double whole = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3& corner = mesh.vertices[a];
        const double area = (mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner).norm();
        const MeshMaterial& material = paint.materials[paint.material_of_triangle[t]];
        Vec3 color(material.color[0], material.color[1], material.color[2]);
        if (material.texture) {
            const auto texel = material.texture->texel(material.texture->levels.size() - 1, 0, 0);
            color = color.cwiseProduct(Vec3(texel[0], texel[1], texel[2]));
        }
        Vec3 vertices = Vec3::Zero();
        for (std::size_t i = 0; i < 3; ++i) {
            const auto& one = paint.corners[3 * t + i].color;
            vertices += Vec3(one[0], one[1], one[2]) / 3.0;
        }
        sum += area * color.cwiseProduct(vertices);
        whole += area;
    }
    if (whole > 0.0) sum /= whole;
    return {channel(sum.x()), channel(sum.y()), channel(sum.z())};
}

}  // namespace

std::shared_ptr<const MeshPaint> make_paint(const MeshFile& file, const TriangleMesh& mesh,
                                            const std::vector<std::array<MeshFile::Corner, 3>>& corners) {
    const bool has_material = std::any_of(corners.begin(), corners.end(), [](const auto& triangle) {
        return triangle[0].material != MeshFile::no_material;
    });
    if (!has_material && !file.colored) return nullptr;
    auto paint = std::make_shared<MeshPaint>();
    paint->materials = file.materials;
    paint->materials.emplace_back();  // of triangles without one
    paint->missing_images = file.missing_images;
    for (const auto& triangle : corners) {
        paint->material_of_triangle.push_back(std::min(triangle[0].material, std::uint32_t(file.materials.size())));
        for (const MeshFile::Corner& corner : triangle)
            paint->corners.push_back({finite(corner.uv), finite(corner.color)});
    }
    paint->mean = mean_color(*paint, mesh);
    return paint;
}

}  // namespace tumble
