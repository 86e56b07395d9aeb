#include "output/png_writer.h"

#include "core/check.h"
#include "core/error.h"
#include "output/file_bytes.h"
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
#include <string_view>
#include <utility>

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace tumble {
namespace {

// Measured in deflater.cpp.
constexpr std::uint8_t filter_sub = 1;  // first byte of each row: differences to the pixel before
constexpr int rows_of_band = 32;

constexpr std::uint8_t zlib_head[] = {0x78, 0x01};   // RFC 1950: deflate with a window of 32 KB, a fast level
constexpr std::uint8_t last_block[] = {0x03, 0x00};  // RFC 1951: an empty block that is the last
constexpr std::size_t head_and_end = 1024;           // bytes of all chunks but the pixels': below 300

std::size_t row_bytes(int width, int channels) { return std::size_t(channels) * std::size_t(width) + 1; }

int band_count(int height) { return (height + rows_of_band - 1) / rows_of_band; }

[[noreturn]] void fail(int width, int height, const std::string& why) {
    throw RunError(fmt::format("cannot make a PNG of {} x {} pixels: {}", width, height, why));
}

struct Sink {
    std::vector<std::byte>* bytes;
    std::string error;
};

// libpng calls these between setjmp and its longjmp: they must not have objects with destructors, and no exception may
// pass through C code.
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

void keep_write_error(png_structp png, png_const_charp message) {
    try {
        static_cast<Sink*>(png_get_error_ptr(png))->error = message;
    } catch (const std::bad_alloc&) {
    }
    png_longjmp(png, 1);
}

void ignore_write_warning(png_structp, png_const_charp) {}

/// Writes the part before the pixels, with only plain values on the stack. False: sink.error has the reason.
bool write_head(png_structp png, png_infop info, int width, int height, int channels, Sink& sink) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_write_fn(png, &sink, append, flush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
                 channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    return true;
}

std::array<std::uint8_t, 4> big_end_first(std::uint32_t number) {
    std::array<std::uint8_t, 4> bytes;
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(number >> (24 - 8 * i));
    return bytes;
}

void append_number(std::vector<std::byte>& to, std::uint32_t number) {
    for (const std::uint8_t byte : big_end_first(number)) to.push_back(std::byte(byte));
}

/// Appends a chunk with its checksum, ten times as fast as libpng.
void append_chunk(std::vector<std::byte>& to, std::string_view name,
                  std::span<const std::span<const std::uint8_t>> segments) {
    std::size_t size = 0;
    for (const auto& segment : segments) size += segment.size();
    append_number(to, static_cast<std::uint32_t>(size));
    const std::size_t first = to.size();
    for (const char c : name) to.push_back(std::byte(c));
    for (const auto& segment : segments) {
        const auto bytes = std::as_bytes(segment);
        to.insert(to.end(), bytes.begin(), bytes.end());
    }
    append_number(to, crc32_of(0, std::span<const std::byte>(to).subspan(first)));
}

/// R, G and B of the pixels from `first` on, less R, G and B of the pixel before.
void pack_pixels(const std::uint8_t* from, int first, int width, std::uint8_t* to) {
    for (int x = first; x < width; ++x)
        for (int c = 0; c < 3; ++c) to[3 * x + c] = static_cast<std::uint8_t>(from[4 * x + c] - from[4 * x - 4 + c]);
}

/// All four channels, of all pixels.
void pack_pixels_with_alpha(const std::uint8_t* from, int width, std::uint8_t* to) {
    std::copy_n(from, 4, to);
    for (int i = 4; i < 4 * width; ++i) to[i] = static_cast<std::uint8_t>(from[i] - from[i - 4]);
}

#ifdef __x86_64__

/// R, G and B from the second pixel on, four at a time; returns the first one that is left. Each store is four bytes
/// too long; they are overwritten by the next store or by the remaining pixels.
__attribute__((target("ssse3"))) int pack_fours(const std::uint8_t* from, int width, std::uint8_t* to) {
    const __m128i without_alpha = _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1);
    int x = 1;
    for (; x + 6 <= width; x += 4) {
        const __m128i here = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + 4 * x));
        const __m128i before = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + 4 * x - 4));
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to + 3 * x),
                         _mm_shuffle_epi8(_mm_sub_epi8(here, before), without_alpha));
    }
    return x;
}

#endif

/// The row's filter, then its pixels.
void pack_row(const std::uint8_t* from, int width, int channels, std::uint8_t* to) {
    *to++ = filter_sub;
    if (channels == 4) return pack_pixels_with_alpha(from, width, to);
    std::copy_n(from, 3, to);
    int next = 1;
#ifdef __x86_64__
    if (__builtin_cpu_supports("ssse3")) next = pack_fours(from, width, to);
#endif
    pack_pixels(from, next, width, to);
}

}  // namespace

