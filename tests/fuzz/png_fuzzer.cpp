// A PNG file: the result is a picture or an InputError. The picture equals that of libpng's simplified reader, row by
// row.
#include "png_bytes.h"

#include "core/check.h"
#include "core/error.h"

#include <png.h>

#include <vector>

namespace {

/// Empty if libpng rejects the file.
std::vector<std::uint8_t> read_simply(std::span<const std::uint8_t> bytes) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    std::vector<std::uint8_t> pixels;
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) != 0) {
        image.format = PNG_FORMAT_RGBA;
        image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
        pixels.resize(PNG_IMAGE_SIZE(image));
        if (png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) == 0) pixels.clear();
    }
    png_image_free(&image);
    return pixels;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::span<const std::uint8_t> bytes(data, size);
    std::vector<std::uint8_t> pixels;
    bool comparable = true;
    try {
        tumble::PngRows rows(tumble::as_file(bytes), "fuzzed.png");
        const auto [width, height] = rows.size();
        if (std::int64_t(width) * height > tumble::fuzzed_pixels) return 0;
        comparable =
            !rows.interlaced() || bytes[24] < 16;  // libpng 1.6.39's simplified reader shuffles the pixels of others
        for (int y = 0; y < height; ++y) {
            const auto row = rows.next();
            pixels.insert(pixels.end(), row.begin(), row.end());
        }
    } catch (const tumble::InputError&) {
        return 0;
    }
    const std::vector<std::uint8_t> expected = comparable ? read_simply(bytes) : std::vector<std::uint8_t>();
    if (!expected.empty()) TUMBLE_CHECK_EQ(pixels == expected, true);
    return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room) __attribute__((weak));

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t room, unsigned seed) {
    size = LLVMFuzzerMutate(data, size, room);
    if (seed % 8 != 0) tumble::mend_checksums({data, size});
    return size;
}
