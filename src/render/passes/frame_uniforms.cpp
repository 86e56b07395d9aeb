#include "render/passes/frame_uniforms.h"

#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/antialiasing/thin_geometry_aa.h"
#include "render/gl/glm_conversion.h"

namespace tumble {
FrameUniforms make_frame_uniforms(const FrameContext& frame, int atlas_height, bool widen_rods) {
    const Camera& view = frame.camera;
    const LightDescription& light = frame.scene.light;
    const ShadowCascades& shadows = frame.cascades;
    FrameUniforms u{};
    u.clip_from_relative = view.clip_from_relative(frame.near_distance);
    u.ray_origin = to_glm(view.ray(0.0, 0.0), 0.0);
    u.ray_dx = to_glm(view.ray(1.0, 0.0) - view.ray(0.0, 0.0), 0.0);
    u.ray_dy = to_glm(view.ray(0.0, 1.0) - view.ray(0.0, 0.0), 0.0);
    // the zero vector gives a cosine of 0: no sunlight
    u.to_light =
        frame.scene.sun_up ? to_glm(-light.direction.normalized(), light.shadows ? 1.0 : 0.0) : glm::vec4(0.0f);
    u.shadow_x = shadows.x;
    u.shadow_y = shadows.y;
    u.shadow_z = shadows.z;
    u.shadow_far = shadows.far;
    u.shadow_texels = glm::vec4(float(shadows.near_texel), float(shadows.far_texel), float(shadows.filter.lift),
                                float(shadows.filter.offset));
    u.fog_density = float(1.0 / (view.fog_distance() * view.fog_distance()));
    u.pixel_size = float(view.pixel_size());
    if (widen_rods) {
        u.widest_rod = float(widest_rod_pixels * view.pixel_size());
        u.thinnest_rod = float(thinnest_rod_pixels * view.pixel_size());
    }
    u.atlas = glm::vec4(1.0f / float(OcclusionAtlas::width), 1.0f / float(atlas_height),
                        frame.scene.cut ? float(*frame.scene.cut - view.eye().y()) : 0.0f, 0.0f);
    return u;
}

}  // namespace tumble
