// Meshes in the colors of their files: a primitive for each material, with texture coordinates, colors of vertices, and
// the images of textures as PNG.
#pragma once

#include "gltf/glb_buffer.h"
#include "scene/description/description.h"

#include <cstddef>
#include <map>
#include <tuple>

namespace tumble {

class PaintedMeshes {
public:
    explicit PaintedMeshes(GlbBuffer& buffer) : buffer_(buffer) {}

    /// The primitives of a mesh; `look` has the properties that the file does not
    /// state. Materials are appended to `materials`.
    Json primitives(const MeshAsset& asset, const MeshPaint& paint, const Appearance& look, Json& materials);

    /// True if a material is brighter than white, which takes an extension.
    bool bright() const { return bright_; }
    /// The emission of a material, which is of linear light.
    void add_emission(const std::array<double, 3>& light, Json& material);

    /// Adds textures, samplers and images to the file's root, if there are any.
    void finish(Json& root) const;

private:
    Json primitive(const MeshAsset& asset, const MeshPaint& paint, std::uint32_t material);
    Json material(const MeshMaterial& material, const Appearance& look);
    /// The index of the texture of one of the images of a material.
    enum class Content { color, numbers };
    std::size_t texture(const Texture& image, Content content, const MeshMaterial& material);
    std::size_t image(const Texture& texture, Content content);

    GlbBuffer& buffer_;
    bool bright_ = false;
    Json textures_ = Json::array(), samplers_ = Json::array(), images_ = Json::array();
    std::map<const Texture*, std::size_t> image_of_;  // only looked up: their order has no effect
    std::map<std::tuple<TextureWrap, TextureWrap, bool>, std::size_t> sampler_of_;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> texture_of_;  // by image and sampler
};

}  // namespace tumble
