#include "output/video_writer.h"

#include "core/check.h"
#include "core/error.h"
#include "output/matroska_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr double longest_frame = 1.0;   // s: players jump to frames, and streams start with one

/// A name beside the clip that no one else has in mind: what is there under it would be written to if it were a pipe.
fs::path lossless_name(const fs::path& clip) { return clip.parent_path() / fmt::format(".{}.lossless.mkv", clip.filename().string()); }

}  // namespace

fs::path find_ffmpeg() {
    if (auto program = find_program("ffmpeg")) return *program;
    throw RunError("the ffmpeg program is needed to write video and is not on the PATH; "
                   "get it by: apt-get install ffmpeg");
}

VideoWriter::VideoWriter(const fs::path& clip, int width, int height, double fps, const ClipOptions& options)
    : clip_(clip),
      format_(video_format(clip, fps)),
      pixels_(format_.pixels, width, height),
      program_(find_ffmpeg()),
      file_(clip),
      longest_(options.times == FrameTimes::constant_rate
                   ? 1
                   : std::max(std::int64_t(longest_frame * fps / format_.frame_step), std::int64_t(1))) {
    if (format_.kind == VideoKind::gif) lossless_.emplace(lossless_name(clip));
    encoder_.emplace(program_, encoding_arguments(format_, options, lossless_ ? lossless_->path() : file_.path()));
    const bool even = format_.pixels == PixelForm::yuv420;
    send(matroska_head(format_.pixels, even ? width + width % 2 : width, even ? height + height % 2 : height,
                       format_.rate));
}

void VideoWriter::write(const Image& picture) {
    const Rectangle whole{0, 0, picture.width, picture.height};
    pixels_.update(picture, {&whole, 1});
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
    if (frames_in_clip_ > 0 && last_sent_ + 1 < frames_in_clip_) send(frames_in_clip_ - 1);   // else it would end early
    const ProcessEnd end = encoder_->finish();
    encoder_seconds_ += end.cpu_seconds;
    if (!end.ok()) fail(end);
    if (lossless_) convert_to_gif();
    file_.commit();
}

void VideoWriter::convert_to_gif() {
    {
        const std::lock_guard lock(abandon_mutex_);
        if (abandoned_) throw RunError(fmt::format("'{}' was given up", clip_.string()));
        gif_maker_.emplace(program_, gif_arguments(lossless_->path(), file_.path()));
    }
    const ProcessEnd end = gif_maker_->finish();
    encoder_seconds_ += end.cpu_seconds;
    if (!end.ok()) fail(end);
    lossless_.reset();
}

void VideoWriter::abandon() {
    const std::lock_guard lock(abandon_mutex_);
    abandoned_ = true;
    encoder_->kill();
    if (gif_maker_) gif_maker_->kill();
}

void VideoWriter::fail(const ProcessEnd& end) const {
    throw RunError(fmt::format("cannot write '{}': ffmpeg failed ({}){}{}", clip_.string(), end.describe(),
                               end.words.empty() ? "" : ":\n", end.words));
}

}  // namespace tumble
