#include "gltf/painted_meshes.h"

#include "core/image.h"
#include "output/png_writer.h"
#include "scene/description/painted_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace tumble {
namespace {

// Numbers of the format.
constexpr int nearest = 9728, linear = 9729, nearest_mip_linear = 9986, linear_mip_linear = 9987;
int wrap_number(TextureWrap wrap) {
    return wrap == TextureWrap::repeat ? 10497 : wrap == TextureWrap::mirror ? 33648 : 33071;
}

double stated(float value, double of_body) { return value == MeshMaterial::of_body ? of_body : double(value); }

Json color_json(const std::array<float, 3>& color) { return {double(color[0]), double(color[1]), double(color[2])}; }

/// `coded`: the texels are square roots of light.
Image picture_of(const Texture& texture, bool coded) {
    Image image(texture.levels[0].width, texture.levels[0].height);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const std::array<float, 4> texel = texture.texel(0, x, y);
            const auto& bytes = texture.levels[0].texels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
            if (!coded) {
                std::copy(bytes.begin(), bytes.end(), image.at(x, y));
                continue;
            }
            for (std::size_t c = 0; c < 3; ++c)
                image.at(x, y)[c] = std::uint8_t(std::lround(255.0 * linear_to_srgb(double(texel[c]))));
            image.at(x, y)[3] = std::uint8_t(std::lround(255.0 * double(texel[3])));
        }
    return image;
}

}  // namespace

Json PaintedMeshes::primitives(const MeshAsset& asset, const MeshPaint& paint, const Appearance& look,
                               Json& materials) {
    Json list = Json::array();
    for (std::uint32_t i = 0; i < paint.materials.size(); ++i) {
        if (std::ranges::find(paint.material_of_triangle, i) == paint.material_of_triangle.end()) continue;
        Json one = primitive(asset, paint, i);
        one["material"] = materials.size();
        materials.push_back(material(paint.materials[i], look));
        list.push_back(std::move(one));
    }
    return list;
}

Json PaintedMeshes::primitive(const MeshAsset& asset, const MeshPaint& paint, std::uint32_t material) {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t triangle = 0; triangle < paint.material_of_triangle.size(); ++triangle)
        if (paint.material_of_triangle[triangle] == material) triangles.push_back(triangle);
    const PaintedCorners different = different_corners(asset.indices, paint, triangles);
    std::vector<float> positions, normals, places, colors;
    for (const std::size_t i : different.vertices) {
        const MeshPaint::Corner& corner = paint.corners[i];
        const MeshAsset::Vertex& vertex = asset.vertices[asset.indices[i]];
        positions.insert(positions.end(), vertex.position, vertex.position + 3);
        normals.insert(normals.end(), vertex.normal, vertex.normal + 3);
        places.insert(places.end(), corner.uv.begin(), corner.uv.end());
        colors.insert(colors.end(), corner.color.begin(), corner.color.end());
    }
    constexpr auto vertices = GlbBuffer::Use::vertices;
    Json attributes{{"POSITION", buffer_.add(positions, 3, vertices, true)},
                    {"NORMAL", buffer_.add(normals, 3, vertices, false)}};
    const MeshMaterial& look = paint.materials[material];
    if (look.texture || look.maps.bits() != 0) attributes["TEXCOORD_0"] = buffer_.add(places, 2, vertices, false);
    const bool colored = std::ranges::any_of(colors, [](float channel) { return channel != 1.0f; });
    if (colored) attributes["COLOR_0"] = buffer_.add(colors, 3, vertices, false);
    return {{"attributes", std::move(attributes)}, {"indices", buffer_.add(different.indices)}};
}

Json PaintedMeshes::material(const MeshMaterial& material, const Appearance& look) {
    Json surface{{"baseColorFactor", color_json(material.color)},
                 {"metallicFactor", stated(material.metallic, look.metallic)},
                 {"roughnessFactor", stated(material.roughness, look.roughness)}};
    surface["baseColorFactor"].push_back(double(material.opacity) * look.opacity);
    if (material.texture)
        surface["baseColorTexture"] = {{"index", texture(*material.texture, Content::color, material)}};
    const SurfaceMaps& maps = material.maps;
    const auto map = [&](const SurfaceMaps::Map& image) {
        return Json{{"index", texture(*image, Content::numbers, material)}};
    };
    if (maps.surface) surface["metallicRoughnessTexture"] = map(maps.surface);
    Json json{{"pbrMetallicRoughness", std::move(surface)}};
    if (maps.surface) json["occlusionTexture"] = map(maps.surface);
    if (maps.normal) json["normalTexture"] = map(maps.normal);
    std::array<double, 3> light = to_linear(look.emission);
    for (std::size_t c = 0; c < 3; ++c) light[c] += double(material.emission[c]);
    add_emission(light, json);
    if (maps.emission) json["emissiveTexture"] = {{"index", texture(*maps.emission, Content::color, material)}};
    if (look.opacity < 1.0 || material.translucent()) {
        json["alphaMode"] = "BLEND";
    } else if (material.has_holes()) {
        json["alphaMode"] = "MASK";
        json["alphaCutoff"] = double(material.cutoff);
    }
    return json;
}

void PaintedMeshes::add_emission(const std::array<double, 3>& light, Json& material) {
    const double most = *std::ranges::max_element(light);
    if (!(most > 0.0)) return;
    const double strength = std::max(most, 1.0);
    material["emissiveFactor"] = {light[0] / strength, light[1] / strength, light[2] / strength};
    if (strength == 1.0) return;
    bright_ = true;
    material["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
}

std::size_t PaintedMeshes::texture(const Texture& of, Content content, const MeshMaterial& material) {
    const auto [sampler, new_sampler] =
        sampler_of_.try_emplace({material.wrap_u, material.wrap_v, material.nearest}, samplers_.size());
    if (new_sampler)
        samplers_.push_back({{"magFilter", material.nearest ? nearest : linear},
                             {"minFilter", material.nearest ? nearest_mip_linear : linear_mip_linear},
                             {"wrapS", wrap_number(material.wrap_u)},
                             {"wrapT", wrap_number(material.wrap_v)}});
    const auto [entry, is_new] = texture_of_.try_emplace({image(of, content), sampler->second}, textures_.size());
    if (is_new) textures_.push_back({{"source", entry->first.first}, {"sampler", entry->first.second}});
    return entry->second;
}

std::size_t PaintedMeshes::image(const Texture& texture, Content content) {
    const auto [entry, is_new] = image_of_.try_emplace(&texture, images_.size());
    if (is_new) {
        PngEncoder encoder(texture.least_alpha < 255 ? PngAlpha::kept : PngAlpha::dropped);
        images_.push_back(
            {{"bufferView", buffer_.add_bytes(encoder.encode(picture_of(texture, content == Content::color)))},
             {"mimeType", "image/png"}});
    }
    return entry->second;
}

void PaintedMeshes::finish(Json& root) const {
    if (images_.empty()) return;
    root["textures"] = textures_;
    root["samplers"] = samplers_;
    root["images"] = images_;
}

}  // namespace tumble
