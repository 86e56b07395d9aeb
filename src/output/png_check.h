// The mark of a PNG file (png_mark_keyword), and whether the file is whole, by the checksums of its chunks: pixels are
// not unpacked.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tumble {

struct PngState {
    bool whole = false;               // all chunks are there with their checksums, and nothing behind them
    std::optional<std::string> mark;  // of a file whose head is intact
};

PngState state_of_png(const std::filesystem::path& path);

/// The mark alone, from the head of the file, which may be damaged behind it.
std::optional<std::string> mark_of_png(const std::filesystem::path& path);

}  // namespace tumble
