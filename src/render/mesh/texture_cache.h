// Textures in GPU memory, each once.
#pragma once

#include "render/gl/gl_object.h"
#include "scene/description/mesh_paint.h"

#include <array>
#include <map>
#include <tuple>

namespace tumble {

/// Texture units: of colors, and of the maps in the order of the bits of SurfaceMaps.
inline constexpr GLuint paint_unit = 2;
inline constexpr std::array<GLuint, 3> map_units{5, 6, 7};

/// The OpenGL textures of a material; 0: none.
struct TextureNames {
    GLuint color = 0;
    std::array<GLuint, 3> maps{};

    void bind(const GlFunctions& gl) const;
};

class TextureCache {
public:
    explicit TextureCache(const GlFunctions& gl) : gl_(&gl) {}

    /// The textures of a material, with its wrapping: the color, of one without a texture a white texel, and the maps
    /// of these bits, of which missing ones have a texel without effect.
    TextureNames names_of(const MeshMaterial& material, unsigned maps);

private:
    using Key = std::tuple<const Texture*, TextureWrap, TextureWrap, bool>;

    GLuint name_of(const Texture& texture, const MeshMaterial& material);
    void fill(const Texture& texture, const MeshMaterial& material) const;

    const GlFunctions* gl_;
    Texture white_{{{1, 1, {{255, 255, 255, 255}}}}, 255}, flat_{{{1, 1, {{128, 128, 255, 255}}}}, 255};
    std::map<Key, GlObject> textures_;  // only looked up: the order of addresses has no effect
};

}  // namespace tumble
