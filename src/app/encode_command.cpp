#include "app/bounded_queue.h"
#include "app/commands.h"
#include "app/frame_folder.h"
#include "app/interrupt.h"
#include "app/pipeline.h"
#include "app/progress.h"
#include "app/stage_group.h"
#include "core/error.h"
#include "output/png_reader.h"
#include "output/video_writer.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdio>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t waiting_frames = 4;

/// Number of frames, all there from 0 on and all of one size. Throws InputError naming the file that is not.
std::int64_t checked_frame_count(const fs::path& folder, PictureSize& size) {
    const std::vector<std::int64_t> numbers = frames_in(folder);
    if (numbers.empty())
        throw InputError({folder.string(), 0, 0}, "the folder holds no frames (frame_000000.png, frame_000001.png, ...)");
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto n = static_cast<std::int64_t>(i);
        const fs::path path = frame_path(folder, n);
        if (numbers[i] != n)
            throw InputError({path.string(), 0, 0},
                             fmt::format("the frame is missing (the frames must count from 0 to the last, {})",
                                         frame_path(folder, numbers.back()).filename().string()));
        const PictureSize this_size = read_png_size(path);
        if (i == 0) size = this_size;
        if (this_size != size)
            throw InputError({path.string(), 0, 0},
                             fmt::format("the frame is {} x {} pixels, but the first one is {} x {}", this_size.width,
                                         this_size.height, size.width, size.height));
    }
    return static_cast<std::int64_t>(numbers.size());
}

/// Reading and encoding overlap.
void encode(const fs::path& folder, std::int64_t frames, VideoWriter& video, Interrupt& interrupt, Progress& progress) {
    BoundedQueue<Image> images(waiting_frames);
    std::atomic<std::int64_t> done{0};
    StageGroup stages;
    stages.on_stop([&] {
        images.cancel();
        video.abandon();
    });
    stages.start([&] {
        for (std::int64_t n = 0; n < frames; ++n)
            if (!images.push(read_png(frame_path(folder, n)))) return;
        images.close();
    });
    stages.start([&] {
        while (const std::optional<Image> image = images.pop()) {
            video.write(*image);
            ++done;
        }
        if (done == frames) video.finish();
    });
    supervise(stages, interrupt, [&] { progress.update(done); });
}

}  // namespace

void run_encode(const EncodeCommand& command) {
    video_format(command.clip, command.fps);
    PictureSize size;
    const std::int64_t frames = checked_frame_count(command.frames, size);
    find_ffmpeg();

    Interrupt interrupt;
    VideoWriter video(command.clip, size.width, size.height, command.fps, {FrameTimes::constant_rate, command.quality});
    {
        Progress progress(frames, command.quiet);
        encode(command.frames, frames, video, interrupt, progress);
    }
    if (!command.quiet)
        fmt::print(stderr, "wrote {}: {} frames of {} x {}\n", command.clip.string(), video.frames_in_clip(), size.width,
                   size.height);
}

}  // namespace tumble
