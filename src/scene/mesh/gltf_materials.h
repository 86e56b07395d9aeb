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

/// The texture coordinates of an image.
struct GltfPlace {
    std::uint64_t uv_set = 0;                                       // TEXCOORD_n
    std::array<float, 6> rows{1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f};  // of KHR_texture_transform
    bool operator==(const GltfPlace&) const = default;
};

/// A material, and the texture coordinates of its images.
struct GltfMaterial {
    MeshMaterial look;
    std::optional<GltfPlace> place;  // of the first image

    bool has_images() const { return look.texture || look.maps.bits() != 0; }
    std::array<float, 2> placed(float u, float v) const {
        const std::array<float, 6>& row = place->rows;
        return {row[0] * u + row[1] * v + row[2], row[3] * u + row[4] * v + row[5]};
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
    /// The image of a texture info of `owner`, in numbers or as a color. Null without one, or if its coordinates are
    /// not those of the material's first image.
    enum class Content { color, numbers };
    std::shared_ptr<const Texture> read_image(const Json& owner, const char* name, Content content,
                                              GltfMaterial& material);
    void read_sampler(const Json& texture, MeshMaterial& look) const;
    void read_maps(const Json& item, const Json& surface, GltfMaterial& material);
    void read_emission(const Json& item, GltfMaterial& material);
    /// The name and the bytes of the image of a texture; none if it has no PNG or JPEG file.
    std::optional<std::pair<std::string, std::string>> image_of(const Json& texture);

    const Json& document_;
    GltfBuffers& buffers_;
    MeshImages& images_;
};

}  // namespace tumble
