#include "app/composition/make_composition.h"

#include "core/safe_text.h"
#include "scene/fields/choices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>
#include <vector>

namespace tumble {
namespace {

constexpr double widest_view = 170.0;  // degrees, vertical

std::string step_text(const FrameTiming& timing) {
    const double rate = timing.fps * timing.steps_per_frame;
    if (std::round(rate) == rate) return fmt::format("h = 1/{:.0f} s", rate);
    return fmt::format("h = {:.6g} s", timing.step());
}

/// Everything that is needed to repeat the run.
std::vector<std::string> mode_of(const ClipScene& clip_scene) {
    const SimulationSettings& simulation = clip_scene.scene->simulation;
    std::vector<std::string> mode;
    if (simulation.method == SimulationMethod::notes) mode.emplace_back("method notes");
    mode.emplace_back(name_of(simulation.integrator));
    if (simulation.method != SimulationMethod::notes)
        mode.push_back(fmt::format("impacts {}", name_of(simulation.impacts)));
    mode.push_back(step_text(clip_scene.timing));
    mode.push_back(fmt::format("seed {}", simulation.seed));
    return mode;
}

/// The parts of the mode that all scenes have in common; the labels tell the others.
std::string common_mode(std::span<const ClipScene> scenes) {
    std::vector<std::string> common = mode_of(scenes.front());
    for (const ClipScene& other : scenes.subspan(1)) {
        const std::vector<std::string> mode = mode_of(other);
        std::erase_if(common, [&](const std::string& part) { return std::ranges::find(mode, part) == mode.end(); });
    }
    return fmt::format("{}", fmt::join(common, ", "));
}

/// The first scene that has something, or null.
template <class Has>
const SceneDescription* first_with(std::span<const ClipScene> scenes, const Has& has) {
    for (const ClipScene& clip_scene : scenes)
        if (has(*clip_scene.scene)) return clip_scene.scene.get();
    return nullptr;
}

const SceneDescription* first_showing(std::span<const ClipScene> scenes, Overlay overlay) {
    return first_with(scenes, [&](const SceneDescription& scene) { return scene.overlay.show.has(overlay); });
}

/// The place of a picture in a corner of the area.
Rectangle in_corner(FrameCorner corner, int width, int height, int margin, const Rectangle& area) {
    const bool right = corner == FrameCorner::top_right || corner == FrameCorner::bottom_right;
    const bool bottom = corner == FrameCorner::bottom_left || corner == FrameCorner::bottom_right;
    const auto at = [&](bool far, int first, int whole, int size) {
        return first + std::clamp(far ? whole - margin - size : margin, 0, std::max(0, whole - size));
    };
    return {at(right, area.x, area.width, width), at(bottom, area.y, area.height, height), width, height};
}

/// The place of an inset in that of its panel.
Rectangle place_of(const CameraInset& inset, const Rectangle& area) {
    constexpr int least_side = 8;  // pixels
    const auto pixels = [](double share, int whole) { return int(std::lround(share * whole)); };
    if (inset.rectangle) {
        const auto& [left, top, across, down] = *inset.rectangle;
        const int x = pixels(left, area.width), y = pixels(top, area.height);
        return {area.x + x, area.y + y, std::max(least_side, pixels(left + across, area.width) - x),
                std::max(least_side, pixels(top + down, area.height) - y)};
    }
    return in_corner(inset.corner, std::max(least_side, pixels(inset.size, area.width)),
                     std::max(least_side, pixels(inset.size, area.height)), pixels(inset.margin, area.height), area);
}

ClipText text_of(std::span<const ClipScene> scenes, const CompositionOptions& options) {
    ClipText text;
    if (const SceneDescription* scene = first_showing(scenes, Overlay::title))
        text.title = scene->title.empty() ? std::filesystem::path(scene->file).stem().string() : scene->title;
    text.clock = first_showing(scenes, Overlay::clock) != nullptr;
    text.last_time = options.last_time;
    if (first_showing(scenes, Overlay::mode) != nullptr) text.mode = common_mode(scenes);
    if (const auto* scene = first_with(scenes, [](const SceneDescription& s) { return !s.overlay.captions.empty(); }))
        text.captions = scene->overlay.captions;
    return text;
}

ClipFade fade_of(std::span<const ClipScene> scenes, double last_time) {
    const auto fades = [](const SceneDescription& scene) { return scene.overlay.fade_in || scene.overlay.fade_out; };
    const SceneDescription* scene = first_with(scenes, fades);
    if (scene == nullptr) return {};
    return {scene->overlay.fade_in.value_or(0.0), scene->overlay.fade_out.value_or(0.0), last_time};
}

std::optional<ClipLogo> logo_of(std::span<const ClipScene> scenes, int width, int height) {
    const SceneDescription* scene =
        first_with(scenes, [](const SceneDescription& s) { return s.overlay.logo.has_value(); });
    if (scene == nullptr) return std::nullopt;
    const LogoDescription& logo = *scene->overlay.logo;
    const Texture::Level& image = logo.image->levels.front();
    const int margin = int(std::lround(logo.margin * height));
    // Also a tall logo is in the frame as a whole.
    double scale = logo.width * width / image.width;
    scale = std::min(scale, std::max(1.0, double(height - 2 * margin)) / image.height);
    const auto side = [&](int size) { return std::max(1, int(std::lround(scale * size))); };
    return ClipLogo{logo, in_corner(logo.corner, side(image.width), side(image.height), margin, {0, 0, width, height})};
}

double wider(double vertical_fov, double factor) {
    constexpr double degrees = std::numbers::pi / 180.0;
    const double half = std::atan(factor * std::tan(0.5 * vertical_fov * degrees)) / degrees;
    return std::max(vertical_fov, std::min(2.0 * half, widest_view));
}

bool is_whole(const Rectangle& place, const SceneDescription& scene) {
    return place == Rectangle{0, 0, scene.output.width, scene.output.height};
}

Figure empty_figure(double unit, bool on_picture) {
    Figure figure;
    figure.x_title = "time (s)";
    figure.theme = on_picture ? Theme::on_picture() : Theme::light();
    figure.text_size = std::max(8.0, 0.025 * unit);
    return figure;
}

}  // namespace

SceneDescription panel_scene(const SceneDescription& scene, int width, int height) {
    SceneDescription panel = scene;
    panel.output.width = width;
    panel.output.height = height;
    const double factor = double(scene.output.width) / double(scene.output.height) / (double(width) / double(height));
    if (factor <= 1.0) return panel;
    const auto widen = [&](CameraDescription& camera) {
        camera.vertical_fov = wider(camera.vertical_fov, factor);
        for (CameraKeyframe& key : camera.keyframes) key.vertical_fov = wider(key.vertical_fov, factor);
    };
    widen(panel.camera);
    for (CameraShot& shot : panel.camera.shots) widen(shot.camera);
    return panel;
}

namespace {

/// The insets of a panel, whose whole scene has their cameras.
void place_insets(Composition& composition, std::size_t panel, const SceneDescription& scene) {
    std::erase_if(composition.insets, [&](const ClipInset& one) { return one.panel == panel; });
    const Rectangle& area = composition.panels[panel].place;
    for (const CameraInset& inset : scene.camera.insets) {
        ClipInset made{panel, nullptr, place_of(inset, area), 0, inset.border_color, inset.start, inset.end};
        made.border = int(std::lround(inset.border * composition.height / 720.0));
        if (inset.border > 0.0) made.border = std::max(1, made.border);
        SceneDescription shown = scene;
        shown.camera = inset.camera;
        shown.overlay = {};
        made.scene = std::make_shared<const SceneDescription>(panel_scene(shown, made.place.width, made.place.height));
        composition.insets.push_back(std::move(made));
    }
}

}  // namespace

void place_camera(Composition& composition, std::size_t panel, const SceneDescription& scene,
                  const CameraDescription& camera) {
    SceneDescription framed = scene;
    framed.camera = camera;
    const Rectangle& place = composition.panels[panel].place;
    auto whole = std::make_shared<const SceneDescription>(std::move(framed));
    if (panel == 0) composition.aov_scene = whole;
    place_insets(composition, panel, *whole);
    composition.panels[panel].scene =
        is_whole(place, *whole)
            ? std::move(whole)
            : std::make_shared<const SceneDescription>(panel_scene(*whole, place.width, place.height));
}

Composition make_composition(std::span<const ClipScene> scenes, const CompositionOptions& options) {
    const SceneDescription& first = *scenes.front().scene;
    Composition composition;
    composition.width = first.output.width;
    composition.height = first.output.height;
    composition.aov_scene = scenes.front().scene;
    composition.text = text_of(scenes, options);
    composition.fade = fade_of(scenes, options.last_time);
    composition.logo = logo_of(scenes, composition.width, composition.height);
    ClipText& text = composition.text;
    LayoutRequest request{.width = composition.width,
                          .height = composition.height,
                          .panels = scenes.size(),
                          .arrangement = options.arrangement,
                          .header = text.clock || !text.title.empty(),
                          .captions = !text.captions.empty(),
                          .footer = !text.mode.empty(),
                          .clock = text.clock,
                          .plot = {},
                          .plot_panels = options.plot_panels};
    if (options.plot_panels > 0) request.plot = options.plot_place;
    const FrameLayout layout = lay_out(request);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const Rectangle& place = layout.panels[i];
        std::shared_ptr<const SceneDescription> scene = scenes[i].scene;
        if (!is_whole(place, *scene))
            scene = std::make_shared<const SceneDescription>(panel_scene(*scene, place.width, place.height));
        composition.panels.push_back({std::move(scene), place});
        place_insets(composition, i, *scenes[i].scene);
        if (!layout.labels.empty()) composition.labels.push_back({scenes[i].label, layout.labels[i]});
    }
    text.header = layout.header;
    text.band = layout.captions;
    text.footer = layout.footer;
    if (layout.plots_on_picture) text.title_end = layout.plots.front().x;
    text.area = layout.area;
    const double unit = text_unit(composition.width, composition.height);
    for (const Rectangle& place : layout.plots)
        composition.plots.push_back({empty_figure(unit, layout.plots_on_picture), place});
    return composition;
}

}  // namespace tumble
