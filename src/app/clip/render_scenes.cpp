#include "app/clip/render_scenes.h"

#include "app/plots/variants.h"
#include "app/survey/survey.h"
#include "core/check.h"
#include "core/error.h"
#include "core/frame_rate.h"
#include "core/safe_text.h"
#include "presimulation/impact_focus.h"
#include "scene/hash/scene_hash.h"
#include "sim/checkpoint/archive.h"
#include "sim/frames/clip_speed.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

namespace tumble {
namespace {

// Parts of the height of the frame: a title of one line with the space around it; the distance of a legend from the
// edge.
constexpr double title_height = 0.125, legend_margin = 0.02;

std::string name_of(const ClipScene& clip_scene) {
    const std::string file = safe_path(clip_scene.scene->file);
    return clip_scene.label.empty() ? file : fmt::format("{} ({})", file, safe_text(clip_scene.label));
}

std::string names_of(const OverlaySet& shown) {
    std::string names;
    for (const OverlayName& overlay : overlay_names)
        if (shown.has(overlay.overlay)) names += fmt::format("{}{}", names.empty() ? "" : ",", overlay.name);
    return names.empty() ? "none" : names;
}

void require_same_rate(const std::vector<ClipScene>& scenes) {
    const ClipScene& first = scenes.front();
    for (const ClipScene& other : scenes)
        if (other.scene->output.fps != first.scene->output.fps)
            throw InputError(fmt::format(
                "scenes side by side need the same frames per second: {} has {}, {} has {} (--fps sets all)",
                name_of(first), fps_text(first.scene->output.fps), name_of(other), fps_text(other.scene->output.fps)));
}

}  // namespace

RenderScenes::RenderScenes(const ClipRequest& command, const Shutter& shutter)
    : request(command), shutter_(shutter), speed_(command.speed) {
    load(command);
    for (const ClipScene& one : scenes) {
        scales_.emplace_back(*one.scene);
        motions_.emplace_back(*one.scene);
        follows_.emplace_back(*one.scene);
        cameras_.push_back(one.scene->camera);
        if (command.sound) sounds_.emplace_back(*one.scene);
    }
    if (scenes.size() > 1 && !command.aovs.empty())
        throw InputError(fmt::format("--aov: needs a single scene ({} are shown side by side)", scenes.size()));
    kept_.resize(scenes.size());
    require_same_rate(scenes);
    std::size_t longest = 0;
    for (const ClipScene& one : scenes) {
        const FrameTiming timing = timing_at_speed(*one.scene, command.speed);
        ends.push_back(one.steps.empty() ? timing.frame_count(one.scene->simulation.duration)
                                         : std::int64_t(one.steps.size()));
        if (ends.back() > ends[longest]) longest = ends.size() - 1;
    }
    clip_frames = ends[longest];
    if (command.frames_range && command.start > 0.0)
        throw InputError("--frames-range: not together with --start; frames are numbered from the start of the clip");
    frames =
        command.frames_range ? read_frame_set(*command.frames_range, clip_frames) : frames_from(longest, command.start);
    CompositionOptions options;
    options.arrangement = command.arrangement;
    options.last_time = time_of(longest, clip_frames - 1);
    read_plot(command, options);
    composition = make_composition(scenes, options);
    add_overlays();
}

void RenderScenes::load(const ClipRequest& command) {
    std::vector<Variant> variants = make_variants(command.scenes, command.overrides, command.vary);
    label_variants(variants, command.labels);
    for (const Variant& variant : variants) {
        SceneDescription loaded =
            focused_on_impacts(command.text ? parse_scene(*command.text, variant.scene, variant.overrides, &inputs)
                                            : load_scene(variant.scene, variant.overrides, &inputs));
        loaded.output.fps /= command.frame_step;
        loaded.simulation.steps_per_frame *= command.frame_step;
        auto scene = std::make_shared<const SceneDescription>(std::move(loaded));
        if (scene->speed.empty() || !command.own_speed) {
            const FrameTiming timing = divided(timing_at_speed(*scene, command.speed), shutter_.intervals);
            scenes.push_back({std::move(scene), variant.label, timing});
            continue;
        }
        const FrameTiming timing = timing_at_speeds(*scene, command.speed, shutter_);
        const ClipSpeed found = clip_speed(*scene, timing);
        for (const std::string& bodies : found.missing)
            notes += fmt::format("note: [[speed]] time: {} have no impact; the keyframe is left out\n", bodies);
        std::vector<int> steps = steps_of_frames(*scene, found.keys, command.speed, timing, shutter_);
        scenes.push_back({std::move(scene), variant.label, timing, std::move(steps)});
    }
}

/// The frames at and after a time of the scene, s. Throws InputError if there are none.
FrameSet RenderScenes::frames_from(std::size_t scene, double start) const {
    std::int64_t first = 0;
    if (scenes[scene].steps.empty()) {
        const double fps = timing_at_speed(*scenes[scene].scene, speed_).fps;
        first = std::int64_t(std::min(std::ceil(rounded_if_nearly_whole(start * fps)), double(clip_frames)));
    } else {
        const double step = time_of_step(scene);
        std::int64_t steps = 0;
        while (first < clip_frames && double(steps) * step < start * (1.0 - 1e-12))
            steps += scenes[scene].steps[std::size_t(first++)];
    }
    if (first < clip_frames) return {first, clip_frames};
    throw InputError(fmt::format("--start: the scene's last frame is at {:g} s ({:g} was given)",
                                 time_of(scene, clip_frames - 1), start));
}

double RenderScenes::time_of(std::size_t scene, std::int64_t frame) const {
    const ClipScene& one = scenes[scene];
    if (one.steps.empty()) return double(frame) / timing_at_speed(*one.scene, speed_).fps;
    std::int64_t steps = 0;
    for (std::int64_t n = 0; n < frame; ++n) steps += one.steps[std::size_t(n)];
    return double(steps) * time_of_step(scene);
}

double RenderScenes::time_of_step(std::size_t scene) const { return shutter_.intervals * scenes[scene].timing.step(); }

/// The plot of the first scene that has one, of all scenes.
void RenderScenes::read_plot(const ClipRequest& command, CompositionOptions& options) {
    const auto with_plot =
        std::ranges::find_if(scenes, [](const ClipScene& one) { return !one.scene->overlay.plot.empty(); });
    if (with_plot == scenes.end() && (!command.overrides.plot || command.overrides.plot == "none")) return;
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

// Legends of several panels would say the same: the first one that has an overlay shows it, below the title.
void RenderScenes::add_overlays() {
    const bool below_title = !composition.text.title.empty() && composition.text.header.width == 0;
    bool legend = true;
    for (std::size_t i = 0; i < composition.panels.size(); ++i) {
        ClipPanel& panel = composition.panels[i];
        if (!draws_shapes(panel.scene->overlay)) continue;
        panel.overlay.emplace();
        panel.overlay->frame_step = shutter_.intervals / scenes[i].timing.fps;
        panel.overlay->legend = std::exchange(legend, false);
        panel.overlay->frame_height = composition.height;
        panel.overlay->legend_top = int((below_title ? title_height : legend_margin) * composition.height);
    }
}

std::vector<SurveyObserver*> RenderScenes::observers(std::size_t index) {
    const SceneDescription& scene = *scenes[index].scene;
    std::vector<SurveyObserver*> observers;
    if (!runs_.empty()) observers.push_back(&runs_[index]);
    if (composition.panels[index].overlay && needs_survey(scene.overlay)) observers.push_back(&scales_[index]);
    if (!sounds_.empty()) observers.push_back(&sounds_[index]);
    if (scene.camera.any_lags() && !follows_[index].path.seen()) observers.push_back(&follows_[index]);
    // A shorter clip does not show the whole motion, and a longer one takes longer than the camera needs.
    const double clip = scene.simulation.duration, needed = scene.camera.fitted_time;
    if (scene.camera.any_fits_motion() && (clip == needed || (clip > needed && !observers.empty())))
        observers.push_back(&motions_[index]);
    return observers;
}

bool RenderScenes::sees_for_camera(std::size_t index, const SurveyObserver* observer) const {
    return observer == &motions_[index] || observer == &follows_[index];
}

void RenderScenes::find_paths(int threads, Interrupt& interrupt) {
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        if (!scenes[i].scene->camera.any_lags()) continue;
        World run(*scenes[i].scene, scenes[i].timing, threads);
        survey(run, {ends[i], shutter_.intervals, scenes[i].steps}, {{&follows_[i]}}, interrupt);
    }
    place_cameras();
}

void RenderScenes::survey_clip(const SurveyWork& work, Interrupt& interrupt) {
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        std::vector<SurveyObserver*> seeing = observers(i);
        if (!work.image) std::erase_if(seeing, [&](SurveyObserver* one) { return !sees_for_camera(i, one); });
        if (seeing.empty()) continue;
        auto simulated = std::make_unique<World>(world(i, work.threads));
        if (work.at_start) work.at_start(i, *simulated);
        auto surveyed = std::make_unique<SurveyedFrames>(work.to_keep);
        if (work.to_keep > 0) seeing.push_back(surveyed.get());
        try {
            survey(*simulated, {ends[i], shutter_.intervals, scenes[i].steps}, seeing, interrupt);
        } catch (const Interrupted&) {
            throw;
        } catch (const RunError&) {  // the frames before are drawn, and then it fails again
            if (!sees_for_camera(i, seeing.front())) throw;
            continue;
        }
        if (surveyed->whole()) kept_[i] = {std::move(simulated), std::move(surveyed)};
    }
    use_survey(work.threads);
}

