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
std::string words(const GlFunctions& gl, GLenum name) {
    const GLubyte* text = gl.GetString(name);
    return text != nullptr ? reinterpret_cast<const char*>(text) : "unknown";
}

Camera first_view(const SceneDescription& scene, const RenderScene& looks, const RenderOptions& options) {
    const double viewing = viewing_distance(scene, looks);
    return Camera(scene.camera, scene.output.width, scene.output.height, {options.shift_x, options.shift_y})
        .with_distances(viewing, fog_distance(scene, looks, viewing));
}

}  // namespace

struct Renderer::State {
    State(const SceneDescription& description, const RenderOptions& options, const std::filesystem::path& shaders)
        : drawn(description),
          scene(drawn.scene()),
          looks(make_render_scene(scene)),
          sun_up(sun_is_up(scene)),
          path(description.camera),
          camera(scene.camera),
          view(first_view(scene, looks, options)),
          stage(scene, looks, view, shadow_map_texels),
          occlusion(looks, view.eye()),
          changes(scene, looks, view),
          last_marks(view),
          details(looks),
          edges(looks, view, details),
          image(scene.output.width, scene.output.height),
          drawn_image(scene.output.width, scene.output.height),
          context(make_gl_context(options.backend)),
          gl(load_gl_functions([this](const char* name) { return context->get_proc_address(name); })),
          smooth_edges(scene.output.samples > 1 && scene.cords.empty() && !options.multisample),
          framebuffer(gl, scene.output.width, scene.output.height, smooth_edges ? 1 : scene.output.samples),
          uniforms(gl, GlKind::buffer),
          meshes(gl, looks),
          occlusion_texture(gl),
          shadow_map(gl, shaders, frame_block),
          programs(gl, shaders, looks, !scene.cords.empty(), scene.light.shadows, stage.filter()),
          planes(gl, shaders, looks, scene.light.shadows, stage.filter()),
          full_redraw(options.full_redraw),
          draw_hidden(options.draw_hidden),
          times(options.times),
          turns(options.turns) {
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
        if (turns == nullptr) return;
        bind_textures();
        framebuffer.begin_whole();
        gl.Enable(GL_SCISSOR_TEST);
        gl.Scissor(0, 0, 0, 0);
        std::vector<std::function<void()>> all = programs.compilations(meshes, list.visible);
        for (auto& one : planes.compilations()) all.push_back(std::move(one));
        if (scene.light.shadows) all.emplace_back([&] { shadow_map.compile(meshes, list.casters); });
        std::exchange(turns, nullptr)->run(all);
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
            planes.draw_open(patches, looks);
            background_kept = true;
        }
        framebuffer.begin(changed, closing);
    }

    CompoundExpansion drawn;
    const SceneDescription& scene;
    RenderScene looks;
    bool sun_up;
    CameraAnimation path;
    CameraDescription camera;  // of the previous frame
    Camera view;
    CascadeFitter stage;
    AmbientOcclusion occlusion;
    DamageTracker changes;
    DirtyTiles last_marks;
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
        closing;  // redrawn regions; regions drawn in the previous frame and not in this one
    bool full_redraw, draw_hidden;
    PassTimes* times;
    ShaderCompileSchedule* turns;  // until its shaders are compiled
};

