// Draws the infinite planes, and the sky where no plane is.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/damage/plane_dirty_regions.h"
#include "render/gl/gl_object.h"
#include "render/gl/shader_program.h"

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

class PlanePass {
public:
    PlanePass(const GlFunctions& gl, const std::filesystem::path& shaders, const RenderScene& scene, bool shadows,
              const ShadowFilter& filter);

    /// Draws the sky outside the planes. Call it first: at the horizon, the depth of a plane rounds to that of the sky.
    void draw_sky(const std::vector<PlanePatch>& planes, const Camera& view) const;

    /// Draws all planes without shadows and occlusion by bodies, where no surface at the same or a smaller depth has
    /// been drawn. Bodies and dirty regions may be drawn before or after.
    void draw_background(const std::vector<PlanePatch>& planes, const RenderScene& scene) const;

    /// Draws planes[i] in regions[i], with shadows and occlusion.
    void draw_regions(const std::vector<PlanePatch>& planes, const std::vector<std::vector<Rectangle>>& regions,
                      const RenderScene& scene, const OcclusionAtlas& atlas, const Snapshot& snapshot,
                      const Camera& view, bool far_shadows);

    /// One draw per shader, which makes the driver compile it. The caller must prevent it from changing the frame.
    std::vector<std::function<void()>> compilations() const;

private:
    struct Programs {
        ShaderProgram background, occluded;
        std::optional<ShaderProgram> occluded_far;  // once the far shadow map is in use
    };
    ShaderProgram make(Pattern pattern, const std::vector<std::string>& more) const;
    std::vector<std::string> occluded() const;
    void set_uniforms(const ShaderProgram& program, const PlanePatch& plane, const std::vector<PlanePatch>& planes,
                      const RenderScene& scene) const;
    void set_tile(const ShaderProgram& program, const PlanePatch& plane, const OcclusionAtlas& atlas,
                  const RenderScene& scene, const Snapshot& snapshot, const Camera& view) const;
    void upload_polygon(const std::vector<glm::vec3>& corners) const;
    void draw_polygon(const std::vector<glm::vec3>& corners) const;

    const GlFunctions* gl_;
    std::filesystem::path shaders_;
    bool shadows_;
    ShadowFilter filter_;
    std::array<std::optional<Programs>, 3> planes_;  // by pattern, as far as the scene uses it
    int other_planes_;
    ShaderProgram sky_;
    GlObject array_, corners_;
};

}  // namespace tumble
