#include "render/mesh/texture_cache.h"

namespace tumble {
namespace {

GLint wrap_mode(TextureWrap wrap) {
    return wrap == TextureWrap::clamp ? GL_CLAMP_TO_EDGE : wrap == TextureWrap::mirror ? GL_MIRRORED_REPEAT : GL_REPEAT;
}

}  // namespace

GLuint TextureCache::name_of(const MeshMaterial& material) {
    const Key key{material.texture.get(), material.wrap_u, material.wrap_v, material.nearest};
    const auto [entry, is_new] = textures_.try_emplace(key, *gl_, GlKind::texture);
    gl_->BindTexture(GL_TEXTURE_2D, entry->second.name());
    if (is_new) fill(material);
    return entry->second.name();
}

/// A magnified texture is interpolated linearly; a smaller one has the mip map nearest to its size, which costs half of
/// a mixture of two. The shader chooses the level.
void TextureCache::fill(const MeshMaterial& material) const {
    const Texture white{{{1, 1, {{255, 255, 255, 255}}}}, 255};
    const Texture& texture = material.texture ? *material.texture : white;
    const auto set = [&](GLenum parameter, GLint value) { gl_->TexParameteri(GL_TEXTURE_2D, parameter, value); };
    set(GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    set(GL_TEXTURE_MAG_FILTER, material.nearest ? GL_NEAREST : GL_LINEAR);
    set(GL_TEXTURE_WRAP_S, wrap_mode(material.wrap_u));
    set(GL_TEXTURE_WRAP_T, wrap_mode(material.wrap_v));
    set(GL_TEXTURE_MAX_LEVEL, GLint(texture.levels.size()) - 1);
    for (std::size_t level = 0; level < texture.levels.size(); ++level) {
        const Texture::Level& image = texture.levels[level];
        gl_->TexImage2D(GL_TEXTURE_2D, GLint(level), GL_RGBA8, image.width, image.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                        image.texels.data());
    }
}

}  // namespace tumble
