#include "app/compare/compared_frames.h"

#include "compare/difference_image.h"
#include "compare/image_folder.h"
#include "compare/metrics/background.h"
#include "output/output_path.h"
#include "output/png_writer.h"

namespace tumble {

namespace {

namespace fs = std::filesystem;

Image pixels_of(const ComparedPicture& picture) {
    return picture.pixels != nullptr ? *picture.pixels : read_picture(picture.file);
}

}  // namespace

KeptFrames::KeptFrames(const fs::path& folder) : folder_(folder) {
    make_folder(folder_ / "reference");
    make_folder(folder_ / "image");
}

void KeptFrames::write(const ComparedPicture& picture, const fs::path& file, fs::path& name) {
    if (picture.pixels == nullptr) return;
    const auto bytes = std::int64_t(picture.pixels->pixels.size());
    if (bytes_.fetch_add(bytes) + bytes > most_bytes) return;
    write_png(file, *picture.pixels, has_alpha(*picture.pixels) ? PngAlpha::kept : PngAlpha::dropped);
    name = file;
}

void KeptFrames::keep(const ImagePair& pair, ImageResult& result) {
    if (result.verdict == Verdict::same) return;
    if (pair.reference) write(*pair.reference, folder_ / "reference" / pair.name, result.reference);
    if (pair.image) write(*pair.image, folder_ / "image" / pair.name, result.image);
}

std::string difference_name(const std::string& name) {
    const std::string ending = fs::path(name).extension().string();
    return ending == ".png" || ending == ".PNG" ? name : name + ".png";
}

void write_difference(const ImagePair& pair, const CompareOptions& options, const fs::path& file) {
    if (pair.reference->pixels == nullptr && pair.image->pixels == nullptr)
        write_difference_image(pair.reference->file, pair.image->file, options, file);
    else
        write_png(file, difference_image(pixels_of(*pair.reference), pixels_of(*pair.image), options));
}

namespace {

namespace fs = std::filesystem;

bool is_record(const fs::path& name) { return name.filename().string().ends_with(".motion.json"); }

}  // namespace

void add_compared_folder(const fs::path& folder, OutputPlan& plan) {
    for (const fs::path& file : files_in_folder(folder))
        if (is_record(file) || is_picture_name(file)) plan.add_input(file);
    plan.add_input_folder(
        folder, [](const fs::path& name) { return !is_hidden(name) && (is_picture_name(name) || is_record(name)); });
}

}  // namespace tumble