/// Panels of one file are variants of one scene: their cameras show the motion of all, so that they can be compared.
void RenderScenes::frame_motion(int threads) {
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const SceneDescription& scene = *scenes[i].scene;
        if (scene.camera.any_fits_motion() && !motions_[i].motion.seen())
            motions_[i].motion = simulated_motion(scene, threads);
    }
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        if (!cameras_[i].any_fits_motion()) continue;
        MotionCamera shown = motions_[i].motion;
        for (std::size_t k = 0; k < scenes.size(); ++k)
            if (k != i && scenes[k].scene->file == scenes[i].scene->file) shown.add(motions_[k].motion);
        cameras_[i] = shown.camera();
    }
    place_cameras();
}

void RenderScenes::place_cameras() {
    for (std::size_t i = 0; i < scenes.size(); ++i)
        if (cameras_[i].any_fits_motion() || cameras_[i].any_lags())
            place_camera(composition, i, *scenes[i].scene, follows_[i].path.applied(cameras_[i]));
}

void RenderScenes::use_survey(int threads) {
    frame_motion(threads);
    // One scale for all panels, so that their arrows can be compared.
    for (std::size_t i = 1; i < scales_.size(); ++i) scales_[0].sizes.add(scales_[i].sizes);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        if (i > 0) scales_[i].sizes.take(scales_[0].sizes);
        std::optional<PanelOverlay>& overlay = composition.panels[i].overlay;
        if (!overlay) continue;
        overlay->scales = scales_[i].sizes.scales(cameras_[i]);
        overlay->marks = scales_[i].sizes.marks();
    }
    fill_plots();
}

