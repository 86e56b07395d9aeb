// Depths as the sun sees them: the near and the far map of shadow_fit.h side by side in one texture.
#pragma once

#include "core/rectangle.h"
#include "render/mesh/gpu_mesh_cache.h"
#include "render/gl/shader_program.h"

#include <filesystem>

namespace tumble {

/// Texels across one map. A finer one costs more (1024: +1.3 ms a frame) and looks harder.
inline constexpr int shadow_map_texels = 768;

class ShadowMap {
public:
    ShadowMap(const GlFunctions& gl, const std::filesystem::path& shaders, GLuint frame_block);

    /// Clears these parts of the texture and draws the casters, which must be all that touch them, into the near map and
    /// into the far one when there is one.
    void draw(const GpuMeshCache& meshes, const std::vector<Batch>& casters, const std::vector<Rectangle>& parts,
              bool with_far) const;

    /// Has its shader compiled, as BodyPass::compilations() does.
    void compile(const GpuMeshCache& meshes, const std::vector<Batch>& casters) const;

    GLuint texture() const { return texture_.name(); }

private:
    void attach_depths(const GlObject& framebuffer, const GlObject& texture, int width, int height) const;
    void empty(const std::vector<Rectangle>& parts) const;

    const GlFunctions* gl_;
    ShaderProgram program_;
    GlObject texture_, framebuffer_;
    GlObject empty_texture_, empty_framebuffer_;   // a strip of farthest depths, copied to where a map is drawn anew
};

}  // namespace tumble
