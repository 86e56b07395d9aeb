// Depths as seen from the sun: the near and the far map of shadow_cascades.h side by side in one texture.
#pragma once

#include "core/image.h"
#include "render/gl/gl_device.h"
#include "render/gl/gl_object.h"
#include "render/mesh/gpu_mesh_cache.h"
#include "render/shadow/shadow_cascades.h"

#include <filesystem>
#include <optional>

namespace tumble {

class ShadowMap {
public:
    ShadowMap(GlDevice& device, const std::filesystem::path& shaders, GLuint frame_block);

    /// Clears these parts of the texture and draws the casters, which must be all that touch them, into the near map
    /// and the far one, if there is one.
    void draw(const GpuMeshCache& meshes, const std::vector<Batch>& casters, const std::vector<Rectangle>& parts,
              bool with_far) const;

    /// Makes the driver compile its shader, as BodyPass::compilations() does.
    void compile(const GpuMeshCache& meshes, const std::vector<Batch>& casters) const;

    GLuint texture() const { return texture_.name(); }

private:
    void attach_depths(const GlObject& framebuffer, const GlObject& texture, int width, int height) const;
    void empty(const std::vector<Rectangle>& parts) const;

    const GlFunctions* gl_;
    const ShaderProgram& program_;
    struct Sieves {
        const ShaderProgram *plain, *painted;
    };
    const Sieves& sieves() const;

    GlDevice* device_;
    std::filesystem::path shaders_;
    GLuint frame_block_;
    mutable std::optional<Sieves> sieves_;  // of casters that light passes in part; made at their first use
    GlObject texture_, framebuffer_;
    GlObject empty_texture_,
        empty_framebuffer_;  // a strip of farthest depths, copied over the parts of a map to redraw
};

}  // namespace tumble
