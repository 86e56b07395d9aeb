#include "output/codec_settings.h"

namespace tumble {
namespace {

using Arguments = std::vector<std::string>;

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

}  // namespace

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

}  // namespace tumble
