#include "app/cli/render_run.h"

#include "app/causes/motion_record.h"
#include "app/causes/run_recorder.h"
#include "app/checkpoints/checkpoint_folder.h"
#include "app/checkpoints/recorded_frames.h"
#include "app/cli/progress.h"
#include "app/cli/run_notes.h"
#include "app/cli/say.h"
#include "app/clip/drawing_settings.h"
#include "app/clip/render_scenes.h"
#include "app/files/aov_folder.h"
#include "app/files/frame_folder.h"
#include "app/files/output_plan.h"
#include "app/pipeline/pipeline.h"
#include "app/plots/alike_runs.h"
#include "app/resume/kept_frames.h"
#include "app/threads/interrupt.h"
#include "app/threads/task_group.h"
#include "app/threads/trace.h"
#include "app/workers/frame_memory.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/encoder_report.h"
#include "output/temporary_folder.h"

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <memory>
#include <set>
#include <system_error>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

// Bytes of frames that are simulated before the drawing: a minute of 1,000 bodies at 60 frames/s has 600 MB. Where
// there are more, the motion is simulated twice.
constexpr std::size_t most_kept_bytes = std::size_t(256) << 20;

/// The folder of the AOVs, if any are requested.
std::optional<fs::path> folder_of_aovs(const RenderCommand& command) {
    if (command.aovs.empty() && command.aov_folder)
        throw InputError("--aov-folder: needs --aov with the AOVs to write, as in --aov depth,normal");
    if (command.aovs.empty()) return std::nullopt;
    if (!command.aov_folder && !command.frames)
        throw InputError("--aov: needs --frames or --aov-folder for the folder to write to");
    return command.aov_folder ? command.aov_folder : command.frames;
}

/// Throws InputError if an output would replace another one or an input.
void check_outputs(const RenderCommand& command, const RenderPlan& plan, const RenderScenes& scenes) {
    OutputPlan files;
    files.add_inputs(scenes.inputs);
    if (command.from_checkpoints) {
        files.add_inputs(checkpoint_files_in(*command.from_checkpoints));
        files.add_input_folder(*command.from_checkpoints, is_checkpoint_name);
    }
    if (command.motion_record && (command.resume || command.from_checkpoints))
        throw InputError("--motion-record: is of a whole run, without --resume and --from-checkpoints");
    if (command.motion_record) files.add("--motion-record", *command.motion_record);
    if (plan.clip) files.add("--output", *plan.clip);
    if (plan.aov_folder && command.aovs.has(Aov::segmentation))
        files.add("--aov", segmentation_table_path(*plan.aov_folder));
    if (command.report) files.add("--report", *command.report);
    if (command.profile) files.add("--profile", *command.profile);
    const auto add_series = [&](const char* option, const fs::path& folder, FrameFiles kind) {
        const bool pictures = kind == FrameFiles::pictures;
        files.add(option, manifest_path(folder, kind));
        files.add({option, folder, pictures ? "frame_" : "aov_", pictures ? ".png" : ".npz",
                   pictures ? frame_path : aov_path, scenes.frames.first(), scenes.frames.end()});
    };
    if (plan.folder) add_series("--frames", *plan.folder, FrameFiles::pictures);
    if (plan.aov_folder) add_series("--aov", *plan.aov_folder, FrameFiles::aovs);
}

void check_sound(const RenderCommand& command, const RenderPlan& plan) {
    if (!command.sound) return;
    if (!plan.clip)
        throw InputError("--sound: needs a clip (-o CLIP); tumble simulate --sound S.wav writes the sound alone");
    if (plan.format->kind == VideoKind::gif) throw InputError("--sound: a GIF has no sound; .mp4 and .webm have");
    if (command.from_checkpoints) throw InputError("--sound: is of a whole run, without --from-checkpoints");
}

DrawingChoices choices_of(const RenderCommand& command) {
    return {command.shutter, command.blur_samples, command.drawing.transparent, command.drawing.backend};
}

