#include "render/ambient_occlusion/occlusion_texture.h"

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
    // A power of two, so that it grows seldom and texture coordinates are exact independent of earlier frames.
    int rows = 256;
    while (rows < atlas.height) rows *= 2;
    if (rows > height_) {
        height_ = rows;
        // Floats: llvmpipe gathers 32 bits for eight pixels at once, but single bytes one by one (1.4 ms a frame more).
        gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, OcclusionAtlas::width, rows, 0, GL_RED, GL_FLOAT, nullptr);
        filled_ = 0;
    }
    if (atlas.height > filled_) {  // unoccluded rows have not changed, but are new in the texture
        first_row = std::min(first_row, filled_);
        end_row = filled_ = atlas.height;
    }
    // The bodies' tiles fill their rows; below them only plane tiles are read.
    int first_plane_row = atlas.height, columns = 0;
    for (const PlaneOcclusionTile& tile : atlas.plane_tiles) {
        first_plane_row = std::min(first_plane_row, tile.y);
        columns = std::max(columns, tile.x + tile.width);
    }
    if (columns > columns_) {  // unoccluded columns have not changed, but are new in the texture
        first_row = std::min(first_row, first_plane_row);
        end_row = std::max(end_row, atlas.height);
        columns_ = columns;
    }
    send(atlas, first_row, std::min(end_row, first_plane_row), OcclusionAtlas::width);
    send(atlas, std::max(first_row, first_plane_row), end_row, columns_);  // all columns that a plane tile may read
}

void OcclusionTexture::send(const OcclusionAtlas& atlas, int first_row, int end_row, int columns) {
    if (first_row >= end_row || columns == 0) return;
    shares_.resize(std::size_t(end_row - first_row) * std::size_t(columns));
    float* to = shares_.data();
    for (int row = first_row; row < end_row; ++row) {
        const std::uint8_t* from = &atlas.texels[std::size_t(row) * OcclusionAtlas::width];
        for (int column = 0; column < columns; ++column) *to++ = float(from[column]) / 255.0f;
    }
    gl_->TexSubImage2D(GL_TEXTURE_2D, 0, 0, first_row, columns, end_row - first_row, GL_RED, GL_FLOAT, shares_.data());
}

}  // namespace tumble
