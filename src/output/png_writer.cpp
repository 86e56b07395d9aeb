#include "output/png_writer.h"

#include "core/check.h"
#include "core/error.h"
#include "output/temporary_file.h"

#include <fmt/format.h>
#include <isa-l/igzip_lib.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <new>
#include <string>

namespace tumble {
namespace {

// Measured in deflater.cpp.
constexpr std::uint8_t filter_sub = 1;   // the first byte of each row: differences to the pixel before it
constexpr int rows_of_band = 32;

constexpr std::uint8_t zlib_head[] = {0x78, 0x01};         // RFC 1950: deflate with a window of 32 KB, a fast level
constexpr std::uint8_t last_block[] = {0x03, 0x00};        // RFC 1951: an empty block that is the last
constexpr std::size_t head_and_end = 1024;                 // bytes of all chunks but the pixels': below 200

std::size_t row_bytes(int width) { return 3 * std::size_t(width) + 1; }

int band_count(int height) { return (height + rows_of_band - 1) / rows_of_band; }

struct Sink {
    std::vector<std::byte>* bytes;
    std::string error;
};

// libpng calls these between our setjmp and its own longjmp: nothing that must be destroyed may live across them,
// and no exception may pass through C code.
void append(png_structp png, png_bytep data, std::size_t size) {
    auto* sink = static_cast<Sink*>(png_get_io_ptr(png));
    bool out_of_memory = false;
    try {
        const auto* first = reinterpret_cast<const std::byte*>(data);
        sink->bytes->insert(sink->bytes->end(), first, first + size);
    } catch (const std::bad_alloc&) {
        out_of_memory = true;
    }
    if (out_of_memory) png_error(png, "out of memory");
}

void flush(png_structp) {}

void keep_error(png_structp png, png_const_charp message) {
    try {
        static_cast<Sink*>(png_get_error_ptr(png))->error = message;
    } catch (const std::bad_alloc&) {
    }
    png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

/// Everything libpng does, with only plain values on the stack. False: sink.error says why.
bool run_libpng(png_structp png, png_infop info, int width, int height, std::span<const std::span<const std::uint8_t>> parts,
                Sink& sink) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_write_fn(png, &sink, append, flush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    std::size_t size = 0;
    for (const auto& part : parts) size += part.size();
    png_write_chunk_start(png, reinterpret_cast<png_const_bytep>("IDAT"), static_cast<png_uint_32>(size));
    for (const auto& part : parts) png_write_chunk_data(png, part.data(), part.size());
    png_write_chunk_end(png);
    // png_write_end() would miss rows that went through libpng itself.
    png_write_chunk(png, reinterpret_cast<png_const_bytep>("IEND"), nullptr, 0);
    return true;
}

/// The row's filter, then R, G and B of each pixel less those of the pixel before.
void pack_row(const std::uint8_t* from, int width, std::uint8_t* to) {
    *to++ = filter_sub;
    for (int c = 0; c < 3; ++c) to[c] = from[c];
    for (int x = 1; x < width; ++x)
        for (int c = 0; c < 3; ++c) to[3 * x + c] = static_cast<std::uint8_t>(from[4 * x + c] - from[4 * x - 4 + c]);
}

}  // namespace

void PngEncoder::compress(const Image& image, int first_row, Band& band) {
    const int rows = std::min(rows_of_band, image.height - first_row);
    rows_.resize(row_bytes(image.width) * std::size_t(rows));
    for (int y = 0; y < rows; ++y)
        pack_row(image.at(0, first_row + y), image.width, rows_.data() + row_bytes(image.width) * std::size_t(y));
    band.checksum = isal_adler32(1, rows_.data(), rows_.size());
    band.compressed.resize(Deflater::bound(rows_.size()));
    band.compressed.resize(deflater_.compress({std::as_bytes(std::span(rows_))}, Deflater::End::whole_byte,
                                              std::as_writable_bytes(std::span(band.compressed))));
}

std::span<const std::byte> PngEncoder::encode(const Image& image) {
    const Rectangle whole{0, 0, image.width, image.height};
    return encode(image, {&whole, 1});
}

std::span<const std::byte> PngEncoder::encode(const Image& image, std::span<const Rectangle> changed) {
    TUMBLE_CHECK_EQ(image.pixels.size(), std::size_t(image.width) * std::size_t(image.height) * 4);
    const auto fail = [&](const std::string& why) {
        throw RunError(fmt::format("cannot make a PNG of {} x {} pixels: {}", image.width, image.height, why));
    };
    if (image.pixels.empty()) fail("it is empty");
    const bool all = image.width != width_ || image.height != height_;
    width_ = image.width;
    height_ = image.height;
    bands_.resize(std::size_t(band_count(height_)));

    std::uint32_t checksum = 1;
    std::vector<std::span<const std::uint8_t>> parts{zlib_head};
    for (std::size_t i = 0; i < bands_.size(); ++i) {
        const int first = int(i) * rows_of_band, rows = std::min(rows_of_band, height_ - first);
        const auto touches = [&](const Rectangle& r) { return r.y < first + rows && r.y + r.height > first; };
        if (all || std::ranges::any_of(changed, touches)) compress(image, first, bands_[i]);
        const std::size_t bytes = row_bytes(width_) * std::size_t(rows);
        checksum = static_cast<std::uint32_t>(adler32_combine(checksum, bands_[i].checksum, static_cast<z_off_t>(bytes)));
        parts.emplace_back(bands_[i].compressed);
    }
    std::array<std::uint8_t, 4> end;
    for (std::size_t i = 0; i < 4; ++i) end[i] = static_cast<std::uint8_t>(checksum >> (24 - 8 * i));
    parts.emplace_back(last_block);
    parts.emplace_back(end);

    file_.clear();
    Sink sink{&file_, {}};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, keep_error, ignore_warning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    const bool done = info != nullptr && run_libpng(png, info, width_, height_, parts, sink);
    png_destroy_write_struct(&png, &info);
    if (!done) fail(sink.error.empty() ? "out of memory" : sink.error);
    return file_;
}

std::size_t png_bytes_bound(int width, int height) {
    return head_and_end + std::size_t(band_count(height)) * Deflater::bound(row_bytes(width) * rows_of_band);
}

void write_png(const std::filesystem::path& path, const Image& image) {
    PngEncoder encoder;
    write_file(path, encoder.encode(image));
}

}  // namespace tumble
