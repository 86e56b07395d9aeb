#include "render/occlusion_texture.h"

#include <algorithm>

namespace tumble {

OcclusionTexture::OcclusionTexture(const GlFunctions& gl) : gl_(&gl), texture_(gl, GlKind::texture) {
    gl.BindTexture(GL_TEXTURE_2D, texture_.name());
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void OcclusionTexture::upload(const OcclusionAtlas& atlas, int first_row, int end_row) {
    gl_->BindTexture(GL_TEXTURE_2D, texture_.name());
    gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    // A power of two of rows: it grows seldom, and texture coordinates are exact whatever was drawn before.
    int rows = 256;
    while (rows < atlas.height) rows *= 2;
    if (rows > height_) {
        height_ = rows;
        gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_R8, OcclusionAtlas::width, rows, 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
        filled_ = 0;
    }
    if (atlas.height > filled_) {  // rows that are open from the start have not changed, but are new here
        first_row = std::min(first_row, filled_);
        end_row = filled_ = atlas.height;
    }
    if (first_row >= end_row) return;
    gl_->TexSubImage2D(GL_TEXTURE_2D, 0, 0, first_row, OcclusionAtlas::width, end_row - first_row, GL_RED,
                       GL_UNSIGNED_BYTE, &atlas.texels[std::size_t(first_row) * OcclusionAtlas::width]);
}

}  // namespace tumble
