#include "app/commands.h"
#include "app/interrupt.h"
#include "app/pipeline.h"
#include "app/progress.h"

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>

namespace tumble {
namespace {

namespace fs = std::filesystem;

// One compressor keeps up with three or four drawn frames at a time; more threads would only take cores from drawing.
constexpr int most_png_threads = 8;

/// What was written, and where the time went.
struct Summary {
    const SceneDescription& scene;
    const Pipeline& pipeline;
    const FrameFolder* folder;
    const VideoWriter* video;
    std::optional<fs::path> clip;
    double seconds;

    void print() const {
        const std::int64_t frames = scene.frame_count();
        if (video != nullptr)
            fmt::print(stderr, "wrote {}: {} frames of {} x {}{}\n", clip->string(), video->frames_in_clip(),
                       scene.output.width, scene.output.height, every_so_manieth(frames));
        if (folder != nullptr)
            fmt::print(stderr, "wrote {} to {}\n", frame_path(folder->path(), 0).string(),
                       frame_path(folder->path(), frames - 1).filename().string());
        print_times(frames);
        if (folder != nullptr) print_older_frames(frames);
    }

    std::string every_so_manieth(std::int64_t frames) const {
        if (video->frames_in_clip() == frames) return "";
        return fmt::format(" (every {}. of {}: the format holds no more)",
                           video_format(*clip, scene.output.fps).frame_step, frames);
    }

    void print_times(std::int64_t frames) const {
        const PipelineTimes& t = pipeline.times();
        std::string text = fmt::format("{:.2f} s, {:.1f} frames/s; at work: simulation {:.2f} s, drawing {:.2f} s",
                                       seconds, double(frames) / seconds, t.simulation.wall.load(),
                                       t.drawing.wall.load());
        if (folder != nullptr) text += fmt::format(", PNG {:.2f} s", t.png.wall.load());
        if (video != nullptr)
            text += fmt::format(", video {:.2f} s (ffmpeg: {:.2f} s of CPU)", t.video.wall.load(),
                                video->encoder_seconds());
        rusage used{};
        getrusage(RUSAGE_SELF, &used);
        fmt::print(stderr, "{}; peak memory {} MiB\n", text, used.ru_maxrss / 1024);
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
    const SceneDescription scene = load_scene(command.scene, command.overrides);
    std::optional<fs::path> clip = command.clip;
    if (!clip && !command.frames) clip = command.scene.stem().string() + ".mp4";

    // What can be wrong with the outputs is found out before anything is simulated or written.
    if (clip) {
        video_format(*clip, scene.output.fps);
        find_ffmpeg();
    }
    Interrupt interrupt;   // before any thread is made
    World world(scene, command.threads);
    std::optional<FrameFolder> folder;
    if (command.frames) folder.emplace(*command.frames);
    std::optional<VideoWriter> video;
    if (clip) video.emplace(*clip, scene.output.width, scene.output.height, scene.output.fps);

    InProcessDrawer drawer(scene, command.drawing);
    Pipeline pipeline(world, scene.frame_count(), drawer, folder ? &*folder : nullptr, video ? &*video : nullptr,
                      std::min(command.threads, most_png_threads));
    {
        Progress progress(scene.frame_count(), command.quiet);
        pipeline.run(interrupt, [&](std::int64_t done) { progress.update(done); });
    }
    if (!command.quiet)
        Summary{scene, pipeline, folder ? &*folder : nullptr, video ? &*video : nullptr, clip, wall_seconds() - start}
            .print();
}

}  // namespace tumble
