// Depths as seen from the sun: the near and the far map of shadow_cascades.h side by side in one texture.
#pragma once

#include "core/image.h"
#include "render/gl/gl_device.h"
#include "render/gl/gl_object.h"
#include "render/mesh/gpu_mesh_cache.h"
#include "render/shadow/caster_programs.h"
#include "render/shadow/shadow_cascades.h"

#include <filesystem>

namespace tumble {

/// Makes a texture of depths, bound from then on, and draws into it. Throws RunError.
void attach_depths(const GlFunctions& gl, const GlObject& framebuffer, const GlObject& texture, int width, int height);
/// Lookups in the bound texture compare.
void compare_depths(const GlFunctions& gl);

class ShadowMap {
public:
    ShadowMap(GlDevice& device, const std::filesystem::path& shaders);

    /// Clears these parts of the texture and draws the casters, which must be all that touch them, into the near map
    /// and the far one, if there is one.
    void draw(const GpuMeshCache& meshes, const std::vector<Batch>& casters, const std::vector<Rectangle>& parts,
              bool with_far) const;

    /// Makes the driver compile its shader, as BodyPass::compilations() does.
    void compile(const GpuMeshCache& meshes, const std::vector<Batch>& casters) const;

    GLuint texture() const { return texture_.name(); }

private:
    void empty(const std::vector<Rectangle>& parts) const;

    const GlFunctions* gl_;
    CasterPrograms programs_;
    GlObject texture_, framebuffer_;
    GlObject empty_texture_,
        empty_framebuffer_;  // a strip of farthest depths, copied over the parts of a map to redraw
};

}  // namespace tumble
