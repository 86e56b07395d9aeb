#include "tumble/output.h"

#include "api/convert.h"
#include "api/guard.h"
#include "api/scene_data.h"
#include "compare/image_compare.h"
#include "output/png_reader.h"
#include "output/png_writer.h"
#include "output/video_writer.h"

#include <fmt/format.h>

namespace tumble::v0 {
namespace {

tumble::ClipOptions to_internal(const ClipOptions& options) {
    tumble::ClipOptions to;
    to.times = options.variable_rate ? FrameTimes::longer_frames : FrameTimes::constant_rate;
    to.quality = options.quality == ClipQuality::draft  ? VideoQuality::draft
                 : options.quality == ClipQuality::best ? VideoQuality::best
                                                        : VideoQuality::normal;
    to.transparent = options.transparent;
    return to;
}

tumble::CompareOptions to_internal(const CompareOptions& o) {
    const auto check = [](const char* name, double value, double most) {
        if (value >= 0.0 && value <= most) return;
        throw InputError(fmt::format("{} must be from 0 to {:g} (given {:g})", name, most, value));
    };
    check("tolerance", o.tolerance, 255.0);
    check("fraction", o.fraction, 1.0);
    if (o.cluster) check("cluster", *o.cluster, 64.0);
    if (o.window) check("window", *o.window, 255.0);
    if (o.shade) check("shade", *o.shade, 64.0);
    return {o.tolerance, o.fraction, o.cluster, o.window, o.shade};
}

Comparison to_public(const tumble::Comparison& c) {
    return {c.alike, c.reason, std::int64_t(c.differing_pixels), c.max_difference, c.max_x, c.max_y};
}

void check_settings(const OutputSettings& output) {
    if (output.width < 1 || output.height < 1)
        throw InputError(
            fmt::format("a clip needs a size of at least 1 x 1 pixels (given {} x {})", output.width, output.height));
    if (!(output.fps > 0.0)) throw InputError(fmt::format("a clip needs a frame rate above 0 (given {})", output.fps));
}

}  // namespace

void write_png(const std::string& file, const Image& image, PngAlpha alpha) {
    const auto kept = alpha == PngAlpha::kept ? tumble::PngAlpha::kept : tumble::PngAlpha::dropped;
    guarded([&] { tumble::write_png(file, v0::to_internal(image), kept); });
}

Image read_png(const std::string& file) {
    return guarded([&] { return take(tumble::read_png(file)); });
}

Comparison compare_images(const Image& a, const Image& b, const CompareOptions& options) {
    return guarded([&] {
        return to_public(tumble::compare_images(v0::to_internal(a), v0::to_internal(b), to_internal(options)));
    });
}

Comparison compare_png_files(const std::string& a, const std::string& b, const CompareOptions& options,
                             const std::string& difference) {
    return guarded([&] { return to_public(tumble::compare_png_files(a, b, to_internal(options), difference)); });
}

// -- ClipWriter

struct ClipWriter::State : Writing {
    State(const std::string& file, const OutputSettings& output, const ClipOptions& options)
        : width(output.width), height(output.height), writer(file, width, height, output.fps, to_internal(options)) {}

    int width, height;
    std::int64_t frames = 0;
    tumble::Image last;  // converted once, however often it comes
    VideoWriter writer;
};

ClipWriter::ClipWriter(const std::string& file, const OutputSettings& output, const ClipOptions& options) {
    guarded([&] {
        check_settings(output);
        state_ = std::make_unique<State>(file, output, options);
    });
}
ClipWriter::~ClipWriter() = default;
ClipWriter::ClipWriter(ClipWriter&&) noexcept = default;
ClipWriter& ClipWriter::operator=(ClipWriter&&) noexcept = default;

void ClipWriter::write(const Image& image) {
    write_with(state_, "ClipWriter", [&](State& s) {
        if (image.width != s.width || image.height != s.height)
            throw InputError(fmt::format("a frame must have the size of the clip, {} x {} pixels (given {} x {})",
                                         s.width, s.height, image.width, image.height));
        if (s.frames++ > 0 && image.pixels == s.last.pixels) return s.writer.repeat();
        s.last = v0::to_internal(image);
        s.writer.write(s.last);
    });
}

void ClipWriter::finish() {
    finish_with(state_, "ClipWriter", [](State& s) {
        if (s.frames == 0) throw InputError("a clip needs at least one frame");
        s.writer.finish();
    });
}

}  // namespace tumble::v0
