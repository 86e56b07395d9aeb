#include "output/video_format.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/output_path.h"
#include "output/yuv420.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

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

/// AVX-512 makes x264 5 to 8 % slower than AVX2 (an Intel Xeon of 2023), with the same bytes.
std::string instruction_set() { return __builtin_cpu_supports("avx512bw") != 0 ? ":asm=avx2" : ""; }

/// x264 with `preset`, except for `rate` (the option and its value) and `parameters`.
Arguments x264(const std::string& preset, const Arguments& rate, bool two_way, const std::string& parameters) {
    Arguments arguments = {"-c:v", "libx264", "-preset", preset, rate.at(0), rate.at(1)};
    // B-frames save a quarter of the bytes. They are stored out of time order, and mp4 then ends too early after a last
    // frame with a longer duration.
    if (!two_way) arguments.insert(arguments.end(), {"-bf", "0"});
    // The bytes depend on the number of threads, so it is fixed; two keep up with eight render processes.
    arguments.insert(arguments.end(),
                     {"-threads", "2", "-pix_fmt", "yuv420p", "-x264-params", parameters + instruction_set()});
    return arguments;
}

Arguments h264(const ClipOptions& options) {
    const bool two_way = options.times == FrameTimes::constant_rate;
    switch (options.quality) {
        // Only the features that the codec needs, without a search for the distribution of bits: one quantizer for all
        // frames but the first of each group, no lookahead, no weights for fades, no search for cuts.
        case VideoQuality::draft:
            return x264("veryfast", {"-qp", "22"}, false,
                        "rc-lookahead=0:scenecut=0:weightp=0:ipratio=3.4:partitions=p8x8");
        // A still background costs few bits at any quality, and a lookahead of 40 frames detects it. The first frame of
        // each two seconds gets a much higher quality (ipratio). Small residuals are coded instead of dropped (no-dct-
        // decimate), because they are the specks. Colors get an offset because a level of chroma is two levels of red
        // or blue.
        case VideoQuality::normal:
            return x264("veryfast", {"-crf", "17"}, two_way,
                        "keyint=120:rc-lookahead=40:ipratio=3:no-dct-decimate=1:chroma-qp-offset=-3");
        case VideoQuality::best:
            return x264("medium", {"-crf", "8"}, two_way,
                        "keyint=120:rc-lookahead=40:ipratio=2:no-dct-decimate=1:chroma-qp-offset=-3");
        // At most 300 kbit/s, even if the camera moves: a page must stay small.
        case VideoQuality::small:
            return x264("slow", {"-crf", "27"}, two_way,
                        "keyint=240:rc-lookahead=40:ipratio=2:vbv-maxrate=300:vbv-bufsize=600");
    }
    return {};
}

// The "good" mode takes twelve times as long as the real-time mode (docs/explanation/output.md).
Arguments vp9(VideoQuality quality) {
    Arguments arguments = {"-c:v", "libvpx-vp9"};
    switch (quality) {
        case VideoQuality::draft:
            arguments.insert(arguments.end(), {"-deadline", "realtime", "-cpu-used", "8", "-crf", "30"});
            break;
        // A key frame every 60 frames: the real-time mode leaves specks in still areas until the next one (of 720p, 46
        // -> 9 pixels).
        case VideoQuality::normal:
            arguments.insert(arguments.end(), {"-deadline", "realtime", "-cpu-used", "6", "-crf", "16", "-g", "60"});
            break;
        case VideoQuality::best:
            arguments.insert(arguments.end(), {"-deadline", "good", "-cpu-used", "5", "-crf", "8"});
            break;
        case VideoQuality::small:
            arguments.insert(arguments.end(), {"-deadline", "good", "-cpu-used", "5", "-crf", "36"});
            break;
    }
    arguments.insert(arguments.end(), {"-b:v", "0", "-row-mt", "1", "-threads", "4", "-pix_fmt", "yuv420p"});
    return arguments;
}

// The alpha is a second stream with the same settings; libvpx allows no hidden reference frames beside it.
Arguments vp9_alpha(VideoQuality quality) {
    Arguments arguments = vp9(quality);
    arguments.back() = "yuva420p";
    arguments.insert(arguments.end(), {"-auto-alt-ref", "0"});
    return arguments;
}

// Alpha is lossless. Every frame is a key frame, for editors.
Arguments prores_4444(VideoQuality quality) {
    const std::string quantizer = quality == VideoQuality::draft ? "8" : quality == VideoQuality::normal ? "2" : "1";
    return {"-c:v", "prores_ks", "-profile:v", "4444",     "-vendor", "apl0",     "-alpha_bits",
            "16",   "-q:v",      quantizer,    "-threads", "4",       "-pix_fmt", "yuva444p10le"};
}

/// Arguments of the ffmpeg program, from -c:v on. For a GIF they belong to its lossless first stage, the same for
/// each quality.
Arguments codec_arguments(VideoKind kind, const ClipOptions& options) {
    switch (kind) {
        case VideoKind::h264:
            return h264(options);
        case VideoKind::vp9:
            return vp9(options.quality);
        case VideoKind::vp9_alpha:
            return vp9_alpha(options.quality);
        case VideoKind::prores_4444:
            return prores_4444(options.quality);
        case VideoKind::gif:
            return {"-c:v", "libx264rgb", "-preset", "ultrafast", "-qp", "0", "-threads", "4"};
    }
    return {};
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

/// The second input of ffmpeg and its codec, or none: AAC, which all players of H.264 have; Opus in WebM.
Arguments sound_arguments(const VideoFormat& format, const fs::path& sound) {
    if (sound.empty()) return {"-map", "0:v", "-an"};
    Arguments arguments = {"-i", file_argument(sound), "-map", "0:v", "-map", "1:a", "-flags:a", "+bitexact", "-c:a"};
    if (format.container == "webm")
        append(arguments, {"libopus", "-b:a", "128k"});
    else
        append(arguments, {"aac", "-b:a", "192k"});
    return arguments;
}

Arguments encoding_arguments(const VideoFormat& format, const ClipOptions& options, const ImageSize& images,
                             const fs::path& output) {
    Arguments arguments = common();
    append(arguments, {"-f", "matroska", "-i", "pipe:0"});
    append(arguments, sound_arguments(format, options.sound));
    append(arguments, {"-r", format.rate.text(), "-fps_mode", "vfr"});
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
                         const std::string& comment, const fs::path& sound) {
    const Arguments input = {"-f", "concat", "-safe", "0", "-i", file_argument(list)};
    if (format.kind == VideoKind::gif) return gif_from(input, output);
    Arguments arguments = common();
    append(arguments, input);
    append(arguments, sound_arguments(format, sound));
    append(arguments, {"-c:v", "copy", "-map_metadata", "-1", "-metadata", "comment=" + comment});
    // The alpha is beside the pictures; players look for it where this says so.
    if (format.kind == VideoKind::vp9_alpha) append(arguments, {"-metadata:s:v", "alpha_mode=1"});
    append(arguments, {"-fflags", "+bitexact"});
    if (has_its_head_last(format)) append(arguments, {"-movflags", "+faststart"});
    append(arguments, {"-f", format.container, file_argument(output)});
    return arguments;
}

}  // namespace tumble
