// Is a clip that the ffmpeg program has written whole? By its structure alone: the pictures are not decoded.
#pragma once

#include "output/video_format.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tumble {

/// What is wrong with the file as a clip of that container ("mp4", "mov", "matroska", "webm", "gif", in ffmpeg's words) with so
/// many stored frames; nothing where it is whole. A GIF may store fewer: equal frames one after the other become one.
std::optional<std::string> fault_of_clip(const std::filesystem::path& file, const std::string& container, std::int64_t frames);

}  // namespace tumble
