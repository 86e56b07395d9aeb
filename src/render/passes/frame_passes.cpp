#include "render/passes/frame_passes.h"

#include "render/gl/shader_compile_schedule.h"
#include "render/gl/uniform_blocks.h"
#include "render/passes/frame_uniforms.h"
#include "render/passes/lamp_uniforms.h"
#include "scene/description/lamps.h"

#include <functional>
#include <limits>
#include <utility>

namespace tumble {

FramePasses::FramePasses(GlDevice& device, const RenderScene& scene, const ShadowFilter& filter,
                         const PassOptions& options)
    : gl_(&device.gl()),
      scene_(&scene),
      framebuffer_(*gl_, options.width, options.height, options.samples),
      uniforms_(*gl_, GlKind::buffer),
      lamp_uniforms_(*gl_, GlKind::buffer),
      meshes_(*gl_, scene),
      occlusion_texture_(*gl_),
      shadow_map_(device, options.shaders),
      environment_(*gl_, scene),
      bodies_(device, options.shaders, scene, filter),
      planes_(device, options.shaders, scene, filter),
      widen_rods_(options.widen_rods),
      plain_background_(options.plain_background),
      schedule_(options.schedule) {
    if (second_shadow(scene.lamps)) lamp_shadow_map_.emplace(device, options.shaders);
    if (scene.water && !plain_background_) water_.emplace(device, options.shaders, scene);
    gl_->FrontFace(GL_CW);  // the frame is drawn upside down (see Camera)
    gl_->Enable(GL_DEPTH_TEST);
    gl_->Enable(GL_DEPTH_CLAMP);  // no clipping at the near plane and at the sun's nearest depth
    gl_->DepthFunc(GL_LEQUAL);
}

void FramePasses::upload(const FrameContext& frame, const DrawList& list, const AmbientOcclusion& occlusion,
                         MeshLods& lods) {
    occlusion_texture_.upload(occlusion.atlas(), occlusion.changes().first_row, occlusion.changes().end_row);
    meshes_.upload(list, lods);
    const FrameUniforms uniforms = make_frame_uniforms(frame, occlusion_texture_.height(), widen_rods_);
    gl_->BindBuffer(GL_UNIFORM_BUFFER, uniforms_.name());
    gl_->BufferData(GL_UNIFORM_BUFFER, sizeof uniforms, &uniforms, GL_STREAM_DRAW);
    gl_->BindBufferBase(GL_UNIFORM_BUFFER, frame_block, uniforms_.name());
    if (scene_->lamps.empty()) return;
    const LampUniforms lamps = make_lamp_uniforms(*scene_, frame.camera, frame.lamp_map);
    gl_->BindBuffer(GL_UNIFORM_BUFFER, lamp_uniforms_.name());
    gl_->BufferData(GL_UNIFORM_BUFFER, sizeof lamps, &lamps, GL_STREAM_DRAW);
    gl_->BindBufferBase(GL_UNIFORM_BUFFER, lamp_block, lamp_uniforms_.name());
}

// Draws with all output masked. The slowest shaders come first: see ShaderCompileSchedule.
void FramePasses::compile_shaders(const DrawList& list) {
    if (schedule_ == nullptr) return;
    bind_textures();
    framebuffer_.begin_whole();
    gl_->Enable(GL_SCISSOR_TEST);
    gl_->Scissor(0, 0, 0, 0);
    std::vector<std::function<void()>> all = bodies_.compilations(meshes_, list.visible);
    if (!plain_background_)
        for (auto& one : planes_.compilations()) all.push_back(std::move(one));
    if (scene_->light.shadows) all.emplace_back([&] { shadow_map_.compile(meshes_, list.casters); });
    std::exchange(schedule_, nullptr)->run(all);
    gl_->Disable(GL_SCISSOR_TEST);
}

void FramePasses::bind_textures() const {
    gl_->ActiveTexture(GL_TEXTURE0 + occlusion_unit);
    gl_->BindTexture(GL_TEXTURE_2D, occlusion_texture_.name());
    gl_->ActiveTexture(GL_TEXTURE0 + shadow_unit);
    gl_->BindTexture(GL_TEXTURE_2D, shadow_map_.texture());
    if (!lamp_shadow_map_) return;
    gl_->ActiveTexture(GL_TEXTURE0 + lamp_shadow_unit);
    gl_->BindTexture(GL_TEXTURE_2D, lamp_shadow_map_->texture());
    gl_->ActiveTexture(GL_TEXTURE0 + shadow_unit);
}

void FramePasses::set_reflection(const Image& image) {
    if (!reflection_) reflection_.emplace(*gl_, GlKind::texture);
    gl_->BindTexture(GL_TEXTURE_2D, reflection_->name());
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width, image.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                    image.pixels.data());
}

