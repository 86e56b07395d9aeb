// Materials, textures and images of a glTF file.
#pragma once

#include "scene/description/mesh_paint.h"
#include "scene/mesh/gltf_buffers.h"
#include "scene/mesh/gltf_json.h"
#include "scene/mesh/mesh_images.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace tumble {

/// A material, and the texture coordinates of its texture.
struct GltfMaterial {
    MeshMaterial look;
    std::uint64_t uv_set = 0;                                        // TEXCOORD_n
    std::array<float, 6> place{1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f};  // rows of KHR_texture_transform

    std::array<float, 2> placed(float u, float v) const {
        return {place[0] * u + place[1] * v + place[2], place[3] * u + place[4] * v + place[5]};
    }
};

class GltfMaterials {
public:
    /// All must outlive it.
    GltfMaterials(const Json& document, GltfBuffers& buffers, MeshImages& images)
        : document_(document), buffers_(buffers), images_(images) {}

    /// Throws MeshError.
    GltfMaterial read(std::uint64_t material);

private:
    void read_texture(const Json& info, GltfMaterial& material);
    void read_sampler(const Json& texture, MeshMaterial& look) const;
    /// The name and the bytes of the image of a texture; none if it has no PNG or JPEG file.
    std::optional<std::pair<std::string, std::string>> image_of(const Json& texture);

    const Json& document_;
    GltfBuffers& buffers_;
    MeshImages& images_;
};

}  // namespace tumble
