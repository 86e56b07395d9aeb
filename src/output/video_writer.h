// A clip, made by the ffmpeg program while frames are still being drawn: each goes through a pipe as it is finished.
#pragma once

#include "core/image.h"
#include "output/process.h"
#include "output/temporary_file.h"
#include "output/video_format.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <vector>

namespace tumble {

/// Where the ffmpeg program is. Throws RunError saying how to get it.
std::filesystem::path find_ffmpeg();

/// Writes frames in order; the clip appears under its name at finish(), or never. Not for several threads at once,
/// but for abandon().
class VideoWriter {
public:
    /// Starts ffmpeg. Throws InputError for an ending or a rate that cannot be (see video_format()), RunError where
    /// ffmpeg is missing or the folder cannot be written.
    VideoWriter(const std::filesystem::path& clip, int width, int height, double fps);

    /// The next frame, of the size above. Throws RunError with ffmpeg's words when it died.
    void write(const Image& frame);

    /// Waits for ffmpeg and gives the clip its name. Throws RunError with ffmpeg's words where it failed.
    void finish();

    /// Stops ffmpeg at once, from any thread; a write() that waits comes back with an error.
    void abandon();

    /// What ffmpeg used, in s of CPU time; known after finish().
    double encoder_seconds() const { return encoder_seconds_; }
    /// Frames that are in the clip (a GIF takes 50 a second at most).
    std::int64_t frames_in_clip() const { return frames_in_clip_; }

private:
    [[noreturn]] void fail(const ProcessEnd& end) const;
    const std::vector<std::uint8_t>& padded(const Image& frame);
    void convert_to_gif();

    std::filesystem::path clip_;
    VideoFormat format_;
    int width_, height_;                          // of the frames
    int clip_width_, clip_height_;                // of the clip: even where it must be
    std::filesystem::path program_;
    TemporaryFile file_;
    std::optional<TemporaryFile> lossless_;       // a GIF's first stage
    std::vector<std::uint8_t> padded_;
    std::int64_t frames_ = 0, frames_in_clip_ = 0;
    double encoder_seconds_ = 0.0;
    std::mutex abandon_mutex_;                    // abandon() against the change from encoder to GIF maker
    bool abandoned_ = false;
    std::optional<Process> encoder_, gif_maker_;  // last: they end before their files are removed
};

}  // namespace tumble
