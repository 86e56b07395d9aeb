// The sequence of a frame; each step has a file of its own.
#include "render/renderer.h"

#include "core/check.h"
#include "core/error.h"
#include "core/image_mean.h"
#include "render/antialiasing/antialiasing.h"
#include "render/antialiasing/surface_ids.h"
#include "render/frame/frame_context.h"
#include "render/gl/gl_device.h"
#include "render/gl/shader_source.h"
#include "render/passes/draw_list.h"
#include "render/passes/frame_passes.h"
#include "render/render_scene_builder.h"
#include "render/render_switches.h"
#include "render/scene/plane_patch.h"

#include <fmt/format.h>

#include <array>
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

// Edges are smoothed analytically, except in scenes with cords, which can be thinner than a pixel and need several
// samples.
bool is_analytic(const SceneDescription& description, const RenderSwitches& switches) {
    return description.output.samples > 1 && description.cords.empty() && !switches.multisample;
}

// The color and alpha of pixels without a body, if neither the sky nor planes are drawn.
std::optional<std::array<float, 4>> plain_background(const RenderSwitches& switches, bool analytic) {
    const float alpha = analytic ? float(sky_id) / 255.0f : 0.0f;  // a surface id, otherwise coverage
    if (switches.transparent) return {{0.0f, 0.0f, 0.0f, alpha}};
    if (!switches.plain_background) return std::nullopt;
    const auto level = [&](std::size_t channel) { return float((*switches.plain_background)[channel]) / 255.0f; };
    return {{level(0), level(1), level(2), alpha}};
}

PassOptions pass_options(const SceneDescription& description, const RenderSwitches& switches) {
    const bool analytic = is_analytic(description, switches);
    PassOptions options;
    options.shaders = switches.shader_folder.empty() ? find_shader_folder() : switches.shader_folder;
    options.width = description.output.width;
    options.height = description.output.height;
    options.samples = analytic ? 1 : description.output.samples;
    options.widen_rods = analytic;
    options.plain_background = plain_background(switches, analytic);
    options.schedule = switches.compile_schedule;
    return options;
}

RenderScene drawn_scene(const SceneDescription& description, const RenderSwitches& switches) {
    RenderScene scene = make_render_scene(description);
    if (switches.transparent && scene.environment && scene.environment->ground_shadow)
        scene.shadow_alpha = is_analytic(description, switches) ? 1 : 2;
    scene.cut = switches.cut;
    return scene;
}

PlaneShape mirror_plane(const BodyDescription& body) {
    BodyState state;
    state.origin = body.position;
    state.orientation = body.rotation;
    RenderBody proxy;
    proxy.plane = std::get<PlaneShape>(body.shape);
    return plane_in_world(proxy, state);
}

double lowest_trough(const WaterDescription& water) {
    double lowest = water.level;
    for (const WaterWave& wave : water.waves) lowest -= 0.5 * wave.height;
    return lowest;
}

/// Draws the bodies that the scene's mirror, a plane or still water, shows, for a renderer of the scene; null without
/// one.
std::unique_ptr<Renderer> mirror_renderer(const SceneDescription& scene, RenderSwitches switches, GlDevice& device) {
    const auto mirror = mirror_of(scene);
    if ((!mirror && !scene.water) || switches.transparent || switches.plain_background) return nullptr;
    SceneDescription bodies = scene;
    bodies.water.reset();
    switches.mirror = mirror ? mirror_plane(scene.bodies[*mirror]) : PlaneShape{Vec3::UnitY(), scene.water->level};
    if (!mirror) switches.cut = lowest_trough(*scene.water);
    switches.transparent = true;
    switches.shift_x = -switches.shift_x;
    switches.keep_depths = false;
    switches.times = nullptr;
    switches.device = &device;
    switches.compile_schedule = nullptr;
    if (bodies.environment) bodies.environment->ground_shadow = false;
    return std::make_unique<Renderer>(bodies, switches);
}

}  // namespace

struct Renderer::State {
    /// `description`: without compounds; only needed during the call.
    State(const SceneDescription& description, PartPoses parts, const RenderSwitches& options)
        : switches(options),
          scene(drawn_scene(description, options)),
          setup(description, scene, std::move(parts), {options.shift_x, options.shift_y}, options.mirror),
          ambient_occlusion(scene, setup.camera().eye()),
          damage_tracker({options.full_redraw, options.draw_hidden}),
          lods(scene),
          own_device(options.device == nullptr ? std::make_unique<GlDevice>(options.backend) : nullptr),
          device(own_device ? *own_device : current(*options.device)),
          passes(device, scene, setup.shadow_filter(), pass_options(description, options)),
          antialiasing(lods, description.output.width, description.output.height,
                       {is_analytic(description, options), options.transparent}),
          image(description.output.width, description.output.height),
          lens_mean(options.transparent) {
        if (options.keep_depths) depths = DepthImage(description.output.width, description.output.height);
    }

    // The context of another renderer may be current; objects must be deleted in this one.
    ~State() {
        try {
            device.make_current();
        } catch (const RunError&) {
        }
    }

    static GlDevice& current(GlDevice& device) {
        device.make_current();
        return device;
    }

