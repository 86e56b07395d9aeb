#include "output/video_format.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/codec_settings.h"
#include "output/output_target.h"
#include "output/yuv420.h"
#include "output/yuva420.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace tumble {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

constexpr double slowest = 0.001;            // frames/s: players do not support longer frames, GIF at most 655 s
constexpr double fastest = 1e6;              // frames/s: the scene format's own limit
constexpr double fastest_matroska = 1000.0;  // its time stamps are whole milliseconds
constexpr double fastest_gif = 50.0;         // its delays are whole 1/100 s, and players treat 1 as 10

void append(Arguments& to, const Arguments& more) { to.insert(to.end(), more.begin(), more.end()); }

/// ffmpeg takes "name:rest" for a protocol and a leading "-" for an option; this form is always a file.
std::string file_argument(const fs::path& path) {
    return path == clip_to_standard_output ? "pipe:1" : "file:" + path.string();
}

/// Without -xerror, ffmpeg 5.1 ends with exit code 0 if the disk was full at the end of the clip.
Arguments common() { return {"-hide_banner", "-nostdin", "-loglevel", "error", "-xerror", "-y"}; }

bool has_its_head_last(const VideoFormat& format) { return format.container == "mp4" || format.container == "mov"; }

Arguments gif_from(const Arguments& input, const fs::path& output) {
    Arguments arguments = common();
    append(arguments, input);
    append(arguments, input);
    append(arguments, {"-filter_complex",
                       // An ordered pattern does not move between frames, and still regions compress well. Coarser
                       // patterns (a smaller scale) hide the ground's lines.
                       "[0]palettegen[palette];[1][palette]paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle",
                       "-map_metadata", "-1", "-fflags", "+bitexact", "-f", "gif", file_argument(output)});
    return arguments;
}

}  // namespace

ImageSize stored_size(VideoKind kind, const ImageSize& images) {
    if (kind != VideoKind::h264) return images;
    return {images.width + images.width % 2, images.height + images.height % 2};
}

std::string size_text(VideoKind kind, const ImageSize& images) {
    const ImageSize stored = stored_size(kind, images);
    std::string text = fmt::format("{} x {}", stored.width, stored.height);
    if (stored == images) return text;
    const char* const twice = stored.width == images.width     ? "row"
                              : stored.height == images.height ? "column"
                                                               : "column and row";
    return text +
           fmt::format(" ({} x {} with the last {} twice: H.264 has even sizes)", images.width, images.height, twice);
}

bool is_subsampled(PixelFormat form) { return form != PixelFormat::rgba; }

std::size_t frame_bytes(PixelFormat form, int width, int height) {
    if (form == PixelFormat::yuv420) return yuv420_bytes(width + width % 2, height + height % 2);
    if (form == PixelFormat::yuva420) return yuva420_bytes(width + width % 2, height + height % 2);
    return 4 * std::size_t(width) * std::size_t(height);
}

VideoFormat video_format(const fs::path& clip, double fps, bool transparent) {
    std::string ending = clip.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    const SourceLocation at{clip.string(), 0, 0};

    VideoFormat format;
    double limit = fastest;
    if (ending == ".mp4" || ending == ".mov")
        format.container = ending.substr(1);
    else if (ending == ".mkv")
        limit = fastest_matroska;
    else if (ending == ".webm") {
        format.kind = VideoKind::vp9;
        format.container = "webm";
        limit = fastest_matroska;
    } else if (ending == ".gif") {
        format.kind = VideoKind::gif;
        format.pixels = PixelFormat::rgba;
    } else
        throw InputError(at, fmt::format("unknown kind of clip: the name must end in .mp4, .mov, .mkv, .webm or .gif "
                                         "(the ending was '{}')",
                                         safe_text(ending)));
    if (transparent) {
        if (ending != ".webm" && ending != ".mov")
            throw InputError(at,
                             fmt::format("a {} clip holds no transparency: .webm (for browsers and slides) and .mov "
                                         "(for video editors) do, and the PNG files of --frames",
                                         ending));
        format.kind = ending == ".mov" ? VideoKind::prores_4444 : VideoKind::vp9_alpha;
        format.pixels = ending == ".mov" ? PixelFormat::rgba : PixelFormat::yuva420;
    }
    if (!(fps >= slowest && fps <= limit))
        throw InputError(
            at,
            fmt::format(
                "a {} clip holds {} to {} frames a second ({} were asked for{})", ending, slowest, limit, fps_text(fps),
                limit < fps && fps <= fastest ? (transparent ? "; .mov holds more" : "; .mp4 holds more") : ""));

    if (has_its_head_last(format) && is_written_in_place(clip))
        throw InputError(at,
                         fmt::format("a {} clip cannot be written into a pipe or device, for its head is written last; "
                                     "{} can",
                                     ending, transparent ? ".webm" : ".mkv, .webm and .gif"));
    if (format.kind == VideoKind::gif) format.frame_step = std::max(1, int(std::ceil(fps / fastest_gif - 1e-9)));
    format.rate = to_frame_rate(fps / format.frame_step);
    return format;
}

