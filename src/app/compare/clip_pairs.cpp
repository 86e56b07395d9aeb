#include "app/compare/clip_pairs.h"

#include "app/files/frame_folder.h"
#include "core/error.h"
#include "output/png_reader.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace tumble {

namespace {

ImageSize size_of(const ComparedPicture& picture) {
    if (picture.pixels != nullptr) return {picture.pixels->width, picture.pixels->height};
    std::error_code error;
    // Opening a pipe would wait.
    return std::filesystem::is_regular_file(picture.file, error) ? read_png_size(picture.file) : ImageSize{};
}

/// True of a side of a clip's picture that has the last column or row of an odd one twice (output/video_format.h).
bool is_padded(int side, int other) { return side == other + 1 && side % 2 == 0; }

ComparedPicture cut(const ComparedPicture& picture, const ImageSize& size) {
    auto part = std::make_shared<Image>(size.width, size.height);
    for (int y = 0; y < size.height; ++y)
        std::copy_n(picture.pixels->at(0, y), 4 * std::size_t(size.width), part->at(0, y));
    return {picture.file, std::move(part)};
}

/// A picture of a clip without the repeated column and row, where the other picture has none.
ComparedPicture without_padding(const ComparedPicture& picture, const ComparedPicture& other) {
    if (picture.pixels == nullptr) return picture;
    const ImageSize size = size_of(picture), odd = size_of(other);
    const bool wider = is_padded(size.width, odd.width), higher = is_padded(size.height, odd.height);
    const bool fits = (wider || size.width == odd.width) && (higher || size.height == odd.height);
    return fits && (wider || higher) ? cut(picture, odd) : picture;
}

void remove_padding(ImagePair& pair) {
    try {
        pair.reference = without_padding(*pair.reference, *pair.image);
        pair.image = without_padding(*pair.image, *pair.reference);
    } catch (const InputError&) {
        // The comparison names the broken file.
    }
}

}  // namespace

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
        if (pair.reference && pair.image) remove_padding(pair);
        ++number_;
        return pair;
    }
    return std::nullopt;
}

}  // namespace tumble
