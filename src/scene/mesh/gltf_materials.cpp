#include "scene/mesh/gltf_materials.h"

#include "core/deterministic_math.h"
#include "scene/mesh/mesh_file.h"
#include "scene/mesh/texture_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

float number_of(const Json& object, const char* name, float standard) {
    const Json* value = find_member(object, name);
    return value && value->is_number() ? float(value->get<double>()) : standard;
}

float share_of(const Json& object, const char* name, float standard) {
    return std::clamp(number_of(object, name, standard), 0.0f, 1.0f);
}

std::string text_of(const Json& object, const char* name) {
    const Json* value = find_member(object, name);
    return value && value->is_string() ? value->get<std::string>() : std::string();
}

/// The member of a member, or null.
const Json* find_inner(const Json& object, const char* outer, const char* name) {
    const Json* value = find_member(object, outer);
    return value ? find_member(*value, name) : nullptr;
}

GltfPlace place_of(const Json& info) {
    GltfPlace place;
    place.uv_set = find_whole(info, "texCoord").value_or(0);
    const Json* moved = find_inner(info, "extensions", "KHR_texture_transform");
    if (!moved) return place;
    place.uv_set = find_whole(*moved, "texCoord").value_or(place.uv_set);
    const auto offset = find_floats(*moved, "offset", 2), scale = find_floats(*moved, "scale", 2);
    const SinCos turn = sincos(double(number_of(*moved, "rotation", 0.0f)));
    const float sx = scale ? (*scale)[0] : 1.0f, sy = scale ? (*scale)[1] : 1.0f;
    place.rows = {float(turn.cos) * sx,  float(turn.sin) * sy, offset ? (*offset)[0] : 0.0f,
                  float(-turn.sin) * sx, float(turn.cos) * sy, offset ? (*offset)[1] : 0.0f};
    return place;
}

}  // namespace

std::optional<std::pair<std::string, std::string>> GltfMaterials::image_of(const Json& texture) {
    const auto source = find_whole(texture, "source");
    if (!source) {  // an extension has an image in another format
        images_.add_missing("a texture that is neither PNG nor JPEG");
        return std::nullopt;
    }
    const Json& image = require_item(document_, "images", *source);
    const std::string uri = text_of(image, "uri"), name = fmt::format("image {}", *source);
    if (find_member(image, "bufferView")) return std::pair(name, std::string(buffers_.whole_view(image)));
    if (uri.starts_with("data:")) return std::pair(name, decode_data_uri(uri, "an image"));
    const std::string file = without_percents(uri);
    std::optional<std::string> bytes = images_.read(file);
    if (!bytes) return std::nullopt;
    return std::pair(file, std::move(*bytes));
}

void GltfMaterials::read_sampler(const Json& texture, MeshMaterial& look) const {
    const auto number = find_whole(texture, "sampler");
    if (!number) return;
    const Json& sampler = require_item(document_, "samplers", *number);
    constexpr std::uint64_t nearest = 9728, clamp = 33071, mirror = 33648;  // OpenGL's
    const auto wrap = [&](const char* name) {
        const std::uint64_t mode = find_whole(sampler, name).value_or(0);
        return mode == clamp ? TextureWrap::clamp : mode == mirror ? TextureWrap::mirror : TextureWrap::repeat;
    };
    look.nearest = find_whole(sampler, "magFilter") == nearest;
    look.wrap_u = wrap("wrapS");
    look.wrap_v = wrap("wrapT");
}

std::shared_ptr<const Texture> GltfMaterials::read_image(const Json& owner, const char* name, Content content,
                                                         GltfMaterial& material) {
    const Json* info = find_member(owner, name);
    if (!info) return nullptr;
    const Json& texture = require_item(document_, "textures", require_whole(*info, "index"));
    const GltfPlace place = place_of(*info);
    if (material.place && *material.place != place) {
        images_.add_missing(fmt::format("a \"{}\" with places of its own", name));
        return nullptr;
    }
    const auto image = image_of(texture);
    if (!image) return nullptr;
    if (!material.place) read_sampler(texture, material.look);
    material.place = place;
    return content == Content::color ? images_.texture(image->first, image->second)
                                     : images_.map(image->first, image->second);
}

