#include "scene/mesh/gltf_materials.h"

#include "core/deterministic_math.h"
#include "scene/mesh/mesh_file.h"
#include "scene/mesh/texture_image.h"

#include <fmt/format.h>

#include <algorithm>

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

void GltfMaterials::read_texture(const Json& info, GltfMaterial& material) {
    const Json& texture = require_item(document_, "textures", require_whole(info, "index"));
    material.uv_set = find_whole(info, "texCoord").value_or(0);
    if (const auto image = image_of(texture)) material.look.texture = images_.texture(image->first, image->second);
    read_sampler(texture, material.look);
    const Json* moved = find_inner(info, "extensions", "KHR_texture_transform");
    if (!moved) return;
    material.uv_set = find_whole(*moved, "texCoord").value_or(material.uv_set);
    const auto offset = find_floats(*moved, "offset", 2), scale = find_floats(*moved, "scale", 2);
    const SinCos turn = sincos(double(number_of(*moved, "rotation", 0.0f)));
    const float sx = scale ? (*scale)[0] : 1.0f, sy = scale ? (*scale)[1] : 1.0f;
    material.place = {float(turn.cos) * sx,  float(turn.sin) * sy, offset ? (*offset)[0] : 0.0f,
                      float(-turn.sin) * sx, float(turn.cos) * sy, offset ? (*offset)[1] : 0.0f};
}

GltfMaterial GltfMaterials::read(std::uint64_t number) {
    const Json& item = require_item(document_, "materials", number);
    const Json none = Json::object();
    const Json* given = find_member(item, "pbrMetallicRoughness");
    const Json& surface = given ? *given : none;
    GltfMaterial material;
    MeshMaterial& look = material.look;
    if (const auto color = find_floats(surface, "baseColorFactor", 4))
        for (std::size_t c = 0; c < 3; ++c) look.color[c] = std::clamp((*color)[c], 0.0f, 1.0f);
    look.metallic = share_of(surface, "metallicFactor", 1.0f);
    look.roughness = share_of(surface, "roughnessFactor", 1.0f);
    if (const Json* texture = find_member(surface, "baseColorTexture")) read_texture(*texture, material);
    if (const Json* map = find_member(surface, "metallicRoughnessTexture"))
        if (const auto image = image_of(require_item(document_, "textures", require_whole(*map, "index")));
            image && is_texture_image(image->second)) {
            const std::array<float, 4> mean = mean_of_image(image->second, image->first);
            look.roughness *= mean[1];
            look.metallic *= mean[2];
        }
    if (!find_member(item, "emissiveTexture"))
        if (const auto light = find_floats(item, "emissiveFactor", 3))
            for (std::size_t c = 0; c < 3; ++c) look.emission[c] = std::clamp((*light)[c], 0.0f, 1.0f);
    const std::string mode = text_of(item, "alphaMode");
    constexpr float hole = 0.5f;  // glTF's default
    if (mode == "MASK") look.cutoff = share_of(item, "alphaCutoff", hole);
    if (mode == "BLEND") look.cutoff = hole;
    return material;
}

}  // namespace tumble
