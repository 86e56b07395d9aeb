// The frames of a clip, decoded by the ffmpeg program.
#pragma once

#include "core/image.h"
#include "output/process.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

namespace tumble {

/// Reads the frames one after the other, with a single one in memory. Frames of a clip with alpha have it.
class ClipReader {
public:
    /// The stored frames; with a frame rate, those at its moments, so that a frame that is shown longer comes several
    /// times. Throws InputError if the file is missing, RunError without ffmpeg.
    explicit ClipReader(const std::filesystem::path& clip, std::optional<double> fps = std::nullopt);
    ~ClipReader();
    ClipReader(const ClipReader&) = delete;
    ClipReader& operator=(const ClipReader&) = delete;

    /// The next frame, or nothing after the last. Throws InputError if the clip is broken.
    std::optional<Image> next();

private:
    void start(bool with_alpha_decoder);
    void stop();
    std::optional<Image> read_frame();
    std::optional<std::string> line();
    bool fill();
    bool read(std::span<std::uint8_t> to);
    [[noreturn]] void fail(const std::string& problem) const;

    std::filesystem::path clip_, ffmpeg_;
    std::optional<double> fps_;
    std::unique_ptr<Process> process_;
    int pipe_ = -1;  // its output
    bool may_restart_ = false, inside_frame_ = false;
    std::vector<std::uint8_t> buffer_;  // read from the pipe
    std::size_t used_ = 0;              // bytes of the buffer that were taken
};

}  // namespace tumble
