// Pairs of frames of which at least one comes from a clip, decoded as they are asked for.
#pragma once

#include "compare/pair_compare.h"
#include "output/clip_reader.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace tumble {

/// The frames of a clip, or of a folder (frame_000000.png, ...), by their numbers.
class FrameSource {
public:
    /// `fps`: of a clip (see ClipReader). Throws InputError if it is neither.
    explicit FrameSource(const std::filesystem::path& clip_or_folder, std::optional<double> fps = std::nullopt);

    /// The frame of that number, which may only grow from call to call; nothing if there is none.
    std::optional<ComparedPicture> at(std::int64_t number);
    /// False after the last frame; a clip is decoded to know it.
    bool has_any_from(std::int64_t number);

private:
    void decode_to(std::int64_t number);

    std::filesystem::path folder_;
    std::vector<std::int64_t> numbers_;  // of a folder
    std::optional<ClipReader> clip_;
    std::int64_t decoded_ = -1;          // number of the frame in last_
    std::shared_ptr<const Image> last_;  // null: the clip has ended
};

/// The pairs of two sources by number: frame_000000.png and so on. A PairSource (set_compare.h).
class FramePairs {
public:
    FramePairs(const std::filesystem::path& reference, const std::filesystem::path& image, std::optional<double> fps)
        : reference_(reference, fps), image_(image, fps) {}
    std::optional<ImagePair> next();

private:
    FrameSource reference_, image_;
    std::int64_t number_ = 0;
};

}  // namespace tumble
