#include "app/cli/command.h"
#include "app/cli/progress.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/files/frame_folder.h"
#include "app/files/output_plan.h"
#include "app/pipeline/pipeline.h"
#include "app/resume/kept_frames.h"
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
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

struct EncodeCommand {
    std::filesystem::path frames;  // folder
    std::filesystem::path clip;
    std::optional<double> fps;   // without this, that of the run that drew the frames, or 60
    bool allow_missing = false;  // frames may be missing: the others follow each other
    bool transparent = false;    // the clip keeps the alpha of the frames
    VideoQuality quality = VideoQuality::normal;
    bool quiet = false;
};

constexpr std::size_t waiting_frames = 4;
constexpr double default_fps = 60.0;

struct FramesToEncode {
    std::vector<std::int64_t> numbers;  // ascending
    ImageSize size;                     // of all

    std::int64_t count() const { return std::int64_t(numbers.size()); }
};

/// Opening a pipe without a writer would wait.
void check_regular(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status))
        throw InputError({path.string(), 0, 0}, "is not a regular file, but a pipe or device");
}

/// The frames that the run which drew them promised, but that are not there, are an InputError.
void require_whole_clip(const fs::path& folder, const FrameIdentity& manifest,
                        const std::vector<std::int64_t>& numbers) {
    const auto is_there = [&](std::int64_t n) { return std::ranges::binary_search(numbers, n); };
    const FrameSet missing = FrameSet(0, manifest.frames).where([&](std::int64_t n) { return !is_there(n); });
    if (!missing.empty())
        throw InputError({folder.string(), 0, 0},
                         fmt::format("{} of the clip's {} frames are missing: {} (render --resume draws them, "
                                     "--allow-missing encodes the others)",
                                     missing.count(), manifest.frames, missing.text()));
}

void require_no_gaps(const fs::path& folder, const std::vector<std::int64_t>& numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (numbers[i] != std::int64_t(i))
            throw InputError(
                {frame_path(folder, std::int64_t(i)).string(), 0, 0},
                fmt::format("the frame is missing (frames must be numbered without gaps from 0 to the last, {}, or "
                            "--allow-missing must be given)",
                            frame_path(folder, numbers.back()).filename().string()));
}

/// Throws InputError for a frame of another size than the first one, or that is drawn from another scene than the
/// folder's.
void check_frames(const fs::path& folder, const std::optional<FrameIdentity>& manifest, const FramesToEncode& frames) {
    const std::string mark = manifest ? manifest->mark() : "";
    for (const std::int64_t n : frames.numbers) {
        const fs::path path = frame_path(folder, n);
        check_regular(path);
        const ImageSize size = read_png_size(path);
        if (size != frames.size)
            throw InputError({path.string(), 0, 0},
                             fmt::format("the frame is {} x {} pixels, but the first one is {} x {}", size.width,
                                         size.height, frames.size.width, frames.size.height));
        if (manifest && mark_of_png(path).value_or(mark) != mark)
            throw InputError({path.string(), 0, 0},
                             "the frame is of another scene, other settings or another version than the folder's "
                             "frames.json says; delete it, or render the folder anew");
    }
}

FramesToEncode frames_to_encode(const EncodeCommand& command, const std::optional<FrameIdentity>& manifest) {
    FramesToEncode frames{frames_in(command.frames), {}};
    if (frames.numbers.empty())
        throw InputError({command.frames.string(), 0, 0},
                         "the folder holds no frames (frame_000000.png, frame_000001.png, ...)");
    if (!command.allow_missing) {
        if (manifest) require_whole_clip(command.frames, *manifest, frames.numbers);
        require_no_gaps(command.frames, frames.numbers);
    }
    const fs::path first = frame_path(command.frames, frames.numbers.front());
    check_regular(first);
    frames.size = read_png_size(first);
    check_frames(command.frames, manifest, frames);
    return frames;
}

