// Textures in GPU memory, each once.
#pragma once

#include "render/gl/gl_object.h"
#include "scene/description/mesh_paint.h"

#include <map>
#include <optional>
#include <tuple>

namespace tumble {

class TextureCache {
public:
    explicit TextureCache(const GlFunctions& gl) : gl_(&gl) {}

    /// The OpenGL texture of a material, with its wrapping; of one without a texture a white texel.
    GLuint name_of(const MeshMaterial& material);

private:
    using Key = std::tuple<const Texture*, TextureWrap, TextureWrap, bool>;

    void fill(const MeshMaterial& material) const;

    const GlFunctions* gl_;
    std::map<Key, GlObject> textures_;  // only looked up: the order of addresses has no effect
};

}  // namespace tumble
