#include "render/shadow_map.h"

#include "core/error.h"

namespace tumble {

ShadowMap::ShadowMap(const GlFunctions& gl, const std::filesystem::path& shaders, GLuint frame_block)
    : gl_(&gl),
      program_(gl, shaders, {"shadow.vert", "", {}}),
      texture_(gl, GlKind::texture),
      framebuffer_(gl, GlKind::framebuffer) {
    program_.set_block("Frame", frame_block);
    gl.BindTexture(GL_TEXTURE_2D, texture_.name());
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, 2 * shadow_map_texels, shadow_map_texels, 0,
                  GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture_.name(), 0);
    gl.DrawBuffer(GL_NONE);
    gl.ReadBuffer(GL_NONE);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw RunError("the OpenGL driver refuses a shadow map");
}

void ShadowMap::compile(const MeshLibrary& meshes, const std::vector<Batch>& casters) const {
    if (casters.empty()) return;
    gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    program_.use();
    Batch one = casters.front();
    one.count = 1;
    meshes.draw(one);
}

void ShadowMap::draw(const MeshLibrary& meshes, const std::vector<Batch>& casters, const std::vector<Rectangle>& parts,
                     bool with_far) const {
    gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    gl_->Enable(GL_SCISSOR_TEST);
    gl_->ClearDepth(1.0);
    for (const Rectangle& part : parts) {
        gl_->Scissor(part.x, part.y, part.width, part.height);
        gl_->Clear(GL_DEPTH_BUFFER_BIT);
    }
    program_.use();
    for (int far = 0; far <= (with_far ? 1 : 0); ++far) {
        gl_->Viewport(far * shadow_map_texels, 0, shadow_map_texels, shadow_map_texels);
        gl_->Scissor(far * shadow_map_texels, 0, shadow_map_texels, shadow_map_texels);
        gl_->Uniform1i(program_.uniform("far_map"), far);
        for (const Batch& batch : casters) meshes.draw(batch);
    }
    gl_->Disable(GL_SCISSOR_TEST);
}

}  // namespace tumble
