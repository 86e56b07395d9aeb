#include "app/compare/clip_pairs.h"

#include "app/files/frame_folder.h"
#include "core/error.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace tumble {

FrameSource::FrameSource(const std::filesystem::path& clip_or_folder, std::optional<double> fps) {
    if (std::filesystem::is_directory(clip_or_folder)) {
        folder_ = clip_or_folder;
        numbers_ = frames_in(folder_);
        if (numbers_.empty())
            throw InputError({folder_.string(), 0, 0},
                             "the folder holds no frames (frame_000000.png, frame_000001.png, ...)");
    } else {
        clip_.emplace(clip_or_folder, fps);
    }
}

/// Decodes up to the frame of that number, or to the end.
void FrameSource::decode_to(std::int64_t number) {
    while (decoded_ < number && (decoded_ < 0 || last_ != nullptr)) {
        std::optional<Image> image = clip_->next();
        last_ = image ? std::make_shared<const Image>(std::move(*image)) : nullptr;
        ++decoded_;
    }
}

std::optional<ComparedPicture> FrameSource::at(std::int64_t number) {
    if (!clip_) {
        if (!std::binary_search(numbers_.begin(), numbers_.end(), number)) return std::nullopt;
        return ComparedPicture{frame_path(folder_, number), nullptr};
    }
    decode_to(number);
    if (last_ == nullptr) return std::nullopt;
    return ComparedPicture{{}, last_};
}

bool FrameSource::has_any_from(std::int64_t number) {
    if (!clip_) return !numbers_.empty() && numbers_.back() >= number;
    decode_to(number);
    return last_ != nullptr;
}

std::optional<ImagePair> FramePairs::next() {
    for (; reference_.has_any_from(number_) || image_.has_any_from(number_); ++number_) {
        ImagePair pair{frame_path({}, number_).string(), reference_.at(number_), image_.at(number_)};
        if (!pair.reference && !pair.image) continue;
        ++number_;
        return pair;
    }
    return std::nullopt;
}

}  // namespace tumble