/// The frames of a folder that are to be drawn.
FrameSet missing_in(const RenderCommand& command, const fs::path& folder, FrameFiles kind,
                    const FrameIdentity& identity, const FrameSet& wanted) {
    if (command.resume || command.frames_range) require_same_clip(folder, kind, identity);
    if (!command.resume) return wanted;
    const FrameSet kept = kept_frames(folder, kind, identity, wanted);
    return wanted.where([&](std::int64_t n) { return !kept.contains(n); });
}

/// Numbers of the frames of a set.
std::vector<std::int64_t> numbers_of(const FrameSet& frames) {
    std::vector<std::int64_t> numbers;
    frames.for_each([&](std::int64_t frame) { numbers.push_back(frame); });
    return numbers;
}

/// Takes the survey of the clip from the folder.
CheckpointReading open_checkpoints(const std::filesystem::path& folder, RenderScenes& scenes) {
    if (scenes.shows_damage())
        throw InputError(
            "--from-checkpoints: the overlay 'damage' shows changes since the frame before, which a part of a clip has "
            "not drawn; leave one of them out");
    CheckpointReading checkpoints(folder, scenes.identity());
    scenes.take_survey(checkpoints.survey());
    return checkpoints;
}

/// The motion of the panels, simulated or recorded, from the start of the clip or from a checkpoint.
struct ClipMotion {
    std::optional<CheckpointReading> checkpoints;
    std::optional<ClipState> state;  // to go on from
    std::vector<std::unique_ptr<World>> worlds;
    std::vector<std::unique_ptr<OverlayBuilder>> overlays;
    std::vector<std::unique_ptr<SimulatedFrames>> recorded;
    std::vector<PanelSource> panels;

    void make_panels(RenderScenes& scenes, bool image, int threads) {
        const bool known = checkpoints && checkpoints->has_motion();
        for (std::size_t i = 0; i < scenes.scenes.size(); ++i) {
            const std::int64_t first = PanelRun::first_recorded(state ? state->frame : 0, scenes.ends[i]);
            const std::size_t bodies = scenes.scenes[i].scene->bodies.size();
            SurveyedRun run = scenes.take_run(i);
            if (known) run.frames.reset();
            if (run.frames) {
                worlds.push_back(std::move(run.world));
                recorded.push_back(std::move(run.frames));
            } else {
                worlds.push_back(known ? nullptr : std::make_unique<World>(scenes.world(i, threads)));
                recorded.push_back(known ? std::make_unique<RecordedFrames>(*checkpoints, i, bodies, first) : nullptr);
            }
            overlays.push_back(image ? scenes.overlay(i) : nullptr);
            panels.push_back({worlds[i].get(),
                              scenes.ends[i],
                              overlays[i].get(),
                              recorded[i].get(),
                              bodies,
                              {},
                              scenes.scenes[i].steps});
        }
    }
    /// `surveyed`: the notes of worlds that have been simulated.
    void say_overlaps_at_start(const RenderScenes& scenes, const std::vector<std::string>& surveyed) const {
        std::set<std::string> said;  // panels often show one scene with other values
        for (std::size_t i = 0; i < worlds.size() && !state; ++i)
            if (worlds[i]) said.insert(recorded[i] ? surveyed[i] : start_notes(*scenes.scenes[i].scene, *worlds[i]));
        for (const std::string& lines : said) say_text(lines);
    }
    void say_broken_joints(const RenderScenes& scenes) const {
        for (std::size_t i = 0; i < worlds.size(); ++i)
            if (worlds[i]) say_broken(broken_joints(*scenes.scenes[i].scene, *worlds[i]));
    }
    /// Precondition: worlds, from the start of the clip.
    void record(RunRecorder& recorder) {
        for (std::size_t i = 0; i < panels.size(); ++i) {
            worlds[i]->record_contacts();
            panels[i].observers.push_back(&recorder.panel(i));
        }
    }
};

