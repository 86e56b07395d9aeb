#include "render/shadow/shadow_map.h"

#include "core/error.h"

#include <algorithm>

namespace tumble {
namespace {

constexpr int farthest_strip_rows =
    64;  // of farthest depths, so that the source of copies stays in the processor's cache

}  // namespace

ShadowMap::ShadowMap(GlDevice& device, const std::filesystem::path& shaders, GLuint frame_block)
    : gl_(&device.gl()),
      program_(device.program(shaders, {"shadow.vert", "", {}})),
      device_(&device),
      shaders_(shaders),
      frame_block_(frame_block),
      texture_(*gl_, GlKind::texture),
      framebuffer_(*gl_, GlKind::framebuffer),
      empty_texture_(*gl_, GlKind::texture),
      empty_framebuffer_(*gl_, GlKind::framebuffer) {
    const GlFunctions& gl = *gl_;
    program_.set_block("Frame", frame_block);
    attach_depths(empty_framebuffer_, empty_texture_, shadow_map_texels, farthest_strip_rows);
    gl.ClearDepth(1.0);
    gl.Clear(GL_DEPTH_BUFFER_BIT);
    attach_depths(framebuffer_, texture_, 2 * shadow_map_texels, shadow_map_texels);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

void ShadowMap::attach_depths(const GlObject& framebuffer, const GlObject& texture, int width, int height) const {
    gl_->BindTexture(GL_TEXTURE_2D, texture.name());
    gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, width, height, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    gl_->FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture.name(), 0);
    gl_->DrawBuffer(GL_NONE);
    gl_->ReadBuffer(GL_NONE);
    if (gl_->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw RunError("the OpenGL driver refuses the shadow map; it may lack memory");
}

void ShadowMap::compile(const GpuMeshCache& meshes, const std::vector<Batch>& casters) const {
    if (casters.empty()) return;
    gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    program_.use();
    Batch one = casters.front();
    one.count = 1;
    meshes.draw(one);
}

const ShadowMap::Sieves& ShadowMap::sieves() const {
    if (sieves_) return *sieves_;
    const auto make = [&](std::vector<std::string> defines) {
        const ShaderProgram& made = device_->program(shaders_, {"shadow.vert", "shadow.frag", std::move(defines)});
        made.set_block("Frame", frame_block_);
        made.set_sampler("mesh_texture", GLint(paint_unit));
        return &made;
    };
    return sieves_.emplace(Sieves{make({"SIEVED"}), make({"SIEVED", "PAINTED"})});
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
        const ShaderProgram* used = nullptr;
        for (const Batch& batch : casters) {
            const bool sieved = (batch.features & surface_feature::sieved) != 0;
            const ShaderProgram* program = !sieved ? &program_ : batch.painted ? sieves().painted : sieves().plain;
            if (program != used) {
                program->use();
                gl_->Uniform1i(program->uniform("far_map"), far);
                used = program;
            }
            meshes.draw(batch);
        }
    }
    gl_->Disable(GL_SCISSOR_TEST);
}

}  // namespace tumble