void PngEncoder::compress(const Image& image, int first_row, Band& band) {
    const int rows = std::min(rows_of_band, image.height - first_row);
    const std::size_t row = row_bytes(image.width, channels_);
    rows_.resize(row * std::size_t(rows));
    for (int y = 0; y < rows; ++y)
        pack_row(image.at(0, first_row + y), image.width, channels_, rows_.data() + row * std::size_t(y));
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
    if (image.pixels.empty()) fail(image.width, image.height, "it is empty");
    const bool all = image.width != width_ || image.height != height_;
    width_ = image.width;
    height_ = image.height;
    bands_.resize(std::size_t(band_count(height_)));

    std::uint32_t checksum = 1;
    std::vector<std::span<const std::uint8_t>> segments{zlib_head};
    for (std::size_t i = 0; i < bands_.size(); ++i) {
        const int first = int(i) * rows_of_band, rows = std::min(rows_of_band, height_ - first);
        const auto touches = [&](const Rectangle& r) { return r.y < first + rows && r.y + r.height > first; };
        if (all || std::ranges::any_of(changed, touches)) compress(image, first, bands_[i]);
        const std::size_t bytes = row_bytes(width_, channels_) * std::size_t(rows);
        checksum =
            static_cast<std::uint32_t>(adler32_combine(checksum, bands_[i].checksum, static_cast<z_off_t>(bytes)));
        segments.emplace_back(bands_[i].compressed);
    }
    const std::array<std::uint8_t, 4> end = big_end_first(checksum);
    segments.emplace_back(last_block);
    segments.emplace_back(end);

    if (all) make_head();
    file_.assign(head_.begin(), head_.end());
    append_chunk(file_, "IDAT", segments);
    append_chunk(file_, "IEND", {});
    return file_;
}

void PngEncoder::make_head() {
    head_.clear();
    Sink sink{&head_, {}};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, keep_write_error, ignore_write_warning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    const bool done = info != nullptr && write_head(png, info, width_, height_, channels_, sink);
    png_destroy_write_struct(&png, &info);
    if (done && !mark_.empty()) {
        const std::string text = std::string(png_mark_keyword) + '\0' + mark_;
        const std::span<const std::uint8_t> segments[] = {
            {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}};
        append_chunk(head_, "tEXt", segments);
    }
    if (done) return;
    const int width = std::exchange(width_, 0);  // the next image is a first one
    fail(width, height_, sink.error.empty() ? "out of memory" : sink.error);
}

std::size_t png_bytes_bound(int width, int height, PngAlpha alpha) {
    const std::size_t row = row_bytes(width, alpha == PngAlpha::kept ? 4 : 3);
    return head_and_end + std::size_t(band_count(height)) * Deflater::bound(row * rows_of_band);
}

PngRowWriter::PngRowWriter(const std::filesystem::path& path, int width, int height)
    : file_(path), band_(width, std::min(rows_of_band, height)), height_(height) {
    if (band_.pixels.empty()) fail(width, height, "it is empty");
    encoder_.width_ = width;
    encoder_.height_ = height;
    encoder_.make_head();
    file_.write(encoder_.head_);
}

void PngRowWriter::add_row(std::span<const std::uint8_t> row) {
    TUMBLE_CHECK_LT(rows_, height_);
    TUMBLE_CHECK_EQ(row.size(), 4 * std::size_t(band_.width));
    std::ranges::copy(row, band_.at(0, rows_ % rows_of_band));
    ++rows_;
    if (rows_ % rows_of_band == 0 || rows_ == height_) write_band();
}

void PngRowWriter::write_band() {
    const int rows = (rows_ - 1) % rows_of_band + 1;
    const bool first = rows_ == rows;
    if (rows < band_.height) {  // the last band
        band_.height = rows;
        band_.pixels.resize(4 * std::size_t(band_.width) * std::size_t(rows));
    }
    encoder_.compress(band_, 0, compressed_);
    const std::size_t bytes = row_bytes(band_.width, encoder_.channels_) * std::size_t(rows);
    checksum_ =
        static_cast<std::uint32_t>(adler32_combine(checksum_, compressed_.checksum, static_cast<z_off_t>(bytes)));
    std::vector<std::span<const std::uint8_t>> segments;
    if (first) segments.emplace_back(zlib_head);
    segments.emplace_back(compressed_.compressed);
    chunk_.clear();
    append_chunk(chunk_, "IDAT", segments);
    file_.write(chunk_);
}

void PngRowWriter::finish() {
    TUMBLE_CHECK_EQ(rows_, height_);
    const std::array<std::uint8_t, 4> end = big_end_first(checksum_);
    const std::span<const std::uint8_t> segments[] = {last_block, end};
    chunk_.clear();
    append_chunk(chunk_, "IDAT", segments);
    append_chunk(chunk_, "IEND", {});
    file_.write(chunk_);
    file_.commit();
}

void write_png(const std::filesystem::path& path, const Image& image, PngAlpha alpha) {
    PngEncoder encoder(alpha);
    write_file(path, encoder.encode(image));
}

}  // namespace tumble
