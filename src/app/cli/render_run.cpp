#include "app/cli/render_run.h"

#include "app/causes/run_recorder.h"
#include "app/causes/record_file.h"
#include "app/cli/progress.h"
#include "app/cli/render_scenes.h"
#include "app/cli/say.h"
#include "app/files/output_plan.h"
#include "app/pipeline/pipeline.h"
#include "app/threads/interrupt.h"
#include "app/threads/thread_budget.h"
#include "app/workers/frame_memory.h"
#include "core/error.h"

#include <sys/resource.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <system_error>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The folder of the AOVs, if any are requested.
std::optional<fs::path> aov_folder(const RenderCommand& command) {
    if (command.aovs.empty() && command.aov_folder)
        throw InputError("--aov-folder: needs --aov with the AOVs to write, as in --aov depth,normal");
    if (command.aovs.empty()) return std::nullopt;
    if (!command.aov_folder && !command.frames)
        throw InputError("--aov: needs --frames or --aov-folder for the folder to write to");
    return command.aov_folder ? command.aov_folder : command.frames;
}

/// Throws InputError if an output would replace another one or an input.
void check_outputs(const RenderCommand& command, const FileList& inputs, const FrameRange& frames,
                   const std::optional<fs::path>& clip, const std::optional<fs::path>& aovs_to) {
    OutputPlan plan;
    for (const fs::path& file : inputs) plan.add_input(file);
    if (clip) plan.add("--output", *clip);
    if (aovs_to && command.aovs.has(Aov::segmentation)) plan.add("--aov", segmentation_table_path(*aovs_to));
    if (command.report) plan.add("--report", *command.report);
    if (command.frames) plan.add({"--frames", *command.frames, "frame_", ".png", frame_path, frames.first, frames.end});
    if (aovs_to) plan.add({"--aov", *aovs_to, "aov_", ".npz", aov_path, frames.first, frames.end});
}

std::vector<std::int64_t> numbers_of(const FrameRange& frames) {
    std::vector<std::int64_t> numbers(std::size_t(frames.count()));
    std::iota(numbers.begin(), numbers.end(), frames.first);
    return numbers;
}

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

}  // namespace

RenderFigures render_to_files(const RenderCommand& command) {
    const double start = wall_seconds();
    const std::optional<fs::path> aovs_to = aov_folder(command);
    const Shutter shutter = Shutter::of(command.shutter, command.blur_samples);
    RenderScenes scenes(command, shutter);
    const Composition& composition = scenes.composition;
    const FrameRange& frames = scenes.frames;
    const double clip_fps = scenes.first().output.fps;
    std::optional<fs::path> clip = command.clip;
    if (!clip && !command.frames && !aovs_to)
        clip = command.scenes.front().stem().string() + (command.drawing.transparent ? ".webm" : ".mp4");

    // All checks of the outputs come before the simulation and before anything is written.
    RenderWork work{{std::nullopt, command.frames.has_value(), command.aovs, command.drawing.transparent},
                    std::nullopt,
                    frames.count(),
                    shutter.blur_samples};
    const FrameOutputs& outputs = work.outputs;
    if (clip) {
        const VideoFormat format = video_format(*clip, clip_fps, command.drawing.transparent);
        work.outputs.video = format.pixels;
        work.clip = format.kind;
        find_ffmpeg();
    }
    check_outputs(command, scenes.inputs, frames, clip, aovs_to);
    const int requested_workers =
        scenes.shows_damage() ? 1 : int(std::min<std::int64_t>(command.workers, frames.count()));
    const int workers = workers_that_fit(composition, work, requested_workers);
    if (workers < requested_workers && !command.quiet)
        say("note: {} render processes in place of {}, because there is no memory for more\n", workers,
            requested_workers);
    const int threads = command.threads.value_or(simulation_threads_beside_drawing(scenes.bodies(), machine_threads()));
    Interrupt interrupt;  // before any thread or process is made
    if (outputs.image()) scenes.survey_clip(threads, interrupt);
    // Before any thread. The processes open OpenGL while the bodies are built.
    RenderPool render_pool(composition, command.drawing, outputs, workers, shutter.blur_samples);
    std::vector<World> worlds;
    for (std::size_t i = 0; i < scenes.scenes.size(); ++i) worlds.push_back(scenes.world(i, threads));
    std::vector<PanelSource> panels;
    std::vector<std::unique_ptr<OverlayBuilder>> overlays;
    std::optional<RunRecorder> recorder;
    if (command.motion_record) recorder.emplace(composition, numbers_of(frames), frames.end);
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        overlays.push_back(outputs.image() ? scenes.overlay(i) : nullptr);
        panels.push_back({worlds[i], scenes.ends[i], overlays.back().get(), recorder ? &recorder->panel(i) : nullptr});
        if (recorder) worlds[i].record_contacts();
    }
    std::optional<FrameFolder> folder;
    if (command.frames) folder.emplace(*command.frames);
    std::optional<FrameFolder> own_aov_folder;
    std::error_code missing;
    if (aovs_to && !(folder && fs::equivalent(*aovs_to, folder->path(), missing))) own_aov_folder.emplace(*aovs_to);
    std::optional<AovFolder> aovs;
    if (aovs_to) aovs.emplace(*aovs_to, scenes.first(), command.aovs);
    std::optional<VideoWriter> video;
    if (clip) {
        ClipOptions clip_options = command.clip_options;
        clip_options.transparent = command.drawing.transparent;
        video.emplace(*clip, composition.width, composition.height, clip_fps, clip_options);
    }

    const PipelineOutputs destinations{folder ? &*folder : nullptr, video ? &*video : nullptr, aovs ? &*aovs : nullptr};
    Pipeline pipeline(panels, frames, render_pool, destinations, shutter);
    {
        Progress progress(frames.count(), command.quiet);
        pipeline.run(interrupt, [&](std::int64_t done) { progress.update(done); });
    }
    if (recorder) write_record(*command.motion_record, recorder->finish());
    const ProcessEnd workers_end = render_pool.finish();
    RenderFigures figures;
    figures.width = composition.width;
    figures.height = composition.height;
    figures.fps = clip_fps;
    figures.frames = frames;
    figures.drawn = render_pool.drawn();
    figures.clip = clip;
    figures.folder = command.frames;
    figures.aov_folder = aovs_to;
    if (video) {
        figures.frames_in_clip = video->frames_in_clip();
        figures.frames_stored = video->frames_stored();
        figures.frame_step = video_format(*clip, clip_fps, command.drawing.transparent).frame_step;
    }
    figures.workers = workers;
    figures.threads = threads;
    figures.cpu = cpu_seconds(pipeline.times(), destinations);
    figures.seconds = wall_seconds() - start;
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    figures.peak_memory = (used.ru_maxrss + workers_end.peak_memory / 1024) / 1024;
    return figures;
}

}  // namespace tumble
