// The sequence of a frame; each step has a file of its own.
#include "render/renderer.h"
#include "render/render_scene_builder.h"

#include "core/check.h"
#include "core/error.h"
#include "render/ambient_occlusion/occlusion_texture.h"
#include "render/antialiasing/analytic_aa.h"
#include "render/antialiasing/thin_geometry_aa.h"
#include "render/camera/camera.h"
#include "render/camera/camera_animation.h"
#include "render/damage/damage_tracker.h"
#include "render/gl/framebuffer.h"
#include "render/gl/gl_context.h"
#include "render/gl/shader_compile_schedule.h"
#include "render/gl/shader_locator.h"
#include "render/mesh/gpu_mesh_cache.h"
#include "render/passes/body_pass.h"
#include "render/passes/draw_list.h"
#include "render/passes/frame_uniforms.h"
#include "render/passes/pass_timer.h"
#include "render/passes/plane_pass.h"
#include "render/scene/compound_expansion.h"
#include "render/scene/fog_distance.h"
#include "render/scene/near_plane.h"
#include "render/shadow/caster_culling.h"
#include "render/shadow/shadow_map.h"

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace tumble {
namespace {

// A string of the driver; null would mean that no context is current.
std::string driver_string(const GlFunctions& gl, GLenum name) {
    const GLubyte* text = gl.GetString(name);
    return text != nullptr ? reinterpret_cast<const char*>(text) : "unknown";
}

Camera first_view(const SceneDescription& description, const RenderScene& scene, const RenderOptions& options) {
    const double viewing = viewing_distance(description, scene);
    return Camera(description.camera, description.output.width, description.output.height,
                  {options.shift_x, options.shift_y})
        .with_distances(viewing, fog_distance(description, scene, viewing));
}

}  // namespace

struct Renderer::State {
    State(const SceneDescription& given, const RenderOptions& options, const std::filesystem::path& shaders)
        : drawn(given),
          description(drawn.scene()),
          scene(make_render_scene(description)),
          sun_up(sun_is_up(description)),
          path(description.camera),
          camera(description.camera),
          view(first_view(description, scene, options)),
          stage(description, scene, view, shadow_map_texels),
          occlusion(scene, view.eye()),
          changes(description, scene, view),
          previous_dirty(view),
          details(scene),
          edges(scene, view, details),
          image(description.output.width, description.output.height),
          drawn_image(description.output.width, description.output.height),
          context(make_gl_context(options.backend)),
          gl(load_gl_functions([this](const char* name) { return context->get_proc_address(name); })),
          smooth_edges(description.output.samples > 1 && description.cords.empty() && !options.multisample),
          framebuffer(gl, description.output.width, description.output.height,
                      smooth_edges ? 1 : description.output.samples),
          uniforms(gl, GlKind::buffer),
          meshes(gl, scene),
          occlusion_texture(gl),
          shadow_map(gl, shaders, frame_block),
          programs(gl, shaders, scene, !description.cords.empty(), description.light.shadows, stage.filter()),
          planes(gl, shaders, scene, description.light.shadows, stage.filter()),
          full_redraw(options.full_redraw),
          draw_hidden(options.draw_hidden),
          times(options.times),
          compile_schedule(options.compile_schedule) {
        drawn.forget_bodies();
        gl.FrontFace(GL_CW);  // the frame is drawn upside down (see Camera)
        gl.Enable(GL_DEPTH_TEST);
        gl.Enable(GL_DEPTH_CLAMP);  // no clipping at the near plane and at the sun's nearest depth
        gl.DepthFunc(GL_LEQUAL);
    }

    // The context of another renderer may be current; objects must be deleted in this one.
    ~State() {
        try {
            context->make_current();
        } catch (const RunError&) {
        }
    }

    // Returns false if the camera has not moved.
    bool move_camera(const Snapshot& snapshot) {
        CameraDescription now = path.at(snapshot);
        if (same_place(now, camera)) return false;
        camera = std::move(now);
        view = view.from(camera);
        changes.forget();
        return true;
    }

    // Draws with all output masked. The slowest shaders come first: see ShaderCompileSchedule.
    void compile_shaders(const DrawList& list) {
        if (compile_schedule == nullptr) return;
        bind_textures();
        framebuffer.begin_whole();
        gl.Enable(GL_SCISSOR_TEST);
        gl.Scissor(0, 0, 0, 0);
        std::vector<std::function<void()>> all = programs.compilations(meshes, list.visible);
        for (auto& one : planes.compilations()) all.push_back(std::move(one));
        if (description.light.shadows) all.emplace_back([&] { shadow_map.compile(meshes, list.casters); });
        std::exchange(compile_schedule, nullptr)->run(all);
        gl.Disable(GL_SCISSOR_TEST);
    }

    void bind_textures() const {
        gl.ActiveTexture(GL_TEXTURE0 + occlusion_unit);
        gl.BindTexture(GL_TEXTURE_2D, occlusion_texture.name());
        gl.ActiveTexture(GL_TEXTURE0 + shadow_unit);
        gl.BindTexture(GL_TEXTURE_2D, shadow_map.texture());
    }

    // Call before drawing bodies. While the camera stands still, the background is stored.
    void begin_picture(const std::vector<PlanePatch>& patches, bool camera_moved) {
        background_kept = background_kept && !changes.background_changed();
        if (camera_moved) {
            framebuffer.begin_whole();
            planes.draw_sky(patches, view);
            return;
        }
        if (!background_kept) {
            framebuffer.begin_background();
            planes.draw_sky(patches, view);
            planes.draw_background(patches, scene);
            background_kept = true;
        }
        framebuffer.begin(changed, previous_damage);
    }

    CompoundExpansion drawn;
    const SceneDescription& description;
    RenderScene scene;
    bool sun_up;
    CameraAnimation path;
    CameraDescription camera;  // of the previous frame
    Camera view;
    CascadeFitter stage;
    AmbientOcclusion occlusion;
    DamageTracker changes;
    DirtyTiles previous_dirty;
    MeshLods details;
    EdgeFinder edges;
    Image image;         // the result
    bool whole = false;  // `image` shows the previous frame; false before the first one and after an exception
    Image drawn_image;   // as drawn, with surface ids in alpha
    std::unique_ptr<GlContext> context;
    GlFunctions gl;
    // False in scenes with cords, which can be thinner than a pixel and need several samples.
    bool smooth_edges;
    Framebuffer framebuffer;
    GlObject uniforms;
    GpuMeshCache meshes;
    OcclusionTexture occlusion_texture;
    ShadowMap shadow_map;
    BodyPass programs;
    PlanePass planes;
    bool background_kept = false;
    std::vector<Rectangle> changed,
        previous_damage;  // redrawn regions; regions drawn in the previous frame and not in this one
    bool full_redraw, draw_hidden;
    PassTimes* times;
    ShaderCompileSchedule* compile_schedule;  // until its shaders are compiled
};

Renderer::Renderer(const SceneDescription& description, const RenderOptions& options) {
    const std::filesystem::path shaders = options.shader_folder.empty() ? find_shader_folder() : options.shader_folder;
    state_ = std::make_unique<State>(description, options, shaders);
}

Renderer::~Renderer() = default;

const Image& Renderer::render(const Snapshot& whole) {
    State& s = *state_;
    s.context->make_current();  // another renderer may have been used in this thread
    PassTimer clock(s.gl, s.times);
    const Snapshot& snapshot = s.drawn.snapshot(whole);
    const bool camera_moved = s.move_camera(whole);
    if (!std::exchange(s.whole, false)) s.changes.forget();
    if (!s.full_redraw && s.changes.unmoved(snapshot)) {
        s.changed.clear();
        s.whole = true;
        return s.image;
    }
    FrameState state{snapshot,
                     make_drawn_items(s.description, s.scene, snapshot, s.view),
                     near_distance_for(s.scene, snapshot, s.view),
                     s.stage.fit(s.scene, snapshot, s.view, s.path.carried(whole)),
                     {},
                     s.framebuffer.samples() <= 1};
    state.planes = make_plane_patches(s.scene, snapshot, s.view, state.near_distance);
    const std::vector<PlanePatch>& planes = state.planes;
    const std::vector<DrawableBounds>& items = state.items;
    const double near_distance = state.near_distance;
    const ShadowCascades& shadows = state.shadows;
    const Visibility seen = find_visible(s.scene, snapshot, s.view, s.framebuffer.samples() <= 1);
    std::optional<Visibility> everything;
    const Visibility& visibility = s.draw_hidden ? everything.emplace(everything_visible(s.scene, s.view)) : seen;
    // Of visible bodies only: the place of a tile in the atlas may change the last digit of a color.
    const OcclusionChanges& occlusion = s.occlusion.update(snapshot, s.view, seen);
    DirtyTiles dirty = s.changes.find(state, occlusion, visibility);
    if (s.full_redraw) dirty.mark_all();
    s.changed = dirty.rectangles();
    s.previous_damage = s.previous_dirty.rectangles_outside(dirty);
    s.previous_dirty = dirty;

    ShadowDirtyTiles shadow_damage = s.changes.shadow_damage();
    if (s.full_redraw) shadow_damage.mark_all();
    const bool all_shadows = shadow_damage.all();
    const Vec3 light = s.description.light.direction.normalized();
    std::vector<char> draw_mask, caster_mask;
    for (const DrawableBounds& item : items) {
        draw_mask.push_back(item.exists() && (dirty.all() || dirty.touched_by(item.corners())) ? 1 : 0);
        caster_mask.push_back(item.exists() && (all_shadows || shadow_damage.touched_by(item)) &&
                                      s.view.sees_swept(item.center, item.radius, light)
                                  ? 1
                                  : 0);
    }
    if (s.description.light.shadows && !s.draw_hidden) drop_hidden_casters(s.scene, items, shadows, caster_mask);
    const OcclusionAtlas& atlas = s.occlusion.atlas();
    const DrawList list =
        make_draw_list(s.description, s.scene, snapshot, s.view, visibility, atlas, shadows, draw_mask, caster_mask);
    std::vector<std::vector<Rectangle>> occluded;
    for (const PlanePatch& plane : planes)
        occluded.push_back(find_dirty_regions(plane, s.description, s.scene, items, s.view, shadows, visibility.cover,
                                              atlas, snapshot, dirty));
    clock.ends(Pass::preparation);

    s.occlusion_texture.upload(atlas, occlusion.first_row, occlusion.end_row);
    s.meshes.upload(list, s.details);
    const FrameUniforms uniforms = make_frame_uniforms(s.description.light, s.sun_up, s.view, near_distance, shadows,
                                                       s.occlusion_texture.height(), s.smooth_edges);
    s.gl.BindBuffer(GL_UNIFORM_BUFFER, s.uniforms.name());
    s.gl.BufferData(GL_UNIFORM_BUFFER, sizeof uniforms, &uniforms, GL_STREAM_DRAW);
    s.gl.BindBufferBase(GL_UNIFORM_BUFFER, frame_block, s.uniforms.name());
    clock.ends(Pass::upload);
    s.compile_shaders(list);

    if (s.description.light.shadows && !shadow_damage.none())
        s.shadow_map.draw(s.meshes, list.casters, shadow_damage.rectangles(), shadows.has_far);
    clock.ends(Pass::shadow);

    s.begin_picture(planes, camera_moved);
    clock.ends(Pass::background);

    s.bind_textures();
    s.programs.draw(s.meshes, list.visible);
    clock.ends(Pass::bodies);
    s.planes.draw_regions(planes, occluded, s.scene, atlas, snapshot, s.view, shadows.has_far);
    clock.ends(Pass::planes);
    if (camera_moved)
        s.planes.draw_background(planes, s.scene);  // last, so that pixels of bodies and their shadows are skipped
    clock.ends(Pass::background);

    s.framebuffer.resolve(s.changed);
    s.framebuffer.read(s.changed, s.drawn_image);
    clock.ends(Pass::read);
    copy_opaque(s.drawn_image, s.changed, s.image);
    // Hidden items have no edges, drawn or not: surfaces share ids, and one might be mistaken for the surface in front
    // of it.
    if (s.smooth_edges) {
        blend_analytic_edges(s.drawn_image, s.edges.find(snapshot, items, draw_mask, seen, planes), dirty, s.image);
        blend_rods(s.drawn_image, s.edges.rods(), dirty, s.image);
    }
    clock.ends(Pass::edges);
    TUMBLE_CHECK_EQ(s.gl.GetError(), GLenum(GL_NO_ERROR));
    s.whole = true;
    return s.image;
}

const std::vector<Rectangle>& Renderer::changed() const { return state_->changed; }

std::string Renderer::driver() const {
    const GlFunctions& gl = state_->gl;
    std::string text = fmt::format("{}, OpenGL {}", driver_string(gl, GL_RENDERER), driver_string(gl, GL_VERSION));
    if (text.find("softpipe") != std::string::npos) text += " (softpipe has no multisampling: edges will be jagged)";
    return text;
}

}  // namespace tumble
