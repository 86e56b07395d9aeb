// A clip, encoded by the ffmpeg program while later frames are drawn: each frame goes through a pipe when it is
// finished.
//
// An unchanged image is sent once: its time stamp defines how long it is shown (FrameTimes). It is repeated once per
// second, so that players can seek, and at the end of the clip.
#pragma once

#include "core/image.h"
#include "output/encoder_report.h"
#include "output/process.h"
#include "output/temporary_file.h"
#include "output/video_format.h"
#include "output/video_pixels.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// Path of the ffmpeg program. Throws RunError with the remedy if it is missing.
std::filesystem::path find_ffmpeg();

/// Writes frames in order; the clip appears under its name at finish(), or never. Not for several threads at once,
/// except for abandon().
class VideoWriter {
public:
    /// Starts ffmpeg, for images of this size. Throws InputError for an invalid ending or rate (see video_format()),
    /// RunError if ffmpeg is missing or the folder cannot be written.
    VideoWriter(const std::filesystem::path& clip, int width, int height, double fps, const ClipOptions& options = {});
    /// The same in a format that the clip's name does not tell; `fps`: of the frames.
    VideoWriter(const std::filesystem::path& clip, int width, int height, double fps, const VideoFormat& format,
                const ClipOptions& options);

    /// The next frame, as a image. Throws RunError with ffmpeg's message if it died.
    void write(const Image& image);
    /// The next frame, as the bytes of a VideoPixels; held until the frame after it.
    void write(std::shared_ptr<const std::byte> pixels);
    /// The next frame equals the previous one.
    void repeat();

    /// Waits for ffmpeg, checks that the clip is complete (clip_check.h) and renames it to its final name. Throws
    /// RunError with ffmpeg's message if it is not.
    void finish();

    /// Stops ffmpeg at once, from any thread; a waiting write() then throws an error.
    void abandon();

    /// CPU time of ffmpeg, s; known after finish().
    double encoder_seconds() const { return encoder_seconds_; }
    /// Frames that the clip shows (of a GIF at most 50 per second), and the number of stored ones.
    std::int64_t frames_in_clip() const { return frames_in_clip_; }
    std::int64_t frames_stored() const { return sent_; }

private:
    std::vector<std::string> with_report(std::vector<std::string> arguments) const;
    void check_clip(const std::string& container, const ProcessEnd& end) const;
    void check_file(const std::filesystem::path& file, const std::string& container, const ProcessEnd& end) const;
    [[noreturn]] void fail(const ProcessEnd& end) const;
    [[noreturn]] void fail(const ProcessEnd& end, const std::string& how) const;
    void advance();
    void send(std::int64_t frame);
    void send(std::span<const std::byte> bytes);
    void convert_to_gif();
    std::filesystem::path output_argument() const;  // argument for ffmpeg

    std::filesystem::path clip_;
    VideoFormat format_;
    VideoPixels pixels_;  // of frames that arrive as images
    std::filesystem::path program_;
    TemporaryFile file_;
    std::optional<PartFile> lossless_;         // a GIF's first stage
    std::optional<EncoderReport> report_;      // of a clip that is written in place
    std::shared_ptr<const std::byte> latest_;  // the frame written last,
    std::shared_ptr<const std::byte> shown_;  // and the one sent last (of a GIF, fewer are sent); null before the first
    std::int64_t longest_;                    // largest number of frames for which one image is shown
    std::int64_t frames_ = 0, frames_in_clip_ = 0, sent_ = 0;
    std::int64_t last_sent_ = -1;  // its number in the clip
    double encoder_seconds_ = 0.0;
    std::mutex abandon_mutex_;  // guards abandon() against the change from encoder to GIF maker
    bool abandoned_ = false;
    std::optional<Process> encoder_, gif_maker_;  // last: they end before their files are removed
};

}  // namespace tumble
