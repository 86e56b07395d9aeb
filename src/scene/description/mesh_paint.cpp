#include "scene/description/mesh_paint.h"

#include "scene/description/painted_mesh.h"
#include "scene/description/texel_of.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace tumble {

std::array<float, 4> Texture::texel(std::size_t level, int x, int y) const {
    const Level& image = levels[level];
    const auto& code = image.texels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
    std::array<float, 4> result{};
    for (std::size_t c = 0; c < 4; ++c) result[c] = float(code[c]) / 255.0f;
    for (std::size_t c = 0; c < 3; ++c) result[c] *= result[c];
    return result;
}

std::array<float, 3> color_at(const MeshMaterial& material, const std::array<float, 2>& uv,
                              const std::array<float, 3>& vertex_color) {
    std::array<float, 3> color = material.color;
    const std::array<float, 4> texel = nearest_texel(material, uv);
    for (std::size_t c = 0; c < 3; ++c) color[c] = color[c] * texel[c] * vertex_color[c];
    return color;
}

namespace {

bool same_texture(const MeshMaterial& a, const MeshMaterial& b) {
    return a.texture == b.texture && a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v && a.nearest == b.nearest &&
           a.maps == b.maps && a.translucent() == b.translucent() && a.blends == b.blends;
}

/// For each material the first one with its texture.
std::vector<std::size_t> first_with_texture(const std::vector<MeshMaterial>& materials) {
    std::vector<std::size_t> first;
    for (const MeshMaterial& material : materials)
        first.push_back(
            std::size_t(std::find_if(materials.begin(), materials.end(),
                                     [&](const MeshMaterial& other) { return same_texture(material, other); }) -
                        materials.begin()));
    return first;
}

float hole_of(const MeshMaterial& material) {
    return material.has_holes() ? material.cutoff : material.blends ? -1.0f : 0.0f;
}

VertexPaint paint_of(const MeshMaterial& material, const MeshPaint::Corner& corner) {
    VertexPaint paint{corner.uv,
                      material.color,
                      {material.roughness, material.metallic, hole_of(material), material.opacity},
                      material.emission};
    for (std::size_t c = 0; c < 3; ++c) paint.color[c] *= corner.color[c];
    return paint;
}

}  // namespace

PaintedCorners different_corners(std::span<const std::uint32_t> indices, const MeshPaint& paint,
                                 std::span<const std::uint32_t> triangles) {
    PaintedCorners corners;
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::array<float, 2>, std::array<float, 3>>, std::uint32_t> made;
    for (const std::uint32_t triangle : triangles)
        for (std::size_t i = 3 * std::size_t(triangle); i < 3 * std::size_t(triangle) + 3; ++i) {
            const MeshPaint::Corner& corner = paint.corners[i];
            const auto [entry, is_new] =
                made.try_emplace({indices[i], paint.material_of_triangle[triangle], corner.uv, corner.color},
                                 std::uint32_t(corners.vertices.size()));
            corners.indices.push_back(entry->second);
            if (is_new) corners.vertices.push_back(i);
        }
    return corners;
}

PaintedMesh paint_mesh(std::span<const std::uint32_t> indices, const MeshPaint& paint) {
    const std::vector<std::size_t> first = first_with_texture(paint.materials);
    const auto texture_of = [&](std::uint32_t triangle) { return first[paint.material_of_triangle[triangle]]; };
    std::vector<std::uint32_t> order(indices.size() / 3);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return texture_of(a) < texture_of(b); });

    PaintedMesh mesh;
    for (std::size_t n = 0; n < order.size(); ++n) {
        const MeshMaterial* texture = &paint.materials[texture_of(order[n])];
        if (mesh.ranges.empty() || mesh.ranges.back().material != texture) mesh.ranges.push_back({texture, 3 * n, 0});
        mesh.ranges.back().count += 3;
    }
    PaintedCorners corners = different_corners(indices, paint, order);
    mesh.indices = std::move(corners.indices);
    for (const std::size_t corner : corners.vertices) {
        mesh.source.push_back(indices[corner]);
        mesh.paint.push_back(paint_of(paint.materials[paint.material_of_triangle[corner / 3]], paint.corners[corner]));
    }
    return mesh;
}

}  // namespace tumble