/// Occlusion and roughness are of one map, mostly of one image.
void GltfMaterials::read_maps(const Json& item, const Json& surface, GltfMaterial& material) {
    MeshMaterial& look = material.look;
    const auto rough = read_image(surface, "metallicRoughnessTexture", Content::numbers, material);
    const auto open = read_image(item, "occlusionTexture", Content::numbers, material);
    const float strength = open ? share_of(item["occlusionTexture"], "strength", 1.0f) : 0.0f;
    const auto texel_of = [](const Texture& map, int x, int y, const Texture::Level& in) {
        const Texture::Level& image = map.levels.front();
        const int column = int(std::int64_t(x) * image.width / in.width);
        const int row = int(std::int64_t(y) * image.height / in.height);
        return image.texels[std::size_t(row) * std::size_t(image.width) + std::size_t(column)];
    };
    if (rough || open) {
        const bool by_rough = rough && (!open || rough->levels.size() >= open->levels.size());
        const Texture& larger = by_rough ? *rough : *open;
        look.maps.surface = changed_map(larger, [&](int x, int y, std::array<std::uint8_t, 4>& texel) {
            const float loss = open ? strength * float(255 - texel_of(*open, x, y, larger.levels.front())[0]) : 0.0f;
            texel = rough ? texel_of(*rough, x, y, larger.levels.front()) : std::array<std::uint8_t, 4>{0, 255, 255, 0};
            texel[0] = std::uint8_t(std::lround(255.0f - loss));
            texel[3] = 255;
        });
    }
    look.maps.normal = read_image(item, "normalTexture", Content::numbers, material);
    const float scale = look.maps.normal ? number_of(item["normalTexture"], "scale", 1.0f) : 1.0f;
    if (scale != 1.0f)
        look.maps.normal = changed_map(*look.maps.normal, [&](int, int, std::array<std::uint8_t, 4>& texel) {
            std::array<float, 3> n;
            for (std::size_t c = 0; c < 3; ++c) n[c] = (float(texel[c]) - 128.0f) / 127.0f * (c < 2 ? scale : 1.0f);
            const float length = std::max(std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), 1e-6f);
            for (std::size_t c = 0; c < 3; ++c)
                texel[c] = std::uint8_t(std::lround(std::clamp(128.0f + 127.0f * n[c] / length, 0.0f, 255.0f)));
        });
}

void GltfMaterials::read_emission(const Json& item, GltfMaterial& material) {
    const auto light = find_floats(item, "emissiveFactor", 3);
    if (!light) return;
    MeshMaterial& look = material.look;
    const Json* stronger = find_inner(item, "extensions", "KHR_materials_emissive_strength");
    constexpr float brightest = 1000.0f;
    const float strength =
        stronger ? std::clamp(number_of(*stronger, "emissiveStrength", 1.0f), 0.0f, brightest) : 1.0f;
    for (std::size_t c = 0; c < 3; ++c) look.emission[c] = strength * std::clamp((*light)[c], 0.0f, 1.0f);
    if (look.emission == std::array<float, 3>{} || !find_member(item, "emissiveTexture")) return;
    look.maps.emission = read_image(item, "emissiveTexture", Content::color, material);
    if (!look.maps.emission) look.emission = {};
}

GltfMaterial GltfMaterials::read(std::uint64_t number) {
    const Json& item = require_item(document_, "materials", number);
    const Json none = Json::object();
    const Json* given = find_member(item, "pbrMetallicRoughness");
    const Json& surface = given ? *given : none;
    GltfMaterial material;
    MeshMaterial& look = material.look;
    const auto color = find_floats(surface, "baseColorFactor", 4);
    if (color)
        for (std::size_t c = 0; c < 3; ++c) look.color[c] = std::clamp((*color)[c], 0.0f, 1.0f);
    look.metallic = share_of(surface, "metallicFactor", 1.0f);
    look.roughness = share_of(surface, "roughnessFactor", 1.0f);
    look.texture = read_image(surface, "baseColorTexture", Content::color, material);
    read_maps(item, surface, material);
    read_emission(item, material);
    const std::string mode = text_of(item, "alphaMode");
    constexpr float hole = 0.5f;  // glTF's default
    if (mode == "MASK") look.cutoff = share_of(item, "alphaCutoff", hole);
    if (mode == "BLEND") {
        look.blends = true;
        if (color) look.opacity = std::clamp((*color)[3], 0.0f, 1.0f);
    }
    return material;
}

}  // namespace tumble
