// ffmpeg's own report of the written frames, for a clip that goes into a pipe or device and cannot be read back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A file without a name that ffmpeg writes its report to.
class EncoderReport {
public:
    /// Throws RunError.
    EncoderReport();
    ~EncoderReport();
    EncoderReport(const EncoderReport&) = delete;
    EncoderReport& operator=(const EncoderReport&) = delete;

    /// For ffmpeg, before its other arguments.
    std::vector<std::string> arguments() const;

    /// Call it after ffmpeg has ended: the fault if it does not report at least this many frames.
    std::optional<std::string> fault(std::int64_t frames) const;

private:
    int file_ = -1;
};

}  // namespace tumble
