// Checks that a clip written by the ffmpeg program is complete, by its structure: images are not decoded.
#pragma once

#include "output/video_format.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tumble {

/// The fault of the file as a clip of that container ("mp4", "mov", "matroska", "webm", "gif", in ffmpeg's terms) with
/// this many stored frames; empty if it is complete. A GIF may store fewer, because consecutive equal frames are
/// merged.
std::optional<std::string> fault_of_clip(const std::filesystem::path& file, const std::string& container,
                                         std::int64_t frames);

}  // namespace tumble
