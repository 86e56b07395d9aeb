#include "app/cli/commands.h"
#include "app/cli/progress.h"
#include "app/cli/say.h"
#include "app/files/frame_folder.h"
#include "app/files/output_plan.h"
#include "app/pipeline/pipeline.h"
#include "app/threads/bounded_queue.h"
#include "app/threads/interrupt.h"
#include "app/threads/task_group.h"
#include "app/workers/frame_memory.h"
#include "core/available_memory.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/png_reader.h"
#include "output/video_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t waiting_frames = 4;

/// Opening a pipe without a writer would wait.
void check_regular(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status))
        throw InputError({path.string(), 0, 0}, "is not a regular file, but a pipe or device");
}

/// Number of frames. Precondition: they are numbered from 0 without gaps and have one size; throws InputError naming a
/// file that violates it.
std::int64_t checked_frame_count(const fs::path& folder, ImageSize& size) {
    const std::vector<std::int64_t> numbers = frames_in(folder);
    if (numbers.empty())
        throw InputError({folder.string(), 0, 0},
                         "the folder holds no frames (frame_000000.png, frame_000001.png, ...)");
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto n = static_cast<std::int64_t>(i);
        const fs::path path = frame_path(folder, n);
        if (numbers[i] != n)
            throw InputError(
                {path.string(), 0, 0},
                fmt::format("the frame is missing (frames must be numbered without gaps from 0 to the last, {})",
                            frame_path(folder, numbers.back()).filename().string()));
        check_regular(path);
        const ImageSize this_size = read_png_size(path);
        if (i == 0) size = this_size;
        if (this_size != size)
            throw InputError({path.string(), 0, 0},
                             fmt::format("the frame is {} x {} pixels, but the first one is {} x {}", this_size.width,
                                         this_size.height, size.width, size.height));
    }
    return static_cast<std::int64_t>(numbers.size());
}

/// Bytes of at most this many frames: those in the queue, the one being read, and the one being written. ffmpeg holds
/// the last one in three copies: converted, passed on, and in the pipe.
std::uint64_t buffered_image_bytes(const ImageSize& size, const VideoFormat& format, std::int64_t frames) {
    const auto images = std::uint64_t(std::min<std::int64_t>(frames, waiting_frames + 2));
    return images * 4 * std::uint64_t(size.width) * std::uint64_t(size.height) +
           (1 + std::min<std::uint64_t>(images, 2)) * frame_bytes(format.pixels, size.width, size.height);
}

/// Reading and encoding overlap.
void encode(const fs::path& folder, std::int64_t frames, VideoWriter& video, Interrupt& interrupt, Progress& progress) {
    BoundedQueue<Image> images(waiting_frames);
    std::atomic<std::int64_t> done{0};
    TaskGroup stages;
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
    const VideoFormat format = video_format(command.clip, command.fps, command.transparent);
    ImageSize size;
    const std::int64_t frames = checked_frame_count(command.frames, size);
    OutputPlan plan;
    for (std::int64_t n = 0; n < frames; ++n) plan.add_input(frame_path(command.frames, n));
    plan.add("--output", command.clip);
    find_ffmpeg();
    const std::string what = fmt::format("encoding {} x {} pixels", size.width, size.height);
    const std::uint64_t buffered = buffered_image_bytes(size, format, frames);
    require_memory(buffered, what, "smaller frames take less");
    require_memory(buffered + encoder_memory(format.kind, size.width, size.height), shared_memory(), what,
                   "smaller frames take less");

    Interrupt interrupt;
    VideoWriter video(command.clip, size.width, size.height, command.fps,
                      {FrameTimes::constant_rate, command.quality, command.transparent});
    {
        Progress progress(frames, command.quiet);
        encode(command.frames, frames, video, interrupt, progress);
    }
    if (!command.quiet)
        say("wrote {}: {} frames of {} x {}\n", safe_path(command.clip), video.frames_in_clip(), size.width,
            size.height);
}

}  // namespace tumble