template <class Archive, class Self>
void RenderScenes::visit_survey(Archive& archive, Self& self) {
    for (auto& panel : self.composition.panels)
        if (panel.overlay) archive.keep(panel.overlay->scales, panel.overlay->marks);
    for (auto& camera : self.cameras_) {
        if (!camera.any_fits_motion()) continue;
        archive.keep(camera.eye, camera.target);
        for (auto& shot : camera.shots) archive.keep(shot.camera.eye, shot.camera.target);
        for (auto& inset : camera.insets) archive.keep(inset.camera.eye, inset.camera.target);
    }
    for (auto& follow : self.follows_) FollowPath::visit(archive, follow.path);
    for (auto& run : self.runs_) {
        archive.keep(run.times, run.values);
        archive.require([&run = run] {
            return run.values.size() == run.quantities.size() &&
                   std::all_of(run.values.begin(), run.values.end(),
                               [&](const auto& series) { return series.size() == run.times.size(); });
        });
    }
}

std::vector<std::byte> RenderScenes::survey_bytes() const {
    CheckpointWriter writer;
    visit_survey(writer, *this);
    return {writer.bytes().begin(), writer.bytes().end()};
}

void RenderScenes::take_survey(std::span<const std::byte> bytes) {
    CheckpointReader reader(bytes);
    visit_survey(reader, *this);
    place_cameras();
    fill_plots();
}