StageSeconds cpu_seconds(const PipelineTimes& times, const PipelineOutputs& outputs) {
    StageSeconds cpu;
    cpu.simulation = times.simulation.cpu.load();
    cpu.drawing = times.drawing.drawing.cpu.load();
    cpu.png = times.drawing.png.cpu.load() + times.files.cpu.load();
    cpu.aovs = times.drawing.aovs.cpu.load() + times.aov_files.cpu.load();
    cpu.conversion = times.drawing.conversion.cpu.load();
    cpu.video = times.video.cpu.load() + (outputs.video != nullptr ? outputs.video->encoder_seconds() : 0.0);
    return cpu;
}

RenderFigures figures_of(const RenderPlan& plan, const RenderScenes& scenes) {
    RenderFigures figures;
    figures.width = scenes.composition.width;
    figures.height = scenes.composition.height;
    figures.fps = scenes.first().output.fps;
    figures.frames = scenes.frames;
    figures.clip_frames = scenes.clip_frames;
    figures.rendered = plan.needed();
    figures.clip = plan.clip;
    if (plan.format) figures.kind = plan.format->kind;
    figures.folder = plan.folder;
    figures.aov_folder = plan.aov_folder;
    return figures;
}

/// Writes the sound of the surveyed clip into a folder that it makes.
void write_sound(const RenderScenes& scenes, RenderPlan& plan, std::optional<TemporaryFolder>& folder) {
    folder.emplace("sound");
    const fs::path file = folder->path() / "sound.wav";
    write_file(file, scenes.sound());
    plan.set_sound(file);
}

/// The open outputs.
class Destinations {
public:
    Destinations(const RenderCommand& command, RenderPlan& plan, const RenderScenes& scenes) : plan_(plan) {
        const LockKind kind = command.resume || command.frames_range ? LockKind::shared : LockKind::alone;
        if (plan.folder) {
            folder_.emplace(*plan.folder, kind);
            folder_->set_manifest(manifest_path(*plan.folder, FrameFiles::pictures), manifest_text(plan.pictures));
        }
        std::error_code missing;
        if (plan.aov_folder && !(folder_ && std::filesystem::equivalent(*plan.aov_folder, folder_->path(), missing)))
            own_aov_folder_.emplace(*plan.aov_folder, kind);
        if (plan.aov_folder) {
            aovs_.emplace(*plan.aov_folder, scenes.first(), command.aovs);
            aovs_->set_manifest(manifest_path(*plan.aov_folder, FrameFiles::aovs), manifest_text(plan.aovs));
        }
        if (plan.segments) {
            plan.segments->open();
        } else if (plan.clip) {
            clip_ = std::make_unique<WholeClip>(*plan.clip, scenes.composition.width, scenes.composition.height,
                                                scenes.first().output.fps, plan.clip_options);
        }
    }

    /// Without clips of which all frames are kept.
    PipelineOutputs outputs() {
        return {folder_ && !plan_.frames.folder.empty() ? &*folder_ : nullptr,
                plan_.frames.video.empty() ? nullptr : sink(), aovs_ && !plan_.frames.aovs.empty() ? &*aovs_ : nullptr};
    }

    /// Completes outputs of which all frames are kept.
    void complete() {
        if (folder_) folder_->write_manifest();
        if (aovs_) aovs_->write_manifest();
        if (plan_.segments && plan_.frames.video.empty()) plan_.segments->finish();
    }

    void describe(RenderFigures& figures) {
        if (sink() == nullptr) return;
        figures.frames_in_clip = sink()->frames_in_clip();
        figures.frames_stored = sink()->frames_stored();
        figures.frame_step = plan_.format->frame_step;
    }

private:
    ClipSink* sink() { return plan_.segments ? plan_.segments.get() : clip_.get(); }

