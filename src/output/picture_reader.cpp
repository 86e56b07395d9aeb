#include "output/picture_reader.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>

namespace tumble {
namespace {

constexpr std::array jpeg_start{std::byte(0xff), std::byte(0xd8), std::byte(0xff)};

bool is_jpeg(std::span<const std::byte> start) {
    return start.size() >= jpeg_start.size() && std::equal(jpeg_start.begin(), jpeg_start.end(), start.begin());
}

bool starts_as_jpeg(std::FILE* file) {
    std::array<std::byte, jpeg_start.size()> start{};
    const std::size_t count = std::fread(start.data(), 1, start.size(), file);
    std::rewind(file);
    return is_jpeg(std::span(start).first(count));
}

}  // namespace

PictureRows::PictureRows(const std::filesystem::path& file) {
    OpenFile opened = open_input_file(file);
    if (starts_as_jpeg(opened.get()))
        jpeg_.emplace(std::move(opened), file.string());
    else
        png_.emplace(std::move(opened), file.string());
}

Image PictureRows::all() {
    if (png_) return png_->all();
    Image image(size().width, size().height);
    for (int y = 0; y < image.height; ++y) {
        const std::span<const std::uint8_t> row = next();
        std::copy(row.begin(), row.end(), image.at(0, y));
    }
    return image;
}

Image read_picture(const std::filesystem::path& file) { return PictureRows(file).all(); }

ImageSize read_picture_size(const std::filesystem::path& file) { return PictureRows(file).size(); }

std::string_view picture_media_type(std::span<const std::byte> file) {
    return is_jpeg(file) ? "image/jpeg" : "image/png";
}

}  // namespace tumble
