// What the ffmpeg program itself says that it has written: for a clip that goes into a pipe or device, where no one can look again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A file without a name, into which ffmpeg reports.
class EncoderReport {
public:
    /// Throws RunError.
    EncoderReport();
    ~EncoderReport();
    EncoderReport(const EncoderReport&) = delete;
    EncoderReport& operator=(const EncoderReport&) = delete;

    /// For ffmpeg, before its other arguments.
    std::vector<std::string> arguments() const;

    /// Once it has ended: what is wrong, where it does not say that it has written at least so many frames.
    std::optional<std::string> fault(std::int64_t frames) const;

private:
    int file_ = -1;
};

}  // namespace tumble