    RenderPlan& plan_;
    std::optional<FrameFolder> folder_, own_aov_folder_;
    std::optional<AovFolder> aovs_;
    std::unique_ptr<ClipSink> clip_;
};

}  // namespace

FrameOutputs RenderPlan::outputs(const RenderCommand& command) const {
    FrameOutputs outputs{std::nullopt,    folder.has_value(), command.aovs, command.drawing.transparent,
                         pictures.mark(), aovs.mark()};
    if (format) outputs.video = format->pixels;
    return outputs;
}

void RenderPlan::set_sound(const fs::path& file) {
    clip_options.sound = file;
    if (segments) segments->set_sound(file);
}

RenderPlan plan_render(const RenderCommand& command, const RenderScenes& scenes) {
    const double fps = scenes.first().output.fps;
    RenderPlan plan;
    plan.folder = command.frames;
    plan.aov_folder = folder_of_aovs(command);
    plan.clip = command.clip;
    plan.clip_options = command.clip_options;
    plan.clip_options.transparent = command.drawing.transparent;
    if (!plan.clip && !plan.folder && !plan.aov_folder)
        plan.clip = command.scenes.front().stem().string() + (command.drawing.transparent ? ".webm" : ".mp4");
    if (plan.clip) {
        plan.format = video_format(*plan.clip, fps, command.drawing.transparent);
        if (!scenes.frames.contiguous())
            throw InputError(
                fmt::format("--frames-range: a clip needs frames without gaps between them (given '{}'); "
                            "--frames takes any",
                            safe_text(*command.frames_range)));
        find_ffmpeg();
    }
    check_sound(command, plan);
    check_outputs(command, plan, scenes);

    plan.pictures = identity_of(scenes.scenes, drawing_settings(command, choices_of(command), scenes.composition));
    plan.pictures.frames = scenes.clip_frames;
    plan.pictures.fps = fps;
    plan.aovs = identity_of_aovs(plan.pictures, command.aovs);
    if (plan.folder)
        plan.frames.folder = missing_in(command, *plan.folder, FrameFiles::pictures, plan.pictures, scenes.frames);
    if (plan.aov_folder)
        plan.frames.aovs = missing_in(command, *plan.aov_folder, FrameFiles::aovs, plan.aovs, scenes.frames);
    if (plan.clip) plan.frames.video = scenes.frames;
    if (plan.clip && command.resume) {
        const ClipPicture picture{scenes.composition.width, scenes.composition.height, fps};
        plan.segments = std::make_unique<SegmentedClip>(*plan.clip, picture, plan.clip_options, plan.pictures,
                                                        scenes.frames, command.sound);
        plan.frames.video = plan.segments->missing();
    }
    plan.frames.drawn = plan.frames.folder.united_with(plan.frames.aovs).united_with(plan.frames.video);
    // Damage is drawn relative to the frame before, so that all earlier ones are drawn.
    if (scenes.shows_damage() && !plan.frames.drawn.empty() && command.start == 0.0)
        plan.frames.drawn = {0, plan.frames.drawn.end()};
    return plan;
}

