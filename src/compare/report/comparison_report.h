// The report of a comparison: one HTML file that opens offline, with the pictures that differ, worst first. It loads
// nothing, and its content security policy allows its own script and style only. Without scripts it shows the same
// pictures one below the other.
#pragma once

#include "compare/comparison.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace tumble {

struct ReportOptions {
    std::string title;       // empty: the names of both sets
    std::string generator;   // "Tumble 0.1.0"
    std::string platform;    // of this machine: "amd"; empty: not shown
    std::string tolerances;  // name of the file with the tolerances; empty: the defaults
    /// Bytes of all pictures in the page. Beyond, the pictures of the least differences are left out, and the page
    /// says so.
    std::int64_t most_picture_bytes = std::int64_t(48) << 20;
    int workers = 1;  // pairs drawn at a time
};

/// Reads the files of images that are not the same (see ImageResult). An image that cannot be read has no picture.
/// Throws RunError naming the path if it cannot be written.
void write_comparison_report(const SetResult& set, const ReportOptions& options, const std::filesystem::path& path);

}  // namespace tumble