    RenderSwitches switches;
    RenderScene scene;
    FrameSetup setup;
    AmbientOcclusion ambient_occlusion;
    DamageTracker damage_tracker;
    MeshLods lods;
    std::unique_ptr<GlDevice> own_device;  // null: it is another one's
    GlDevice& device;
    FramePasses passes;
    Antialiasing antialiasing;
    Image image;
    DepthImage depths;  // of the switch keep_depths
    std::vector<Rectangle> changed;
    ImageMean lens_mean;
    Image lens_image;
    std::optional<FrameMoment> lens_moment;  // of lens_image, if it is the current image
    std::unique_ptr<Renderer> mirror;        // null: no plane reflects

    /// Draws the mirrored bodies, and returns where their image changed, as the plane shows it.
    std::vector<Rectangle> draw_mirrored(const Snapshot& snapshot, const Eigen::Vector2d& lens_point) {
        if (!mirror) return {};
        const Image& mirrored = mirror->draw(snapshot, lens_point);
        std::vector<Rectangle> rectangles = mirror->changed();
        if (!rectangles.empty()) passes.set_reflection(mirrored);
        for (Rectangle& r : rectangles) r.x = mirrored.width - r.x - r.width;
        return rectangles;
    }
};

Renderer::Renderer(const SceneDescription& scene, const RenderSwitches& switches)
    : state_(std::make_unique<State>(expand_compounds(scene), PartPoses(scene), switches)) {
    state_->mirror = mirror_renderer(scene, switches, state_->device);
}

Renderer::Renderer(const SceneDescription& scene, const RenderOptions& options)
    : Renderer(scene, RenderSwitches{options}) {}

Renderer::~Renderer() = default;

const Image& Renderer::render(const Snapshot& snapshot, const FrameMoment& moment) {
    State& s = *state_;
    const std::vector<Rectangle> whole{{0, 0, s.image.width, s.image.height}};
    const int samples = s.setup.lens_samples(snapshot);
    if (samples == 0) {
        const Image& image = draw(snapshot, Eigen::Vector2d::Zero());
        if (std::exchange(s.lens_moment, std::nullopt)) s.changed = whole;
        return image;
    }
    if (s.lens_moment == moment && !s.switches.full_redraw && s.setup.shows(snapshot)) {
        s.changed.clear();
        return s.lens_image;
    }
    for (const Eigen::Vector2d& point : lens_points(samples, moment)) s.lens_mean.add(draw(snapshot, point));
    s.lens_mean.take(s.lens_image);
    if (s.switches.keep_depths) draw(snapshot, Eigen::Vector2d::Zero());
    s.lens_moment = moment;
    s.changed = whole;
    return s.lens_image;
}

const Image& Renderer::draw(const Snapshot& snapshot, const Eigen::Vector2d& lens_point) {
    State& s = *state_;
    s.setup.look_through(lens_point);
    s.device.make_current();  // another renderer may have been used in this thread
    PassTimer timer(s.device.gl(), s.switches.times);
    s.changed.clear();

    FrameContext frame = s.setup.prepare(snapshot, s.passes.one_sample(), s.switches.full_redraw);
    if (s.passes.plain_background() && s.scene.shadow_alpha == 0)
        frame.planes.clear();  // planes of the scene still occlude bodies
    if (frame.unchanged) {
        s.setup.finish();
        return s.image;
    }
    const Visibility visible = find_visible(frame);
    // Occlusion of visible bodies only: the place of a tile in the atlas may change the last digit of a color.
    s.ambient_occlusion.update(frame, visible);
    std::optional<Visibility> everything;
    const Visibility& drawn = s.switches.draw_hidden ? everything.emplace(everything_visible(frame)) : visible;
    Damage damage = s.damage_tracker.find(frame, drawn, s.ambient_occlusion, s.draw_mirrored(snapshot, lens_point));
    const OcclusionAtlas& atlas = s.ambient_occlusion.atlas();
    DrawList list = make_draw_list(frame, drawn, atlas, damage.drawn, damage.casters);
    if (s.switches.transparent && !s.antialiasing.analytic())
        for (Instance& instance : list.instances) instance.surface_id = 1.0f;  // samples of ids have no mean: coverage
    timer.ends(Pass::preparation);

    s.passes.upload(frame, list, s.ambient_occlusion, s.lods);
    timer.ends(Pass::upload);
    s.passes.draw(frame, damage, list, atlas, timer);
    s.passes.read(damage.changed, s.antialiasing.drawn());
    if (s.switches.keep_depths) s.passes.read_depths(damage.changed, frame.near_distance, s.depths);
    timer.ends(Pass::read);
    s.antialiasing.apply(frame, damage, visible, s.image);
    timer.ends(Pass::edges);
    TUMBLE_CHECK_EQ(s.device.gl().GetError(), GLenum(GL_NO_ERROR));

    s.changed = std::move(damage.changed);
    s.setup.finish();
    return s.image;
}

const std::vector<Rectangle>& Renderer::changed() const { return state_->changed; }

const DepthImage& Renderer::depths() const {
    TUMBLE_CHECK_EQ(state_->switches.keep_depths, true);
    return state_->depths;
}

const Camera& Renderer::camera() const { return state_->setup.camera(); }

std::string Renderer::driver() const {
    const GlFunctions& gl = state_->device.gl();
    std::string text = fmt::format("{}, OpenGL {}", driver_string(gl, GL_RENDERER), driver_string(gl, GL_VERSION));
    if (text.find("softpipe") != std::string::npos) text += " (softpipe has no multisampling: edges will be jagged)";
    return text;
}

}  // namespace tumble
