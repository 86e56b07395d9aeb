// A clip, made by the ffmpeg program while frames are still being drawn: each goes through a pipe as it is finished.
//
// A picture that stays goes there once: its time stamp says how long it is shown (FrameTimes), but for once a second,
// so that players can jump, and at the end of the clip.
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

/// Where the ffmpeg program is. Throws RunError saying how to get it.
std::filesystem::path find_ffmpeg();

/// Writes frames in order; the clip appears under its name at finish(), or never. Not for several threads at once,
/// but for abandon().
class VideoWriter {
public:
    /// Of pictures of this size. Starts ffmpeg. Throws InputError for an ending or a rate that cannot be (see
    /// video_format()), RunError where ffmpeg is missing or the folder cannot be written.
    VideoWriter(const std::filesystem::path& clip, int width, int height, double fps, const ClipOptions& options = {});

    /// The next frame, as a picture. Throws RunError with ffmpeg's words when it died.
    void write(const Image& picture);
    /// The next frame, as the bytes of a VideoPixels; kept until the frame after it.
    void write(std::shared_ptr<const std::byte> pixels);
    /// The next frame is the same as the one before.
    void repeat();

    /// Waits for ffmpeg, looks whether the clip is whole (clip_check.h) and gives it its name. Throws RunError with ffmpeg's words
    /// where it is not.
    void finish();

    /// Stops ffmpeg at once, from any thread; a write() that waits comes back with an error.
    void abandon();

    /// What ffmpeg used, in s of CPU time; known after finish().
    double encoder_seconds() const { return encoder_seconds_; }
    /// Frames that the clip shows (a GIF takes 50 a second at most), and how many of them are stored.
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
    std::filesystem::path argument_of_clip() const;   // for ffmpeg

    std::filesystem::path clip_;
    VideoFormat format_;
    VideoPixels pixels_;                          // of pictures that come as such
    std::filesystem::path program_;
    TemporaryFile file_;
    std::optional<PartFile> lossless_;            // a GIF's first stage
    std::optional<EncoderReport> report_;         // of a clip that is written in place
    std::shared_ptr<const std::byte> latest_;     // the frame written last,
    std::shared_ptr<const std::byte> shown_;      // and the one sent last (a GIF takes fewer); null before the first
    std::int64_t longest_;                        // frames that one is shown for, at most
    std::int64_t frames_ = 0, frames_in_clip_ = 0, sent_ = 0;
    std::int64_t last_sent_ = -1;                 // its number in the clip
    double encoder_seconds_ = 0.0;
    std::mutex abandon_mutex_;                    // abandon() against the change from encoder to GIF maker
    bool abandoned_ = false;
    std::optional<Process> encoder_, gif_maker_;  // last: they end before their files are removed
};

}  // namespace tumble