Arguments encoding_arguments(const VideoFormat& format, const ClipOptions& options, const ImageSize& images,
                             const fs::path& output) {
    Arguments arguments = common();
    append(arguments, {"-f", "matroska", "-i", "pipe:0", "-an", "-r", format.rate.text(), "-fps_mode", "vfr"});
    const bool odd = images.width % 2 != 0 || images.height % 2 != 0;
    if (odd && is_subsampled(format.pixels) && stored_size(format.kind, images) == images)
        append(arguments, {"-vf", fmt::format("crop={}:{}:0:0:exact=1", images.width, images.height)});
    if (format.kind == VideoKind::prores_4444)
        // To the same color space as yuv420.h, with the same bytes on every processor. The encoder takes the tags from
        // the frames.
        append(arguments, {"-vf",
                           "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int+bitexact,"
                           "setparams=colorspace=bt709:color_primaries=bt709:color_trc=bt709:range=tv"});
    if (format.kind != VideoKind::gif)
        // Without the tags players would show other colors.
        append(arguments, {"-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range",
                           "tv", "-chroma_sample_location", "center"});
    append(arguments, codec_arguments(format.kind, options));
    // No dates and versions in the file: the same frames give the same bytes.
    append(arguments, {"-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact"});
    if (has_its_head_last(format)) append(arguments, {"-movflags", "+faststart"});  // playable during download
    append(arguments, {"-f", format.container, file_argument(output)});
    return arguments;
}

Arguments gif_arguments(const fs::path& lossless, const fs::path& output) {
    return gif_from({"-i", file_argument(lossless)}, output);
}

VideoFormat segment_format(const VideoFormat& format) {
    VideoFormat segment = format;
    if (format.kind == VideoKind::h264) segment.container = "mp4";
    segment.lossless_stage = format.kind == VideoKind::gif;
    return segment;
}

std::string segment_ending(const VideoFormat& format) {
    const VideoFormat segment = segment_format(format);
    return segment.container == "matroska" ? ".mkv" : "." + segment.container;
}

Arguments join_arguments(const VideoFormat& format, const fs::path& list, const fs::path& output,
                         const std::string& comment) {
    const Arguments input = {"-f", "concat", "-safe", "0", "-i", file_argument(list)};
    if (format.kind == VideoKind::gif) return gif_from(input, output);
    Arguments arguments = common();
    append(arguments, input);
    append(arguments, {"-map", "0:v", "-c", "copy", "-map_metadata", "-1", "-metadata", "comment=" + comment});
    // The alpha is beside the pictures; players look for it where this says so.
    if (format.kind == VideoKind::vp9_alpha) append(arguments, {"-metadata:s:v", "alpha_mode=1"});
    append(arguments, {"-fflags", "+bitexact"});
    if (has_its_head_last(format)) append(arguments, {"-movflags", "+faststart"});
    append(arguments, {"-f", format.container, file_argument(output)});
    return arguments;
}

}  // namespace tumble