/// Bytes of at most this many frames: the frames in the queue, the one being read, and the one being written. ffmpeg
/// holds the last one in three copies: converted, passed on, and in the pipe.
std::uint64_t buffered_image_bytes(const ImageSize& size, const VideoFormat& format, std::int64_t frames) {
    const auto images = std::uint64_t(std::min<std::int64_t>(frames, waiting_frames + 2));
    return images * 4 * std::uint64_t(size.width) * std::uint64_t(size.height) +
           (1 + std::min<std::uint64_t>(images, 2)) * frame_bytes(format.pixels, size.width, size.height);
}

/// Reading and encoding overlap.
void encode(const fs::path& folder, const FramesToEncode& frames, VideoWriter& video, Interrupt& interrupt,
            Progress& progress) {
    BoundedQueue<Image> images(waiting_frames);
    std::atomic<std::int64_t> done{0};
    TaskGroup stages;
    stages.on_stop([&] {
        images.cancel();
        video.abandon();
    });
    stages.start([&] {
        for (const std::int64_t n : frames.numbers)
            if (!images.push(read_png(frame_path(folder, n)))) return;
        images.close();
    });
    stages.start([&] {
        while (const std::optional<Image> image = images.pop()) {
            video.write(*image);
            ++done;
        }
        if (done == frames.count()) video.finish();
    });
    supervise(stages, interrupt, [&] { progress.update(done); });
}

void run_encode(const EncodeCommand& command) {
    const std::optional<FrameIdentity> manifest = read_manifest(manifest_path(command.frames, FrameFiles::pictures));
    const double fps = command.fps.value_or(manifest ? manifest->fps : default_fps);
    const VideoFormat format = video_format(command.clip, fps, command.transparent);
    const FramesToEncode frames = frames_to_encode(command, manifest);
    const ImageSize size = frames.size;
    OutputPlan plan;
    for (const std::int64_t n : frames.numbers) plan.add_input(frame_path(command.frames, n));
    plan.add_input(manifest_path(command.frames, FrameFiles::pictures));
    plan.add("--output", command.clip);
    find_ffmpeg();
    const std::string what = fmt::format("encoding {} x {} pixels", size.width, size.height);
    const std::uint64_t buffered = buffered_image_bytes(size, format, frames.count());
    require_memory(buffered, what, "smaller frames take less");
    require_memory(buffered + encoder_memory(format.kind, size.width, size.height), shared_memory(), what,
                   "smaller frames take less");

    Interrupt interrupt;
    VideoWriter video(command.clip, size.width, size.height, fps,
                      {FrameTimes::constant_rate, command.quality, command.transparent});
    {
        Progress progress(frames.count(), command.quiet);
        encode(command.frames, frames, video, interrupt, progress);
    }
    if (!command.quiet)
        say("wrote {}: {} frames of {}\n", safe_path(command.clip), video.frames_in_clip(),
            size_text(format.kind, {size.width, size.height}));
}

}  // namespace

void add_encode(Command& command) {
    EncodeCommand& c = command.keep<EncodeCommand>();
    command.add_option("frames", c.frames, "The folder with frame_000000.png, frame_000001.png and so on")
        ->required()
        ->check(folder_name())
        ->type_name("DIR");
    command.add_option("-o,--output", c.clip, "The clip to write: .mp4 .mov .mkv .webm or .gif")
        ->required()
        ->check(file_name("mp4 mov mkv webm gif"))
        ->type_name("CLIP");
    add_fps(command, c.fps,
            "Frames per second, in place of that of the run that drew the frames (frames.json in\n"
            "the folder; without it 60)");
    command.add_flag("--allow-missing", c.allow_missing,
                     "Encode the frames that are there. Without this, a folder with missing frames is refused");
    command.add_flag("--transparent", c.transparent,
                     "Keep the alpha of the frames (.webm and .mov); without this it is left out");
    add_quality(command, c.quality);
    command.add_flag("--quiet", c.quiet, "Print errors only");
    command.examples = "  tumble encode out -o clip.mp4 --fps 30";
    command.logs = true;
    command.run = [&c] {
        run_encode(c);
        return 0;
    };
}

}  // namespace tumble
