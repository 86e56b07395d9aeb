#include "app/compare/accepted_pictures.h"

#include "compare/image_folder.h"
#include "compare/metrics/background.h"
#include "core/error.h"
#include "core/input_file.h"
#include "core/safe_text.h"
#include "output/picture_reader.h"
#include "output/png_writer.h"

#include <fmt/format.h>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The bytes of a picture file; nothing for one that is no whole picture.
std::optional<std::string> bytes_of(const ComparedPicture& picture, Verdict verdict) {
    if (picture.pixels != nullptr) {
        PngEncoder encoder(has_alpha(*picture.pixels) ? PngAlpha::kept : PngAlpha::dropped);
        const auto bytes = encoder.encode(*picture.pixels);
        return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
    try {
        if (verdict != Verdict::different) read_picture(picture.file);  // otherwise it was read
        return read_input_file(picture.file);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

}  // namespace

/// The reference that it was compared with, otherwise a new one.
fs::path AcceptedPictures::name_of(const ImagePair& pair) const {
    if (platform_) return fs::path(*platform_) / pair.name;
    if (!pair.reference || pair.reference->file.empty()) return pair.name;
    return pair.reference->file.lexically_relative(folder_);
}

void AcceptedPictures::take(const ImagePair& pair, ImageResult& result) {
    if (!pair.image || result.verdict == Verdict::same || result.verdict == Verdict::alike) return;
    const fs::path name = name_of(pair);
    if (!is_picture_name(name) || is_hidden(name))
        throw InputError(fmt::format("--accept: '{}' is no name of a picture (.png, .jpg)", safe_path(name)));
    const std::optional<std::string> bytes = bytes_of(*pair.image, result.verdict);
    if (!bytes) return;
    const std::lock_guard lock(mutex_);
    files_.add(name, *bytes);
    result.accepted = true;
}

}  // namespace tumble
