// Files of what a comparison finds: frames of clips for the report, and pictures of differences.
#pragma once

#include "app/files/output_plan.h"
#include "compare/comparison.h"
#include "compare/pair_compare.h"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

namespace tumble {

/// Keeps frames that are in memory only and that are not the same as their partner, as files. For several threads.
class KeptFrames {
public:
    /// At most this many bytes of pixels are kept, so that a long clip does not fill the disk.
    static constexpr std::int64_t most_bytes = std::int64_t(1) << 30;

    /// Into REFERENCE and IMAGE in `folder`.
    explicit KeptFrames(const std::filesystem::path& folder);

    /// Names the files in the result.
    void keep(const ImagePair& pair, ImageResult& result);

private:
    void write(const ComparedPicture& picture, const std::filesystem::path& file, std::filesystem::path& name);

    std::filesystem::path folder_;
    std::atomic<std::int64_t> bytes_{0};
};

/// The name of a picture of the differences, which is a PNG file.
std::string difference_name(const std::string& name);

/// Writes the picture of the differences (difference_image.h) of a pair that can be read. Throws InputError, RunError.
void write_difference(const ImagePair& pair, const CompareOptions& options, const std::filesystem::path& file);

// -- A folder of pictures as an input.

/// Its pictures and motion records, and all names that would be such files. Throws InputError if it cannot be read.
void add_compared_folder(const std::filesystem::path& folder, OutputPlan& plan);

}  // namespace tumble