RenderFigures render_to_files(const RenderCommand& command) {
    const double start = wall_seconds();
    const Shutter shutter = Shutter::of(command.shutter, command.blur_samples);
    RenderScenes scenes(command, shutter);
    const Composition& composition = scenes.composition;
    // All checks of the outputs come before the simulation and before anything is written.
    RenderPlan plan = plan_render(command, scenes);
    RenderFigures figures = figures_of(plan, scenes);
    Interrupt interrupt;  // before any thread or process is made
    std::optional<TemporaryFolder> sound_folder;
    if (plan.frames.drawn.empty()) {
        // A run that was ended after its last segment has left the joining, and the sound, to this one.
        if (command.sound && plan.segments && !plan.segments->finished()) {
            scenes.survey_clip({}, interrupt);
            write_sound(scenes, plan, sound_folder);
        }
        Destinations destinations(command, plan, scenes);
        destinations.complete();
        destinations.describe(figures);
        figures.seconds = wall_seconds() - start;
        return figures;
    }
    ClipMotion motion;
    if (command.from_checkpoints) {
        motion.checkpoints.emplace(open_checkpoints(*command.from_checkpoints, scenes));
        motion.state = motion.checkpoints->before(plan.frames.drawn.first());
    }

    RenderWork work{plan.outputs(command), std::nullopt, plan.to_draw(), shutter.blur_samples};
    const FrameOutputs& outputs = work.outputs;
    if (plan.format) work.clip = plan.format->kind;
    if (plan.segments) work.encoders = 2;
    const int requested_workers =
        scenes.shows_damage() ? 1 : int(std::min<std::int64_t>(command.workers, plan.to_draw()));
    const int workers = workers_that_fit(composition, work, requested_workers);
    if (workers < requested_workers && !command.quiet)
        say("note: {} render processes in place of {}, because there is no memory for more\n", workers,
            requested_workers);
    const int threads = command.threads.value_or(simulation_threads_beside_drawing(scenes.bodies(), machine_threads()));
    std::vector<std::string> notes(scenes.scenes.size());
    if (!command.from_checkpoints) {
        const bool keeps = shutter.blur_samples == 1 && !command.motion_record && !command.aovs.has(Aov::motion);
        const auto at_start = [&](std::size_t i, const World& world) {
            notes[i] = start_notes(*scenes.scenes[i].scene, world);
        };
        scenes.survey_clip({threads, outputs.image(), keeps ? most_kept_bytes : 0, at_start}, interrupt);
    }
    if (command.sound) write_sound(scenes, plan, sound_folder);
    // Before any thread. The processes open OpenGL while the bodies are built.
    RenderPool render_pool(composition, command.drawing, outputs, workers, shutter.blur_samples);
    motion.make_panels(scenes, outputs.image(), threads);
    if (!command.quiet) say_text(scenes.notes);
    if (!command.quiet) motion.say_overlaps_at_start(scenes, notes);
    std::optional<RunRecorder> recorder;
    if (command.motion_record) {
        recorder.emplace(composition, numbers_of(scenes.frames), scenes.frames.end());
        motion.record(*recorder);
    }
    AlikeRuns alike(command.vary);
    if (!command.vary.empty())
        for (std::size_t i = 0; i < motion.panels.size(); ++i)
            motion.panels[i].observers.push_back(&alike.add(scenes.scenes[i].label, *scenes.scenes[i].scene));
    const double outputs_open = wall_seconds();
    Destinations destinations(command, plan, scenes);
    Pipeline pipeline(motion.panels, plan.frames, render_pool, destinations.outputs(), shutter);
    if (motion.state) pipeline.go_on_from(*motion.state);
    std::optional<Trace> trace;
    if (command.profile) {
        trace.emplace();
        pipeline.record(*trace);
        trace->add({"set-up", start, wall_seconds()});
    }
    {
        Progress progress(plan.to_draw(), command.quiet);
        pipeline.run(interrupt, [&](std::int64_t done) { progress.update(done); });
    }
    if (!command.quiet) motion.say_broken_joints(scenes);
    if (!command.quiet) say_text(alike.warning());
    destinations.complete();
    if (recorder) write_motion_record(*command.motion_record, recorder->finish());
    if (trace) {
        if (plan.clip) trace->add({"ffmpeg", outputs_open, wall_seconds()}, "ffmpeg");
        trace->write(*command.profile);
    }
    const ProcessEnd workers_end = render_pool.finish();
    figures.drawn = render_pool.drawn();
    destinations.describe(figures);
    figures.workers = workers;
    figures.threads = threads;
    figures.cpu = cpu_seconds(pipeline.times(), destinations.outputs());
    figures.seconds = wall_seconds() - start;
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    figures.peak_memory = (used.ru_maxrss + workers_end.peak_memory / 1024) / 1024;
    return figures;
}

}  // namespace tumble
