// A folder of frames: frame_000000.png, frame_000001.png, ...
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace tumble {

/// The file of frame n. Six digits, more where needed.
std::filesystem::path frame_path(const std::filesystem::path& folder, std::int64_t frame);

/// The numbers of the frames that are in the folder, ascending. Throws InputError where it is no folder.
std::vector<std::int64_t> frames_in(const std::filesystem::path& folder);

/// The same of any files whose name is `before`, a number of six digits or more, and `after`.
std::vector<std::int64_t> numbers_in(const std::filesystem::path& folder, std::string_view before, std::string_view after);

/// A folder to write frames into: made where it is missing, and taken away again if nothing ever came into it.
class FrameFolder {
public:
    /// Throws RunError where it cannot be made, or not be written into.
    explicit FrameFolder(const std::filesystem::path& folder);
    ~FrameFolder();
    FrameFolder(const FrameFolder&) = delete;
    FrameFolder& operator=(const FrameFolder&) = delete;

    const std::filesystem::path& path() const { return folder_; }

private:
    void remove_empty() const;

    std::filesystem::path folder_;
    std::vector<std::filesystem::path> made_;   // outermost first
};

}  // namespace tumble
