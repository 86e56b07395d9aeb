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

/// Reads the frames one after the other, with a single one in memory. A picture that is shown longer is several frames
/// at the clip's frame rate. Frames of a clip with alpha have it.
class ClipReader {
public:
    /// Throws InputError if the file is missing or no clip, RunError without ffmpeg.
    explicit ClipReader(const std::filesystem::path& clip);
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
    std::unique_ptr<Process> process_;
    int pipe_ = -1;  // its output
    bool may_restart_ = false;
    std::vector<std::uint8_t> buffer_;  // read from the pipe
    std::size_t used_ = 0;              // bytes of the buffer that were taken
};

}  // namespace tumble
