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

    /// Adds textures, samplers and images to the file's root, if there are any.
    void finish(Json& root) const;

private:
    Json primitive(const MeshAsset& asset, const MeshPaint& paint, std::uint32_t material);
    Json material(const MeshMaterial& material, const Appearance& look);
    std::size_t texture(const MeshMaterial& material);
    std::size_t image(const Texture& texture);

    GlbBuffer& buffer_;
    Json textures_ = Json::array(), samplers_ = Json::array(), images_ = Json::array();
    std::map<const Texture*, std::size_t> image_of_;  // only looked up: their order has no effect
    std::map<std::tuple<TextureWrap, TextureWrap, bool>, std::size_t> sampler_of_;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> texture_of_;  // by image and sampler
};

}  // namespace tumble
