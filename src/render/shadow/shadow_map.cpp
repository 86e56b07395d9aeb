#include "render/shadow/shadow_map.h"

#include "core/error.h"

#include <algorithm>

namespace tumble {
namespace {

constexpr int farthest_strip_rows =
    64;  // of farthest depths, so that the source of copies stays in the processor's cache

}  // namespace

void attach_depths(const GlFunctions& gl, const GlObject& framebuffer, const GlObject& texture, int width, int height) {
    gl.BindTexture(GL_TEXTURE_2D, texture.name());
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture.name(), 0);
    gl.DrawBuffer(GL_NONE);
    gl.ReadBuffer(GL_NONE);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw RunError("the OpenGL driver refuses the shadow map; it may lack memory");
}

void compare_depths(const GlFunctions& gl) {
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

ShadowMap::ShadowMap(GlDevice& device, const std::filesystem::path& shaders)
    : gl_(&device.gl()),
      programs_(device, shaders, {}),
      texture_(*gl_, GlKind::texture),
      framebuffer_(*gl_, GlKind::framebuffer),
      empty_texture_(*gl_, GlKind::texture),
      empty_framebuffer_(*gl_, GlKind::framebuffer) {
    const GlFunctions& gl = *gl_;
    attach_depths(gl, empty_framebuffer_, empty_texture_, shadow_map_texels, farthest_strip_rows);
    gl.ClearDepth(1.0);
    gl.Clear(GL_DEPTH_BUFFER_BIT);
    attach_depths(gl, framebuffer_, texture_, 2 * shadow_map_texels, shadow_map_texels);
    compare_depths(gl);
}

void ShadowMap::compile(const GpuMeshCache& meshes, const std::vector<Batch>& casters) const {
    if (casters.empty()) return;
    gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    programs_.solid().use();
    Batch one = casters.front();
    one.count = 1;
    meshes.draw(one);
}

// llvmpipe clears a part of a target by drawing it, at six times the cost of a copy.
void ShadowMap::empty(const std::vector<Rectangle>& parts) const {
    gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, empty_framebuffer_.name());
    gl_->BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
    for (const Rectangle& p : parts) {
        const int x = p.x % shadow_map_texels;  // no part is in both maps
        for (int y = p.y; y < p.y + p.height; y += farthest_strip_rows) {
            const int rows = std::min(farthest_strip_rows, p.y + p.height - y);
            gl_->BlitFramebuffer(x, 0, x + p.width, rows, p.x, y, p.x + p.width, y + rows, GL_DEPTH_BUFFER_BIT,
                                 GL_NEAREST);
        }
    }
}

void ShadowMap::draw(const GpuMeshCache& meshes, const std::vector<Batch>& casters, const std::vector<Rectangle>& parts,
                     bool with_far) const {
    empty(parts);
    gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    gl_->Enable(GL_SCISSOR_TEST);
    for (int far = 0; far <= (with_far ? 1 : 0); ++far) {
        gl_->Viewport(far * shadow_map_texels, 0, shadow_map_texels, shadow_map_texels);
        gl_->Scissor(far * shadow_map_texels, 0, shadow_map_texels, shadow_map_texels);
        programs_.draw(meshes, casters, far);
    }
    gl_->Disable(GL_SCISSOR_TEST);
}

}  // namespace tumble
