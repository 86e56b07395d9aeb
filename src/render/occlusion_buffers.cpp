#include "render/occlusion_buffers.h"

namespace tumble {

OcclusionBuffers::OcclusionBuffers(const GlFunctions& gl)
    : gl_(&gl), occluders_(gl, GlKind::buffer), cells_(gl, GlKind::buffer), occluders_texture_(gl, GlKind::texture),
      cells_texture_(gl, GlKind::texture) {
    gl.BindBuffer(GL_TEXTURE_BUFFER, occluders_.name());   // a name becomes a buffer when first bound
    gl.BindTexture(GL_TEXTURE_BUFFER, occluders_texture_.name());
    gl.TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, occluders_.name());
    gl.BindBuffer(GL_TEXTURE_BUFFER, cells_.name());
    gl.BindTexture(GL_TEXTURE_BUFFER, cells_texture_.name());
    gl.TexBuffer(GL_TEXTURE_BUFFER, GL_R32I, cells_.name());
}

void OcclusionBuffers::upload(const OccluderGrid& grid) const {
    const Occluder none{};   // an empty buffer cannot be a texture
    gl_->BindBuffer(GL_TEXTURE_BUFFER, occluders_.name());
    gl_->BufferData(GL_TEXTURE_BUFFER, GLsizeiptr(std::max<std::size_t>(1, grid.occluders.size()) * sizeof(Occluder)),
                    grid.occluders.empty() ? &none : grid.occluders.data(), GL_STREAM_DRAW);
    gl_->BindBuffer(GL_TEXTURE_BUFFER, cells_.name());
    gl_->BufferData(GL_TEXTURE_BUFFER, GLsizeiptr(grid.cells.size() * sizeof(std::int32_t)), grid.cells.data(),
                    GL_STREAM_DRAW);
}

void OcclusionBuffers::bind(GLuint occluders_unit, GLuint cells_unit) const {
    gl_->ActiveTexture(GL_TEXTURE0 + occluders_unit);
    gl_->BindTexture(GL_TEXTURE_BUFFER, occluders_texture_.name());
    gl_->ActiveTexture(GL_TEXTURE0 + cells_unit);
    gl_->BindTexture(GL_TEXTURE_BUFFER, cells_texture_.name());
}

}  // namespace tumble
