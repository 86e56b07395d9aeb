// Motion records as JSON files: described values as text, poses and digests as base64.
#pragma once

#include "app/causes/motion_record.h"

#include <filesystem>
#include <string>

namespace tumble {

/// The record of a folder of frames (frame_000000.png, ...).
inline constexpr const char* folder_record_name = "frames.motion.json";

std::string record_text(const MotionRecord& record);

/// Writes through a temporary file. Throws RunError naming the path.
void write_motion_record(const std::filesystem::path& file, const MotionRecord& record);

/// Throws InputError naming the file if it is missing or no record of this format.
MotionRecord read_motion_record(const std::filesystem::path& file);
/// The same of a text.
MotionRecord parse_record(const std::string& text, const std::filesystem::path& file);

}  // namespace tumble