Renderer::Renderer(const SceneDescription& scene, const RenderOptions& options) {
    const std::filesystem::path shaders = options.shader_folder.empty() ? find_shader_folder() : options.shader_folder;
    state_ = std::make_unique<State>(scene, options, shaders);
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
                     make_drawn_items(s.scene, s.looks, snapshot, s.view),
                     near_distance_for(s.looks, snapshot, s.view),
                     s.stage.fit(s.looks, snapshot, s.view, s.path.carried(whole)),
                     {},
                     s.framebuffer.samples() <= 1};
    state.planes = make_plane_patches(s.looks, snapshot, s.view, state.near_distance);
    const std::vector<PlanePatch>& planes = state.planes;
    const std::vector<DrawableBounds>& items = state.items;
    const double near_distance = state.near_distance;
    const ShadowCascades& shadows = state.shadows;
    const Visibility seen = find_visible(s.looks, snapshot, s.view, s.framebuffer.samples() <= 1);
    std::optional<Visibility> everything;
    const Visibility& visibility = s.draw_hidden ? everything.emplace(everything_visible(s.looks, s.view)) : seen;
    // Of visible bodies only: the place of a tile in the atlas may change the last digit of a color.
    const OcclusionChanges& darkening = s.occlusion.update(snapshot, s.view, seen);
    DirtyTiles marks = s.changes.find(state, darkening, visibility);
    if (s.full_redraw) marks.mark_all();
    s.changed = marks.rectangles();
    s.closing = s.last_marks.rectangles_outside(marks);
    s.last_marks = marks;

    ShadowDirtyTiles shadow_marks = s.changes.shadow_marks();
    if (s.full_redraw) shadow_marks.mark_all();
    const bool all_shadows = shadow_marks.all();
    const Vec3 light = s.scene.light.direction.normalized();
    std::vector<char> wanted, casting;
    for (const DrawableBounds& item : items) {
        wanted.push_back(item.exists() && (marks.all() || marks.touched_by(item.corners())) ? 1 : 0);
        casting.push_back(item.exists() && (all_shadows || shadow_marks.touched_by(item)) &&
                                  s.view.sees_swept(item.center, item.radius, light)
                              ? 1
                              : 0);
    }
    if (s.scene.light.shadows && !s.draw_hidden) drop_hidden_casters(s.looks, items, shadows, casting);
    const OcclusionAtlas& atlas = s.occlusion.atlas();
    const DrawList list =
        make_draw_list(s.scene, s.looks, snapshot, s.view, visibility, atlas, shadows, wanted, casting);
    std::vector<std::vector<Rectangle>> touched;
    for (const PlanePatch& plane : planes)
        touched.push_back(find_touched_areas(plane, s.scene, s.looks, items, s.view, shadows, visibility.cover, atlas,
                                             snapshot, marks));
    clock.ends(Pass::preparation);

    s.occlusion_texture.upload(atlas, darkening.first_row, darkening.end_row);
    s.meshes.upload(list, s.details);
    const FrameUniforms uniforms = make_frame_uniforms(s.scene.light, s.sun_up, s.view, near_distance, shadows,
                                                       s.occlusion_texture.height(), s.smooth_edges);
    s.gl.BindBuffer(GL_UNIFORM_BUFFER, s.uniforms.name());
    s.gl.BufferData(GL_UNIFORM_BUFFER, sizeof uniforms, &uniforms, GL_STREAM_DRAW);
    s.gl.BindBufferBase(GL_UNIFORM_BUFFER, frame_block, s.uniforms.name());
    clock.ends(Pass::upload);
    s.compile_shaders(list);

    if (s.scene.light.shadows && !shadow_marks.none())
        s.shadow_map.draw(s.meshes, list.casters, shadow_marks.rectangles(), shadows.has_far);
    clock.ends(Pass::shadow);

    s.begin_picture(planes, camera_moved);
    clock.ends(Pass::background);

    s.bind_textures();
    s.programs.draw(s.meshes, list.visible);
    clock.ends(Pass::bodies);
    s.planes.draw_touched(planes, touched, s.looks, atlas, snapshot, s.view, shadows.has_far);
    clock.ends(Pass::planes);
    if (camera_moved)
        s.planes.draw_open(planes, s.looks);  // last, so that pixels of bodies and their shadows are skipped
    clock.ends(Pass::background);

    s.framebuffer.resolve(s.changed);
    s.framebuffer.read(s.changed, s.drawn_image);
    clock.ends(Pass::read);
    copy_opaque(s.drawn_image, s.changed, s.image);
    // Hidden items have no edges, drawn or not: surfaces share ids, and one might be mistaken for the surface in front
    // of it.
    if (s.smooth_edges) {
        blend_analytic_edges(s.drawn_image, s.edges.find(snapshot, items, wanted, seen, planes), marks, s.image);
        blend_rods(s.drawn_image, s.edges.rods(), marks, s.image);
    }
    clock.ends(Pass::edges);
    TUMBLE_CHECK_EQ(s.gl.GetError(), GLenum(GL_NO_ERROR));
    s.whole = true;
    return s.image;
}

const std::vector<Rectangle>& Renderer::changed() const { return state_->changed; }

std::string Renderer::driver() const {
    const GlFunctions& gl = state_->gl;
    std::string text = fmt::format("{}, OpenGL {}", words(gl, GL_RENDERER), words(gl, GL_VERSION));
    if (text.find("softpipe") != std::string::npos) text += " (softpipe has no multisampling: edges will be jagged)";
    return text;
}

}  // namespace tumble
