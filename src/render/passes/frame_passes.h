// The passes that draw a frame: shadow maps, background, bodies, planes.
#pragma once

#include "core/image.h"
#include "render/ambient_occlusion/occlusion_texture.h"
#include "render/damage/damage_tracker.h"
#include "render/environment/environment_textures.h"
#include "render/gl/framebuffer.h"
#include "render/mesh/gpu_mesh_cache.h"
#include "render/passes/body_pass.h"
#include "render/passes/pass_timer.h"
#include "render/passes/plane_pass.h"
#include "render/passes/water_pass.h"
#include "render/shadow/lamp_shadow_map.h"
#include "render/shadow/shadow_map.h"

#include <array>
#include <filesystem>
#include <optional>

namespace tumble {

class ShaderCompileSchedule;

struct PassOptions {
    std::filesystem::path shaders;
    int width = 1, height = 1;                                  // pixels
    int samples = 1;                                            // per pixel; the driver may limit them
    bool widen_rods = false;                                    // see make_frame_uniforms()
    std::optional<std::array<float, 4>> plain_background = {};  // color and alpha instead of the sky and the planes
    ShaderCompileSchedule* schedule = nullptr;                  // or null
};

class FramePasses {
public:
    /// `device` and `scene` must outlive it.
    FramePasses(GlDevice& device, const RenderScene& scene, const ShadowFilter& filter, const PassOptions& options);

    bool one_sample() const { return framebuffer_.samples() <= 1; }
    bool plain_background() const { return plain_background_.has_value(); }

    /// Sends the data of the frame to the GPU.
    void upload(const FrameContext& frame, const DrawList& list, const AmbientOcclusion& occlusion, MeshLods& lods);

    /// The shaders are compiled before the first frame.
    void draw(const FrameContext& frame, const Damage& damage, const DrawList& list, const OcclusionAtlas& atlas,
              PassTimer& timer);

    /// Mirrored bodies for the plane that shows them, from right to left, with straight alpha.
    void set_reflection(const Image& image);

    /// Reads the rectangles as drawn: with surface ids in alpha.
    void read(const std::vector<Rectangle>& rectangles, Image& image) const;

    /// Reads the depths of the rectangles, which were drawn with this near distance (m).
    void read_depths(const std::vector<Rectangle>& rectangles, double near_distance, DepthImage& depths);

private:
    void compile_shaders(const DrawList& list);
    void bind_textures() const;
    void draw_sky(const FrameContext& frame) const;
    void begin_frame(const FrameContext& frame, const Damage& damage);

    const GlFunctions* gl_;
    const RenderScene* scene_;
    Framebuffer framebuffer_;
    GlObject uniforms_, lamp_uniforms_;
    GpuMeshCache meshes_;
    OcclusionTexture occlusion_texture_;
    ShadowMap shadow_map_;
    std::optional<LampShadowMap> lamp_shadow_map_;
    EnvironmentTextures environment_;
    std::optional<GlObject> reflection_;
    BodyPass bodies_;
    PlanePass planes_;
    std::optional<WaterPass> water_;
    bool widen_rods_;
    std::optional<std::array<float, 4>> plain_background_;
    bool background_kept_ = false;     // the stored background is that of this camera
    ShaderCompileSchedule* schedule_;  // until the shaders are compiled
};

}  // namespace tumble
