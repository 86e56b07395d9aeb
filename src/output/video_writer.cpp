#include "output/video_writer.h"

#include "core/check.h"
#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>

namespace tumble {
namespace {

namespace fs = std::filesystem;

int even(int size) { return size + size % 2; }

fs::path with_ending(const fs::path& path, const char* ending) {
    fs::path other = path;
    return other.replace_extension(ending);
}

}  // namespace

fs::path find_ffmpeg() {
    if (auto program = find_program("ffmpeg")) return *program;
    throw RunError("the ffmpeg program is needed to write video and is not on the PATH; "
                   "get it by: apt-get install ffmpeg");
}

VideoWriter::VideoWriter(const fs::path& clip, int width, int height, double fps)
    : clip_(clip),
      format_(video_format(clip, fps)),
      width_(width),
      height_(height),
      clip_width_(format_.even_size ? even(width) : width),
      clip_height_(format_.even_size ? even(height) : height),
      program_(find_ffmpeg()),
      file_(clip) {
    if (format_.kind == VideoKind::gif) lossless_.emplace(with_ending(clip, ".mkv"));
    encoder_.emplace(program_, encoding_arguments(format_, clip_width_, clip_height_,
                                                  lossless_ ? lossless_->path() : file_.path()));
}

void VideoWriter::write(const Image& frame) {
    TUMBLE_CHECK_EQ(frame.width, width_);
    TUMBLE_CHECK_EQ(frame.height, height_);
    if (frames_++ % format_.frame_step != 0) return;
    if (!encoder_->write(std::as_bytes(std::span(padded(frame))))) fail(encoder_->finish());
    ++frames_in_clip_;
}

/// The pixels as the clip has them: an odd last column and row is there twice.
const std::vector<std::uint8_t>& VideoWriter::padded(const Image& frame) {
    if (clip_width_ == width_ && clip_height_ == height_) return frame.pixels;
    const std::size_t row = std::size_t(width_) * 4, padded_row = std::size_t(clip_width_) * 4;
    padded_.resize(padded_row * std::size_t(clip_height_));
    for (int y = 0; y < clip_height_; ++y) {
        const std::uint8_t* from = frame.at(0, std::min(y, height_ - 1));
        std::uint8_t* to = padded_.data() + padded_row * std::size_t(y);
        std::memcpy(to, from, row);
        if (padded_row > row) std::memcpy(to + row, from + row - 4, 4);
    }
    return padded_;
}

void VideoWriter::finish() {
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
