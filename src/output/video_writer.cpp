#include "output/video_writer.h"

#include "core/check.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/clip_check.h"
#include "output/matroska_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr double longest_frame = 1.0;  // s: players seek to stored frames, and streams start with one

}  // namespace

fs::path find_ffmpeg() {
    if (auto program = find_program("ffmpeg")) return *program;
    throw RunError(
        "the ffmpeg program is needed to write video and is not on the PATH; "
        "get it by: apt-get install ffmpeg");
}

VideoWriter::VideoWriter(const fs::path& clip, int width, int height, double fps, const ClipOptions& options)
    : VideoWriter(clip, width, height, fps, video_format(clip, fps, options.transparent), options) {}

VideoWriter::VideoWriter(const fs::path& clip, int width, int height, double fps, const VideoFormat& format,
                         const ClipOptions& options)
    : clip_(clip),
      format_(format),
      pixels_(format_.pixels, width, height),
      program_(find_ffmpeg()),
      file_(clip),
      longest_(options.times == FrameTimes::constant_rate
                   ? 1
                   : std::max(std::int64_t(longest_frame * fps / format_.frame_step), std::int64_t(1))) {
    if (format_.kind == VideoKind::gif && !format_.lossless_stage) {
        remove_left_parts(clip);
        lossless_.emplace(clip);
    }
    if (file_.in_place()) report_.emplace();
    if (lossless_)
        encoder_.emplace(program_, encoding_arguments(format_, options, {width, height}, lossless_->path()));
    else
        encoder_.emplace(program_,
                         with_report(encoding_arguments(format_, options, {width, height}, output_argument())),
                         file_.descriptor());
    const bool even = is_subsampled(format_.pixels);
    send(matroska_head(format_.pixels, even ? width + width % 2 : width, even ? height + height % 2 : height,
                       format_.rate));
}

void VideoWriter::write(const Image& image) {
    const Rectangle whole{0, 0, image.width, image.height};
    pixels_.update(image, {&whole, 1});
    const std::span<const std::byte> bytes = pixels_.bytes();
    const auto copy = std::make_shared<std::vector<std::byte>>(bytes.begin(), bytes.end());
    write(std::shared_ptr<const std::byte>(copy, copy->data()));
}

void VideoWriter::write(std::shared_ptr<const std::byte> pixels) {
    latest_ = std::move(pixels);
    advance();
}

void VideoWriter::repeat() {
    TUMBLE_CHECK_GT(frames_, 0);
    advance();
}

void VideoWriter::advance() {
    if (frames_++ % format_.frame_step != 0) return;
    const std::int64_t frame = frames_in_clip_++;
    if (shown_ == latest_ && frame - last_sent_ < longest_) return;
    shown_ = latest_;
    send(frame);
}

void VideoWriter::send(std::int64_t frame) {
    const std::size_t bytes = pixels_.bytes().size();
    send(matroska_frame_head(frame, format_.rate, bytes));
    if (!encoder_->lend(shown_, bytes)) fail(encoder_->finish());
    last_sent_ = frame;
    ++sent_;
}

void VideoWriter::send(std::span<const std::byte> bytes) {
    if (!encoder_->write(bytes)) fail(encoder_->finish());
}

void VideoWriter::finish() {
    if (frames_in_clip_ > 0 && last_sent_ + 1 < frames_in_clip_)
        send(frames_in_clip_ - 1);  // otherwise the clip would end early
    const ProcessEnd end = encoder_->finish();
    encoder_seconds_ += end.cpu_seconds;
    if (!end.ok()) fail(end);
    if (lossless_) {
        check_file(lossless_->path(), format_.container, end);
        convert_to_gif();
    } else {
        check_clip(format_.container, end);
    }
    file_.commit();
}

void VideoWriter::convert_to_gif() {
    {
        const std::lock_guard lock(abandon_mutex_);
        if (abandoned_) throw RunError(fmt::format("'{}' was abandoned", safe_path(clip_)));
        gif_maker_.emplace(program_, with_report(gif_arguments(lossless_->path(), output_argument())),
                           file_.descriptor());
    }
    const ProcessEnd end = gif_maker_->finish();
    encoder_seconds_ += end.cpu_seconds;
    if (!end.ok()) fail(end);
    check_clip("gif", end);
    lossless_.reset();
}

fs::path VideoWriter::output_argument() const {
    return file_.descriptor() ? fs::path(clip_to_standard_output) : file_.path();
}

void VideoWriter::abandon() {
    const std::lock_guard lock(abandon_mutex_);
    abandoned_ = true;
    encoder_->kill();
    if (gif_maker_) gif_maker_->kill();
}

std::vector<std::string> VideoWriter::with_report(std::vector<std::string> arguments) const {
    if (!report_) return arguments;
    std::vector<std::string> all = report_->arguments();
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
}

void VideoWriter::check_clip(const std::string& container, const ProcessEnd& end) const {
    if (!report_) return check_file(file_.path(), container, end);
    // The clip is already with its reader. A GIF may store fewer frames.
    if (const auto fault = report_->fault(container == "gif" ? 1 : sent_))
        fail(end, fmt::format("ended with exit code 0, but {}", *fault));
}

void VideoWriter::check_file(const fs::path& file, const std::string& container, const ProcessEnd& end) const {
    if (const auto fault = fault_of_clip(file, container, sent_))
        fail(end, fmt::format("ended with exit code 0, but the clip is not whole: {}", *fault));
}

void VideoWriter::fail(const ProcessEnd& end) const { fail(end, fmt::format("failed ({})", end.describe())); }

void VideoWriter::fail(const ProcessEnd& end, const std::string& how) const {
    throw RunError(fmt::format("cannot write '{}': {} {}{}{}", safe_path(clip_), safe_path(program_), how,
                               end.error_text.empty() ? "" : ":\n", end.error_text));
}

}  // namespace tumble
