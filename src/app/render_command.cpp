#include "app/commands.h"
#include "app/interrupt.h"
#include "app/pipeline.h"
#include "app/progress.h"
#include "app/speed.h"

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// What was written, and where the time went.
struct Summary {
    const SceneDescription& scene;
    const Pipeline& pipeline;
    const FrameFolder* folder;
    const VideoWriter* video;
    const Drawer& drawer;
    ProcessEnd workers_end;
    std::optional<fs::path> clip;
    double clip_fps;
    double seconds;

    void print() const {
        const std::int64_t frames = scene.frame_count();
        if (video != nullptr)
            fmt::print(stderr, "wrote {}: {} frames of {} x {}{}{}\n", clip->string(), video->frames_in_clip(),
                       scene.output.width, scene.output.height, every_so_manieth(frames), stored());
        if (folder != nullptr)
            fmt::print(stderr, "wrote {} to {}\n", frame_path(folder->path(), 0).string(),
                       frame_path(folder->path(), frames - 1).filename().string());
        print_times(frames);
        if (folder != nullptr) print_older_frames(frames);
    }

    std::string every_so_manieth(std::int64_t frames) const {
        if (video->frames_in_clip() == frames) return "";
        return fmt::format(" (every {}. of {}: the format holds no more)",
                           video_format(*clip, clip_fps).frame_step, frames);
    }

    std::string stored() const {
        if (video->frames_stored() == video->frames_in_clip()) return "";
        return fmt::format(", stored as {} (what does not change is shown longer)", video->frames_stored());
    }

    void print_times(std::int64_t frames) const {
        const PipelineTimes& t = pipeline.times();
        std::string text = fmt::format("{:.2f} s, {:.1f} frames/s; {} drawn; CPU: simulation {:.2f} s, drawing {:.2f} s",
                                       seconds, double(frames) / seconds, drawer.drawn(), t.simulation.cpu.load(),
                                       t.drawing.drawing.cpu.load());
        if (folder != nullptr) text += fmt::format(", PNG {:.2f} s", t.drawing.png.cpu.load() + t.files.cpu.load());
        if (video != nullptr)
            text += fmt::format(", conversion {:.2f} s, video {:.2f} s", t.drawing.conversion.cpu.load(),
                                t.video.cpu.load() + video->encoder_seconds());
        rusage used{};
        getrusage(RUSAGE_SELF, &used);
        fmt::print(stderr, "{}; peak memory {} MiB\n", text, (used.ru_maxrss + workers_end.peak_memory / 1024) / 1024);
    }

    /// Frames of an earlier, longer clip would be stitched to this one by `tumble encode`.
    void print_older_frames(std::int64_t frames) const {
        const std::vector<std::int64_t> there = frames_in(folder->path());
        const auto older = std::lower_bound(there.begin(), there.end(), frames);
        if (older != there.end())
            fmt::print(stderr, "note: {} older frames are still in the folder, from {} on\n", there.end() - older,
                       frame_path(folder->path(), *older).string());
    }
};

}  // namespace

void run_render(const RenderCommand& command) {
    const double start = wall_seconds();
    SceneDescription scene = load_scene(command.scene, command.overrides);
    const double clip_fps = scene.output.fps;
    apply_speed(scene, command.speed);   // from here on the scene's rate is that of the simulation
    const Shutter shutter = Shutter::of(command.shutter, command.blur_samples);
    std::optional<fs::path> clip = command.clip;
    if (!clip && !command.frames) clip = command.scene.stem().string() + ".mp4";

    // What can be wrong with the outputs is found out before anything is simulated or written.
    FrameForms forms{std::nullopt, command.frames.has_value()};
    if (clip) {
        forms.video = video_format(*clip, clip_fps).pixels;
        find_ffmpeg();
    }
    Interrupt interrupt;   // before any thread or process is made
    // Before any thread. They open OpenGL while the bodies are built.
    Drawer drawer(scene, command.drawing, forms, int(std::min<std::int64_t>(command.workers, scene.frame_count())),
                  shutter.moments);
    World world = [&] {
        SceneDescription in_parts = scene;   // no longer than needed: 30 MB for 100,000 bodies
        divide_frames(in_parts, shutter.parts);
        return World(in_parts, command.threads);
    }();
    std::optional<FrameFolder> folder;
    if (command.frames) folder.emplace(*command.frames);
    std::optional<VideoWriter> video;
    if (clip) video.emplace(*clip, scene.output.width, scene.output.height, clip_fps, command.times);

    Pipeline pipeline(world, scene.frame_count(), drawer, folder ? &*folder : nullptr, video ? &*video : nullptr,
                      shutter);
    {
        Progress progress(scene.frame_count(), command.quiet);
        pipeline.run(interrupt, [&](std::int64_t done) { progress.update(done); });
    }
    const ProcessEnd workers_end = drawer.finish();
    if (!command.quiet)
        Summary{scene, pipeline, folder ? &*folder : nullptr, video ? &*video : nullptr, drawer, workers_end, clip,
                clip_fps, wall_seconds() - start}
            .print();
}

}  // namespace tumble
