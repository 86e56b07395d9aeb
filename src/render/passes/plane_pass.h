// Draws the infinite planes, and the sky where no plane is.
#pragma once

#include "core/image.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/frame/frame_context.h"
#include "render/gl/gl_device.h"
#include "render/gl/gl_object.h"
#include "render/mesh/texture_cache.h"

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

class PlanePass {
public:
    PlanePass(GlDevice& device, const std::filesystem::path& shaders, const RenderScene& scene,
              const ShadowFilter& filter);

    /// Draws the sky outside the planes. Call it first: at the horizon, the depth of a plane rounds to that of the sky.
    void draw_sky(const FrameContext& frame) const;

    /// Draws all planes without shadows and occlusion by bodies, where no surface at the same or a smaller depth has
    /// been drawn. Bodies and regions may be drawn before or after.
    void draw_background(const FrameContext& frame) const;

    /// Draws the i-th plane of the frame in regions[i], with shadows and occlusion.
    void draw_regions(const FrameContext& frame, const std::vector<std::vector<Rectangle>>& regions,
                      const OcclusionAtlas& atlas);

    /// One draw per shader, which makes the driver compile it. The caller must prevent it from changing the frame.
    std::vector<std::function<void()>> compilations() const;

private:
    struct Programs {
        const ShaderProgram *background, *occluded;
        const ShaderProgram* occluded_far;  // null until the far shadow map is in use
    };
    static std::size_t index_of(const RenderBody& proxy);
    const ShaderProgram* make(const RenderBody& proxy, const std::vector<std::string>& more) const;
    std::vector<std::string> occluded(const RenderBody& proxy) const;
    void set_uniforms(const ShaderProgram& program, const PlanePatch& plane, const FrameContext& frame) const;
    void set_tile(const ShaderProgram& program, const PlanePatch& plane, const OcclusionAtlas& atlas,
                  const FrameContext& frame) const;
    void upload_polygon(const std::vector<glm::vec3>& corners) const;
    void draw_polygon(const std::vector<glm::vec3>& corners) const;

    GlDevice* device_;
    const GlFunctions* gl_;
    std::filesystem::path shaders_;
    bool shadows_;
    ShadowFilter filter_;
    int other_planes_;
    const ShaderProgram& sky_;
    std::vector<std::optional<Programs>> planes_;  // by pattern and look, as far as the scene uses it
    std::vector<SurfaceLook> looks_;
    std::vector<std::string> scene_defines_;
    mutable TextureCache textures_;
    GlObject array_, corners_;
};

}  // namespace tumble
