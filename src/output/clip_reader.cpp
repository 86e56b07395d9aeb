#include "output/clip_reader.h"

#include "core/child_process.h"
#include "core/error.h"
#include "core/frame_rate.h"
#include "core/safe_text.h"
#include "output/png_reader.h"
#include "output/video_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t buffer_bytes = 1 << 20;  // a pipe's largest capacity for ordinary users
constexpr int message_period = 100;            // ms
constexpr std::size_t longest_line = 256;      // bytes, of a frame's header

/// Frames as PAM: a header of lines with width and height, then the bytes of RGBA.
std::vector<std::string> arguments_for(const fs::path& clip, std::optional<double> fps, bool with_alpha_decoder) {
    std::vector<std::string> arguments{"-hide_banner", "-nostdin", "-loglevel", "error", "-xerror"};
    // ffmpeg's own decoder of VP9 drops the alpha.
    if (with_alpha_decoder) arguments.insert(arguments.end(), {"-c:v", "libvpx-vp9"});
    arguments.insert(arguments.end(), {"-i", "file:" + clip.string(), "-map", "0:v:0", "-sws_flags",
                                       "accurate_rnd+bitexact", "-pix_fmt", "rgba", "-c:v", "pam", "-f", "image2pipe"});
    if (fps)
        arguments.insert(arguments.end(), {"-fps_mode", "cfr", "-r", to_frame_rate(*fps).text()});
    else
        arguments.insert(arguments.end(), {"-fps_mode", "passthrough"});
    arguments.push_back("pipe:1");
    return arguments;
}

}  // namespace

ClipReader::ClipReader(const fs::path& clip, std::optional<double> fps)
    : clip_(clip), ffmpeg_(find_ffmpeg()), fps_(fps) {
    std::error_code error;
    const fs::file_status status = fs::status(clip, error);
    if (!fs::exists(status)) fail("the file does not exist");
    if (!fs::is_regular_file(status)) fail("is not a regular file");
    may_restart_ = clip.extension() == ".webm";
    start(may_restart_);
}

ClipReader::~ClipReader() { stop(); }

void ClipReader::start(bool with_alpha_decoder) {
    Pipe pipe;
    ::fcntl(pipe.read_end(), F_SETPIPE_SZ, int(buffer_bytes));
    process_ = std::make_unique<Process>(ffmpeg_, arguments_for(clip_, fps_, with_alpha_decoder), pipe.write_end());
    pipe_ = pipe.take_read();
}

void ClipReader::stop() {
    process_.reset();
    if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
}

void ClipReader::fail(const std::string& problem) const { throw InputError({clip_.string(), 0, 0}, problem); }

/// Reads more into the buffer; false at the end of the output.
bool ClipReader::fill() {
    buffer_.resize(buffer_bytes);
    used_ = 0;
    for (;;) {
        pollfd polled{pipe_, POLLIN, 0};
        const int ready = ::poll(&polled, 1, message_period);
        process_->take_messages();
        if (ready <= 0) continue;
        const ssize_t n = ::read(pipe_, buffer_.data(), buffer_.size());
        if (n < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        buffer_.resize(n > 0 ? std::size_t(n) : 0);
        return n > 0;
    }
}

bool ClipReader::read(std::span<std::uint8_t> to) {
    while (!to.empty()) {
        if (used_ == buffer_.size() && !fill()) return false;
        const std::size_t count = std::min(to.size(), buffer_.size() - used_);
        std::copy_n(buffer_.begin() + std::ptrdiff_t(used_), count, to.begin());
        used_ += count;
        to = to.subspan(count);
    }
    return true;
}

std::optional<std::string> ClipReader::line() {
    std::string text;
    for (std::uint8_t byte = 0; read({&byte, 1});) {
        if (byte == '\n') return text;
        text += char(byte);
        if (text.size() > longest_line) fail("ffmpeg gave something that is no frame");
    }
    return std::nullopt;
}

std::optional<Image> ClipReader::read_frame() {
    int width = 0, height = 0;
    for (;;) {
        const std::optional<std::string> text = line();
        if (!text) return std::nullopt;
        const auto number = [&](std::string_view key, int& to) {
            if (text->starts_with(key)) std::from_chars(text->data() + key.size(), text->data() + text->size(), to);
        };
        number("WIDTH ", width);
        number("HEIGHT ", height);
        if (*text == "ENDHDR") break;
    }
    if (width < 1 || height < 1 || std::int64_t(width) * height > max_image_pixels)
        fail(fmt::format("has frames of {} x {} pixels", width, height));
    Image image(width, height);
    if (!read(image.pixels)) {
        inside_frame_ = true;
        return std::nullopt;
    }
    return image;
}

std::optional<Image> ClipReader::next() {
    if (process_ == nullptr) return std::nullopt;
    if (std::optional<Image> image = read_frame()) {
        may_restart_ = false;
        return image;
    }
    const ProcessEnd end = process_->finish();
    stop();
    if (end.ok() && inside_frame_) fail("ffmpeg ended within a frame");
    if (end.ok()) return std::nullopt;
    if (std::exchange(may_restart_, false)) {  // not VP9
        start(false);
        return next();
    }
    fail(fmt::format("ffmpeg cannot decode the clip ({}): {}", end.describe(), safe_lines(end.error_text)));
}

}  // namespace tumble
