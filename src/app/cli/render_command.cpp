#include "app/cli/commands.h"
#include "app/cli/progress.h"
#include "app/cli/render_scenes.h"
#include "app/cli/say.h"
#include "app/files/output_plan.h"
#include "app/pipeline/pipeline.h"
#include "app/threads/interrupt.h"
#include "app/threads/thread_budget.h"
#include "app/workers/frame_memory.h"
#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// Outputs of a run, and the time that its stages took.
struct Summary {
    const Composition& composition;
    const FrameRange& frames;
    const Pipeline& pipeline;
    const PipelineOutputs& outputs;
    const RenderPool& render_pool;
    ProcessEnd workers_end;
    std::optional<fs::path> clip;
    double clip_fps;
    double seconds;

    void print() const {
        if (outputs.video != nullptr)
            say("wrote {}: {} frames of {} x {}{}{}\n", safe_path(*clip), outputs.video->frames_in_clip(),
                composition.width, composition.height, frame_step_note(), stored());
        if (outputs.folder != nullptr)
            say("wrote {} to {}\n", safe_path(frame_path(outputs.folder->path(), frames.first)),
                frame_path(outputs.folder->path(), frames.end - 1).filename().string());
        if (outputs.aovs != nullptr)
            say("wrote {} to {}: {}\n", safe_path(aov_path(outputs.aovs->path(), frames.first)),
                aov_path(outputs.aovs->path(), frames.end - 1).filename().string(), names_of(outputs.aovs->aovs()));
        print_times();
        if (outputs.folder != nullptr)
            print_older("frames", frames_in(outputs.folder->path()), outputs.folder->path(), frame_path);
        if (outputs.aovs != nullptr) print_older("AOVs", aovs_in(outputs.aovs->path()), outputs.aovs->path(), aov_path);
    }

    std::string frame_step_note() const {
        if (outputs.video->frames_in_clip() == frames.count()) return "";
        return fmt::format(" (one in {} of {}: the format holds no more)", video_format(*clip, clip_fps).frame_step,
                           frames.count());
    }

    std::string stored() const {
        if (outputs.video->frames_stored() == outputs.video->frames_in_clip()) return "";
        return fmt::format(", stored as {} (unchanged pictures are shown longer)", outputs.video->frames_stored());
    }

    void print_times() const {
        const PipelineTimes& t = pipeline.times();
        std::string text =
            fmt::format("{:.2f} s, {:.1f} frames/s; {} drawn; CPU: simulation {:.2f} s, drawing {:.2f} s", seconds,
                        double(frames.count()) / seconds, render_pool.drawn(), t.simulation.cpu.load(),
                        t.drawing.drawing.cpu.load());
        if (outputs.folder != nullptr)
            text += fmt::format(", PNG {:.2f} s", t.drawing.png.cpu.load() + t.files.cpu.load());
        if (outputs.aovs != nullptr)
            text += fmt::format(", AOVs {:.2f} s", t.drawing.aovs.cpu.load() + t.aov_files.cpu.load());
        if (outputs.video != nullptr)
            text += fmt::format(", conversion {:.2f} s, video {:.2f} s", t.drawing.conversion.cpu.load(),
                                t.video.cpu.load() + outputs.video->encoder_seconds());
        rusage used{};
        getrusage(RUSAGE_SELF, &used);
        say("{}; peak memory {} MiB\n", text, (used.ru_maxrss + workers_end.peak_memory / 1024) / 1024);
    }

    /// Warns of frames of an earlier, longer clip, because `tumble encode` would append them to this one.
    void print_older(const char* what, const std::vector<std::int64_t>& there, const fs::path& where,
                     fs::path (&path)(const fs::path&, std::int64_t)) const {
        const auto older = std::lower_bound(there.begin(), there.end(), frames.end);
        if (older != there.end())
            say("note: {} older {} are still in the folder, from {} on\n", there.end() - older, what,
                safe_path(path(where, *older)));
    }
};

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
    if (command.frames) plan.add({"--frames", *command.frames, "frame_", ".png", frame_path, frames.first, frames.end});
    if (aovs_to) plan.add({"--aov", *aovs_to, "aov_", ".npz", aov_path, frames.first, frames.end});
}

}  // namespace

void run_render(const RenderCommand& command) {
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
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        overlays.push_back(outputs.image() ? scenes.overlay(i) : nullptr);
        panels.push_back({worlds[i], scenes.ends[i], overlays.back().get()});
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
    const ProcessEnd workers_end = render_pool.finish();
    if (!command.quiet)
        Summary{composition, frames, pipeline, destinations,          render_pool,
                workers_end, clip,   clip_fps, wall_seconds() - start}
            .print();
}

}  // namespace tumble
