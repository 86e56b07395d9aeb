// From the ending of a clip's name to the container, the codec and its settings, as arguments of the ffmpeg program.
//
// .mp4 .mov .mkv   H.264 (x264), 4:2:0, BT.709: plays everywhere
// .webm            VP9, 4:2:0, BT.709; with alpha as a second stream of VP9
// .mov with alpha  ProRes 4444, 4:4:4, BT.709: the form of video editors
// .gif             256 colors chosen over the whole clip, at most 50 frames/s (players slow down beyond that)
#pragma once

#include "core/frame_rate.h"
#include "core/image.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

enum class VideoKind { h264, vp9, gif, vp9_alpha, prores_4444 };

/// Form in which ffmpeg receives the frames.
enum class PixelFormat {
    yuv420,   // planes, see yuv420.h; an odd last column or row is duplicated
    yuva420,  // the same and alpha, see yuv420.h
    rgba,     // R, G, B and alpha, row by row from the top
};

/// True for forms with half as many columns and rows of color, which need an even size.
bool is_subsampled(PixelFormat form);

/// The size of the pictures in a file, for images of that size. H.264 stores half as many colors in each direction and
/// has even sides: the last column or row of an odd one is there twice. Other kinds keep odd sides.
ImageSize stored_size(VideoKind kind, const ImageSize& images);

/// "640 x 360", or for odd sides "162 x 122 (161 x 121 and ...)".
std::string size_text(VideoKind kind, const ImageSize& images);

/// Size of one frame of an image of this size.
std::size_t frame_bytes(PixelFormat form, int width, int height);

/// Storage of a image that stays unchanged.
enum class FrameTimes {
    longer_frames,  // once, shown longer (for a second at most): costs little
    constant_rate,  // repeated for every frame
};

/// Quality of a clip, with its cost in time and size: docs/explanation/output.md. Without effect on a GIF.
enum class VideoQuality {
    draft,   // fast to encode; leaves specks behind moving bodies
    normal,  // for viewing: a still background is correct a second after it came to rest
    best,    // the clip looks like its frames, also when enlarged
    small,   // for a film within a page: a fifth of the bytes of normal, at most 300 kbit/s
};

struct ClipOptions {
    FrameTimes times = FrameTimes::longer_frames;
    VideoQuality quality = VideoQuality::normal;
    bool transparent = false;          // the clip keeps the alpha of the images
    std::filesystem::path sound = {};  // a WAV file; empty: a clip without sound
};

struct VideoFormat {
    VideoKind kind = VideoKind::h264;
    std::string container =
        "matroska";      // in ffmpeg's terms, because a link may lead to a name with another ending or none
    FrameRate rate;      // of the clip
    int frame_step = 1;  // 1, or more to drop frames if the format cannot hold all of them
    PixelFormat pixels = PixelFormat::yuv420;
    bool lossless_stage = false;  // of a GIF: only the lossless clip that it is made from
};

/// Throws InputError if the ending is unknown, or the format cannot hold this frame rate or, if needed, alpha.
VideoFormat video_format(const std::filesystem::path& clip, double fps, bool transparent = false);

/// Output argument for ffmpeg's own standard output. By a file name, ffmpeg would open and truncate an existing file.
constexpr const char* clip_to_standard_output = "/dev/stdout";

/// Arguments that make ffmpeg read raw frames of images of that size from its standard input (a matroska_stream.h) into
/// `output`. For a GIF that is a lossless clip, from which gif_arguments() makes the GIF: the best 256 colors are known
/// only when all frames are, and reading them twice keeps memory constant.
std::vector<std::string> encoding_arguments(const VideoFormat& format, const ClipOptions& options,
                                            const ImageSize& images, const std::filesystem::path& output);
std::vector<std::string> gif_arguments(const std::filesystem::path& lossless, const std::filesystem::path& output);

/// The format of a segment of a clip of this format, and the ending of its name. Segments have exact times where the
/// container allows.
VideoFormat segment_format(const VideoFormat& format);
std::string segment_ending(const VideoFormat& format);

/// Arguments that make ffmpeg join the segments of a list (of its concat demuxer) into `output`, without encoding them
/// again, or into a GIF. `comment`: in the clip's metadata, except in a GIF.
std::vector<std::string> join_arguments(const VideoFormat& format, const std::filesystem::path& list,
                                        const std::filesystem::path& output, const std::string& comment,
                                        const std::filesystem::path& sound);

}  // namespace tumble
