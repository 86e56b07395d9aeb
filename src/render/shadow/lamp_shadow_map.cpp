#include "render/shadow/lamp_shadow_map.h"

#include "render/shadow/lamp_map.h"
#include "render/shadow/shadow_map.h"

namespace tumble {

LampShadowMap::LampShadowMap(GlDevice& device, const std::filesystem::path& shaders)
    : gl_(&device.gl()),
      programs_(device, shaders, {"LAMP_MAP"}),
      texture_(*gl_, GlKind::texture),
      framebuffer_(*gl_, GlKind::framebuffer) {
    attach_depths(*gl_, framebuffer_, texture_, lamp_map_texels, lamp_map_texels);
    compare_depths(*gl_);
}

void LampShadowMap::draw(const GpuMeshCache& meshes, const std::vector<Batch>& casters) const {
    gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    gl_->Viewport(0, 0, lamp_map_texels, lamp_map_texels);
    gl_->ClearDepth(1.0);
    gl_->Clear(GL_DEPTH_BUFFER_BIT);
    programs_.draw(meshes, casters, 0);
}

}  // namespace tumble
