// What a clip's ending asks for: the container, the codec and its settings, as arguments of the ffmpeg program.
//
// .mp4 .mov .mkv   H.264 (x264), 4:2:0, BT.709: plays everywhere
// .webm            VP9, 4:2:0, BT.709
// .gif             256 colors chosen over the whole clip, at most 50 frames/s (players slow down beyond that)
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// A frame rate as containers keep it.
struct FrameRate {
    std::int64_t numerator = 60;     // frames
    std::int64_t denominator = 1;    // s
    std::string text() const;        // "30000/1001"
    friend bool operator==(const FrameRate&, const FrameRate&) = default;
};

/// The closest fraction with both parts at most a million (the most ffmpeg takes): 29.97 is 2997/100.
FrameRate to_frame_rate(double fps);

enum class VideoKind { h264, vp9, gif };

/// How ffmpeg gets the frames.
enum class PixelForm {
    yuv420,   // planes, see yuv420.h; an odd last column or row is there twice
    rgba,     // R, G, B and a byte of 255, row by row from the top
};

/// Of one frame made from a picture of this size.
std::size_t frame_bytes(PixelForm form, int width, int height);

/// How a picture that stays is kept.
enum class FrameTimes {
    longer_frames,   // once, shown longer (for a second at most): costs nothing
    constant_rate,   // again for every frame
};

/// What a clip keeps of its frames, at what cost in time and size: docs/explanation/output.md. All the same for a GIF.
enum class VideoQuality {
    draft,    // fast to make; leaves specks where something has passed
    normal,   // to show: a still background shows what was drawn a second after it came to rest
    best,     // the clip looks like its frames, enlarged as well
};

struct ClipOptions {
    FrameTimes times = FrameTimes::longer_frames;
    VideoQuality quality = VideoQuality::normal;
};

struct VideoFormat {
    VideoKind kind = VideoKind::h264;
    std::string container = "matroska";   // in ffmpeg's words: a link may lead to a name with another ending or none
    FrameRate rate;          // of the clip
    int frame_step = 1;      // only every so manieth frame enters the clip, where the format cannot hold them all
    PixelForm pixels = PixelForm::yuv420;
};

/// Throws InputError where the ending is unknown, or the format cannot keep so many or so few frames a second.
VideoFormat video_format(const std::filesystem::path& clip, double fps);

/// In place of the output below: ffmpeg's own standard output. By a name it would open, and empty, a file that stands there.
constexpr const char* clip_to_standard_output = "/dev/stdout";

/// Arguments that make ffmpeg read raw frames from its standard input (a matroska_stream.h) into `output`.
/// For a GIF that is a lossless clip, from which gif_arguments() makes the GIF: the best 256 colors are known only
/// when all frames are, and reading them twice keeps memory flat.
std::vector<std::string> encoding_arguments(const VideoFormat& format, const ClipOptions& options,
                                            const std::filesystem::path& output);
std::vector<std::string> gif_arguments(const std::filesystem::path& lossless, const std::filesystem::path& output);

}  // namespace tumble
