#include "output/encoder_report.h"

#include "core/error.h"

#include <fmt/format.h>

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace tumble {

EncoderReport::EncoderReport() : file_(::memfd_create("tumble-encoder-report", MFD_CLOEXEC)) {
    if (file_ < 0) throw RunError("cannot make a file in memory: " + std::generic_category().message(errno));
}

EncoderReport::~EncoderReport() { ::close(file_); }

std::vector<std::string> EncoderReport::arguments() const {
    return {"-progress", fmt::format("file:/proc/{}/fd/{}", ::getpid(), file_)};
}

// Lines "key=value" for each half second, the last of them "progress=end". The last block counts.
std::optional<std::string> EncoderReport::fault(std::int64_t frames) const {
    std::array<char, 4096> last;  // bytes: a block has about 300
    const off_t size = ::lseek(file_, 0, SEEK_END), at = std::max<off_t>(size - off_t(last.size()), 0);
    const ssize_t n = size > 0 ? ::pread(file_, last.data(), last.size(), at) : 0;
    const std::string_view text(last.data(), static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (!text.ends_with("progress=end\n")) return "it reports no end";
    constexpr std::string_view key = "frame=";
    const std::size_t line = text.rfind("\nframe=") != std::string_view::npos ? text.rfind("\nframe=") + 1 : 0;
    const std::int64_t written = text.substr(line).starts_with(key) ? std::atoll(text.data() + line + key.size()) : 0;
    if (written < frames) return fmt::format("it reports {} frames of {}", written, frames);
    return std::nullopt;
}

}  // namespace tumble