void RenderScenes::fill_plots() {
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

bool RenderScenes::shows_damage() const {
    return std::ranges::any_of(scenes,
                               [](const ClipScene& one) { return one.scene->overlay.show.has(Overlay::damage); });
}

std::unique_ptr<OverlayBuilder> RenderScenes::overlay(std::size_t index) const {
    const std::optional<PanelOverlay>& overlay = composition.panels[index].overlay;
    return overlay ? std::make_unique<OverlayBuilder>(*scenes[index].scene, overlay->scales) : nullptr;
}

std::vector<std::byte> RenderScenes::sound() const {
    std::vector<std::vector<double>> tracks;
    for (std::size_t i = 0; i < sounds_.size(); ++i) {
        const double fps = scenes[i].scene->output.fps;
        const auto last = std::min(frames.end(), ends[i]);
        const double duration = double(std::max<std::int64_t>(0, last - frames.first())) / fps;
        if (scenes[i].steps.empty())
            tracks.push_back(sounds_[i].track.pressure({double(frames.first()) / fps * speed_, duration, speed_}));
        else
            tracks.push_back(warped_sound(i, last));
    }
    return wav_bytes(mix(tracks));
}

/// The sound of the scene's time, played as slowly as its frames follow each other; silent where they stand still.
std::vector<double> RenderScenes::warped_sound(std::size_t index, std::int64_t last) const {
    const ClipScene& one = scenes[index];
    const double from = time_of(index, frames.first()), to = time_of(index, last - 1);
    const std::vector<double> plain = sounds_[index].track.pressure({from, to - from + 1.0, 1.0});
    const double samples = sound_rate / one.scene->output.fps;  // of the track in a frame
    const double step = time_of_step(index);
    std::vector<double> warped;
    double time = 0.0;  // s, from the first frame
    std::int64_t frame = frames.first();
    double begin = 0.0;  // of the frame, in samples
    for (; frame < last; ++frame, begin += samples) {
        const double way = one.steps[std::size_t(frame)] * step;
        for (auto n = std::int64_t(std::ceil(begin)); double(n) < begin + samples; ++n) {
            const double at = (time + way * (double(n) - begin) / samples) * sound_rate;
            const auto before = std::size_t(at);
            const double part = at - double(before);
            const bool heard = way > 0.0 && before + 1 < plain.size();
            warped.push_back(heard ? plain[before] + part * (plain[before + 1] - plain[before]) : 0.0);
        }
        time += way;
    }
    return warped;
}

std::size_t RenderScenes::bodies() const {
    std::size_t count = 0;
    for (const ClipScene& one : scenes) count = std::max(count, one.scene->bodies.size());
    return count;
}

World RenderScenes::world(std::size_t index, int threads) const {
    World world(*scenes[index].scene, scenes[index].timing, threads);
    const bool shown = composition.panels[index].overlay && needs_records(scenes[index].scene->overlay);
    if (shown || !sounds_.empty()) world.record_contacts();
    return world;
}

CheckpointIdentity RenderScenes::identity() const {
    CheckpointIdentity identity;
    std::string of_panel;
    const auto add = [&](const char* name, std::string value) {
        identity.push_back({name + of_panel, std::move(value)});
    };
    add("the number of panels", fmt::format("{}", scenes.size()));
    add("the size", fmt::format("{}x{}", composition.width, composition.height));
    add("the frames per second", fmt::format("{:.17g}", first().output.fps));
    add("--speed", fmt::format("{:.17g}", speed_));
    add("--shutter and --blur-samples", fmt::format("{} of {} parts", shutter_.blur_samples, shutter_.intervals));
    add("the number of frames", fmt::format("{}", clip_frames));
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const ClipScene& one = scenes[i];
        const SceneDescription& drawn = *composition.panels[i].scene;
        if (scenes.size() > 1) of_panel = fmt::format(" of panel {}", i + 1);
        add("the step", fmt::format("{:.17g} s", 1.0 / (one.timing.fps * one.timing.steps_per_frame)));
        add("the number of bodies", fmt::format("{}", one.scene->bodies.size()));
        add("the drawn size", fmt::format("{}x{}", drawn.output.width, drawn.output.height));
        add("the overlays", names_of(one.scene->overlay.show));
        SceneDescription state_of = *one.scene;
        state_of.output.samples = 1;  // of pixels alone
        add("the values of the scene", scene_hash(state_of));
    }
    return identity;
}

}  // namespace tumble