void FramePasses::draw_sky(const FrameContext& frame) const {
    if (plain_background_)
        framebuffer_.clear_color(*plain_background_);
    else
        planes_.draw_sky(frame);
}

// While the camera stands still, the background is stored. With a moving camera it is drawn after the bodies.
void FramePasses::begin_frame(const FrameContext& frame, const Damage& damage) {
    background_kept_ = background_kept_ && !damage.background;
    if (frame.camera_moved) {
        framebuffer_.begin_whole();
        draw_sky(frame);
        return;
    }
    if (!background_kept_) {
        framebuffer_.begin_background();
        draw_sky(frame);
        planes_.draw_background(frame);
        background_kept_ = true;
    }
    framebuffer_.begin(damage.changed, damage.previous);
}

void FramePasses::draw(const FrameContext& frame, const Damage& damage, const DrawList& list,
                       const OcclusionAtlas& atlas, PassTimer& timer) {
    compile_shaders(list);
    if (scene_->light.shadows && !damage.shadow_tiles.none())
        shadow_map_.draw(meshes_, list.casters, damage.shadow_tiles.rectangles(), frame.cascades.has_far);
    if (lamp_shadow_map_) lamp_shadow_map_->draw(meshes_, list.lamp_casters);
    timer.ends(Pass::shadow);

    environment_.bind();
    if (reflection_) {
        gl_->ActiveTexture(GL_TEXTURE0 + reflection_unit);
        gl_->BindTexture(GL_TEXTURE_2D, reflection_->name());
        gl_->ActiveTexture(GL_TEXTURE0);
    }
    if (lamp_shadow_map_) bind_textures();  // its shadows are on the stored background too
    begin_frame(frame, damage);
    timer.ends(Pass::background);

    bind_textures();
    if (scene_->cut) gl_->Enable(GL_CLIP_DISTANCE0);
    bodies_.draw(meshes_, list.visible);
    timer.ends(Pass::bodies);

    planes_.draw_regions(frame, damage.plane_regions, atlas);
    timer.ends(Pass::planes);

    if (frame.camera_moved)
        planes_.draw_background(frame);  // last, so that pixels of bodies and their shadows are skipped
    timer.ends(Pass::background);

    bodies_.draw_over(meshes_, list.translucent);
    if (scene_->cut) gl_->Disable(GL_CLIP_DISTANCE0);
    timer.ends(Pass::bodies);

    if (water_) water_->draw(frame, framebuffer_);
    timer.ends(Pass::planes);
}

// Camera::clip_from_relative(): the depth in the buffer is 1 - near / distance.
void FramePasses::read_depths(const std::vector<Rectangle>& rectangles, double near_distance, DepthImage& depths) {
    framebuffer_.read_depths(rectangles, depths);
    for (const Rectangle& r : rectangles)
        for (int y = r.y; y < r.y + r.height; ++y)
            for (float* d = depths.at(r.x, y); d != depths.at(r.x, y) + r.width; ++d)
                *d = *d < 1.0f ? float(near_distance) / (1.0f - *d) : std::numeric_limits<float>::infinity();
}

void FramePasses::read(const std::vector<Rectangle>& rectangles, Image& image) const {
    framebuffer_.resolve(rectangles);
    framebuffer_.read(rectangles, image);
}

}  // namespace tumble
