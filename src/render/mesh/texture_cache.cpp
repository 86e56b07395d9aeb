#include "render/mesh/texture_cache.h"

namespace tumble {
namespace {

GLint wrap_mode(TextureWrap wrap) {
    return wrap == TextureWrap::clamp ? GL_CLAMP_TO_EDGE : wrap == TextureWrap::mirror ? GL_MIRRORED_REPEAT : GL_REPEAT;
}

}  // namespace

void TextureNames::bind(const GlFunctions& gl) const {
    const auto use = [&](GLuint unit, GLuint name) {
        if (name == 0) return;
        gl.ActiveTexture(GL_TEXTURE0 + unit);
        gl.BindTexture(GL_TEXTURE_2D, name);
    };
    use(paint_unit, color);
    for (std::size_t i = 0; i < maps.size(); ++i) use(map_units[i], maps[i]);
}

TextureNames TextureCache::names_of(const MeshMaterial& material, unsigned maps) {
    const auto one = [&](const SurfaceMaps::Map& map, const Texture& missing) {
        return name_of(map ? *map : missing, material);
    };
    TextureNames names{one(material.texture, white_), {}};
    const SurfaceMaps& of = material.maps;
    if (maps & SurfaceMaps::with_normal) names.maps[0] = one(of.normal, flat_);
    if (maps & SurfaceMaps::with_surface) names.maps[1] = one(of.surface, white_);
    if (maps & SurfaceMaps::with_emission) names.maps[2] = one(of.emission, white_);
    return names;
}

GLuint TextureCache::name_of(const Texture& texture, const MeshMaterial& material) {
    const Key key{&texture, material.wrap_u, material.wrap_v, material.nearest};
    const auto [entry, is_new] = textures_.try_emplace(key, *gl_, GlKind::texture);
    if (is_new) {
        gl_->ActiveTexture(GL_TEXTURE0 + paint_unit);
        gl_->BindTexture(GL_TEXTURE_2D, entry->second.name());
        fill(texture, material);
    }
    return entry->second.name();
}

/// A magnified texture is interpolated linearly; a smaller one has the mip map nearest to its size, which costs half of
/// a mixture of two. The shader chooses the level.
void TextureCache::fill(const Texture& texture, const MeshMaterial& material) const {
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
