#include "app/cli/render_scenes.h"

#include "app/plots/variants.h"
#include "app/survey/survey.h"
#include "core/check.h"
#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

namespace tumble {
namespace {

std::string name_of(const ClipScene& clip_scene) {
    const std::string file = safe_path(clip_scene.scene->file);
    return clip_scene.label.empty() ? file : fmt::format("{} ({})", file, safe_text(clip_scene.label));
}

void require_same_rate(const std::vector<ClipScene>& scenes) {
    const ClipScene& first = scenes.front();
    for (const ClipScene& other : scenes)
        if (other.scene->output.fps != first.scene->output.fps)
            throw InputError(fmt::format(
                "scenes side by side need the same frames per second: {} has {:g}, {} has {:g} (--fps sets all)",
                name_of(first), first.scene->output.fps, name_of(other), other.scene->output.fps));
}

}  // namespace

RenderScenes::RenderScenes(const RenderCommand& command, const Shutter& shutter) : shutter_(shutter) {
    load(command);
    if (scenes.size() > 1 && !command.aovs.empty())
        throw InputError(fmt::format("--aov: needs a single scene ({} are shown side by side)", scenes.size()));
    require_same_rate(scenes);
    std::size_t longest = 0;
    for (const ClipScene& one : scenes) {
        const FrameTiming timing = timing_at_speed(*one.scene, command.speed);
        ends.push_back(timing.frame_count(one.scene->simulation.duration));
        if (ends.back() > ends[longest]) longest = ends.size() - 1;
    }
    const SceneDescription& last = *scenes[longest].scene;
    const FrameTiming timing = timing_at_speed(last, command.speed);
    frames = frames_from(timing, last.simulation.duration, command.start);
    CompositionOptions options;
    options.arrangement = command.arrangement;
    options.last_time = double(frames.end - 1) / timing.fps;
    read_plot(command, options);
    composition = make_composition(scenes, options);
}

void RenderScenes::load(const RenderCommand& command) {
    for (const Variant& variant : make_variants(command.scenes, command.overrides, command.vary)) {
        auto scene = std::make_shared<const SceneDescription>(load_scene(variant.scene, variant.overrides, &inputs));
        const FrameTiming timing = divided(timing_at_speed(*scene, command.speed), shutter_.intervals);
        scenes.push_back({std::move(scene), variant.label, timing});
    }
}

/// The plot of the first scene that has one, of all scenes.
void RenderScenes::read_plot(const RenderCommand& command, CompositionOptions& options) {
    const auto with_plot =
        std::ranges::find_if(scenes, [](const ClipScene& one) { return !one.scene->overlay.plot.empty(); });
    if (with_plot == scenes.end() && !command.overrides.plot) return;
    const OverlayDescription& overlay = (with_plot == scenes.end() ? scenes.front() : *with_plot).scene->overlay;
    for (const ClipScene& one : scenes) {
        try {
            runs_.emplace_back(one.label, parse_quantities(overlay.plot, *one.scene));
        } catch (const InputError& error) {
            const std::string of_scene = scenes.size() > 1 ? fmt::format(" ({})", name_of(one)) : "";
            if (command.overrides.plot) throw InputError(fmt::format("--plot: {}{}", error.message(), of_scene));
            throw InputError({with_plot->scene->file, 0, 0},
                             fmt::format("[overlay] plot: {}{}", error.message(), of_scene));
        }
    }
    options.plot_panels = panels_of(runs_.front().quantities);
    options.plot_place = overlay.plot_place;
}

void RenderScenes::survey_plot(int threads, Interrupt& interrupt) {
    for (std::size_t i = 0; i < runs_.size(); ++i) {
        World simulated = world(i, threads);
        SurveyObserver* const observers[] = {&runs_[i]};
        survey(simulated, {ends[i], shutter_.intervals}, observers, interrupt);
    }
    if (runs_.empty()) return;
    std::vector<Panel> panels = make_panels(runs_, runs_.size() > 1);
    std::vector<ClipPlot>& plots = composition.plots;
    if (plots.size() == 1) {
        plots.front().figure.panels = std::move(panels);
    } else {
        TUMBLE_CHECK_EQ(plots.size(), panels.size());
        for (std::size_t i = 0; i < plots.size(); ++i) plots[i].figure.panels = {std::move(panels[i])};
    }
}

std::size_t RenderScenes::bodies() const {
    std::size_t count = 0;
    for (const ClipScene& one : scenes) count = std::max(count, one.scene->bodies.size());
    return count;
}

World RenderScenes::world(std::size_t index, int threads) const {
    return World(*scenes[index].scene, scenes[index].timing, threads);
}

}  // namespace tumble
