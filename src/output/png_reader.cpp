#include "output/png_reader.h"

#include "core/available_memory.h"
#include "core/check.h"
#include "core/error.h"
#include "output/file_bytes.h"
#include "output/png_writer.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string_view>
#include <utility>

namespace tumble {

namespace {

namespace fs = std::filesystem;

/// State that libpng's callbacks may change: plain values, because its longjmp skips destructors.
struct Failure {
    char message[256] = {};
    bool out_of_memory = false;
};

void keep_error(png_structp png, png_const_charp message) {
    auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
    std::strncpy(failure->message, message, sizeof failure->message - 1);
    png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

// libpng has many messages for a lack of memory.
void* allocate(png_structp png, png_alloc_size_t size) {
    void* const memory = std::malloc(size);
    if (memory == nullptr) static_cast<Failure*>(png_get_mem_ptr(png))->out_of_memory = true;
    return memory;
}

void release(png_structp, void* memory) { std::free(memory); }

}  // namespace

/// libpng reports errors by longjmp: the functions that call it have no objects with destructors.
struct PngRows::File {
    OpenFile file;
    std::string name;
    Failure failure;
    png_structp png = nullptr;
    png_infop info = nullptr;
    int width = 0, height = 0, passes = 1;

    File(OpenFile opened_file, const std::string& its_name) : file(std::move(opened_file)), name(its_name) {
        png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &failure, keep_error, ignore_warning, &failure, allocate,
                                       release);
        info = png != nullptr ? png_create_info_struct(png) : nullptr;
        if (info == nullptr) failure.out_of_memory = true;
    }
    ~File() { png_destroy_read_struct(&png, &info, nullptr); }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    SourceLocation at() const { return {name, 0, 0}; }

    [[noreturn]] void fail() const {
        if (failure.out_of_memory) throw std::bad_alloc();
        throw InputError(at(), fmt::format("not a whole PNG file: {}", failure.message));
    }

    /// False: `failure` has the reason.
    bool read_head() {
        if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) return false;
        // The only optional chunks that are read: they define the meaning of the numbers.
        static constexpr png_byte meaning[] = "bKGD\0cHRM\0gAMA\0iCCP\0sBIT\0sRGB";
        png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_AS_DEFAULT, meaning, int(sizeof meaning / 5));
        png_init_io(png, file.get());
        png_read_info(png, info);
        width = static_cast<int>(png_get_image_width(png, info));
        height = static_cast<int>(png_get_image_height(png, info));
        return true;
    }

    /// Like libpng's simplified reader: 16-bit files are sRGB like the 8-bit ones, unless they contain another gamma.
    bool choose_pixel_format() {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_set_expand(png);
        png_set_gray_to_rgb(png);
        png_set_alpha_mode_fixed(png, PNG_ALPHA_PNG, PNG_DEFAULT_sRGB);  // default of the file, and value of the rows
        png_set_scale_16(png);
        png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
        passes = png_set_interlace_handling(png);
        png_read_update_info(png, info);
        return true;
    }

    /// Gray samples of 8 or 16 bits, as they are.
    bool choose_gray_format() {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_set_expand_gray_1_2_4_to_8(png);
        passes = png_set_interlace_handling(png);
        png_read_update_info(png, info);
        return true;
    }

    bool read_row(std::uint8_t* to) {
        if (setjmp(png_jmpbuf(png)) != 0) return false;
        png_read_row(png, to, nullptr);
        return true;
    }
};

PngRows::PngRows(const fs::path& path) : PngRows(open_input_file(path), path.string()) {}

PngRows::PngRows(OpenFile file, const std::string& name) : file_(std::make_unique<File>(std::move(file), name)) {
    if (!file_->read_head()) file_->fail();
    if (std::int64_t(file_->width) * file_->height > max_image_pixels)
        throw InputError(file_->at(), fmt::format("the picture is too large ({} x {}; at most {} pixels)", file_->width,
                                                  file_->height, max_image_pixels));
    if (!file_->choose_pixel_format()) file_->fail();
    TUMBLE_CHECK_EQ(png_get_rowbytes(file_->png, file_->info), 4 * std::size_t(file_->width));
}

PngRows::~PngRows() = default;

ImageSize PngRows::size() const { return {file_->width, file_->height}; }

bool PngRows::interlaced() const { return file_->passes > 1; }

void PngRows::read_interlaced() {
    require_memory(4 * std::uint64_t(file_->width) * std::uint64_t(file_->height),
                   fmt::format("an interlaced picture of {} x {} pixels", file_->width, file_->height),
                   "saved without interlacing, it is read row by row");
    whole_ = Image(file_->width, file_->height);
    for (int pass = 0; pass < file_->passes; ++pass)
        for (int y = 0; y < file_->height; ++y)
            if (!file_->read_row(whole_.at(0, y))) file_->fail();
}

std::span<const std::uint8_t> PngRows::next() {
    TUMBLE_CHECK_LT(next_, file_->height);
    const std::size_t bytes = 4 * std::size_t(file_->width);
    if (interlaced()) {
        if (next_ == 0) read_interlaced();
        return {whole_.at(0, next_++), bytes};
    }
    row_.resize(bytes);
    if (!file_->read_row(row_.data())) file_->fail();
    ++next_;
    return row_;
}

Image PngRows::all() {
    TUMBLE_CHECK_EQ(next_, 0);
    if (interlaced()) {
        read_interlaced();
        return std::move(whole_);
    }
    Image image(file_->width, file_->height);
    for (int y = 0; y < image.height; ++y)
        if (!file_->read_row(image.at(0, y))) file_->fail();
    return image;
}

GrayImage read_gray_png(const fs::path& path, std::int64_t most) {
    PngRows::File file(open_input_file(path), path.string());
    if (!file.read_head()) file.fail();
    if (png_get_color_type(file.png, file.info) != PNG_COLOR_TYPE_GRAY)
        throw InputError(file.at(), "the picture must be gray, without colors and without alpha");
    if (std::int64_t(file.width) * file.height > most)
        throw InputError(file.at(), fmt::format("the picture is too large ({} x {}; at most {} pixels)", file.width,
                                                file.height, most));
    if (!file.choose_gray_format()) file.fail();
    const std::size_t bytes = png_get_rowbytes(file.png, file.info), width = std::size_t(file.width);
    std::vector<std::uint8_t> rows(bytes * std::size_t(file.height));
    for (int pass = 0; pass < file.passes; ++pass)
        for (int y = 0; y < file.height; ++y)
            if (!file.read_row(rows.data() + bytes * std::size_t(y))) file.fail();
    GrayImage image{file.width, file.height, {}};
    image.samples.reserve(width * std::size_t(file.height));
    const bool deep = bytes == 2 * width;
    for (std::size_t i = 0; i < width * std::size_t(file.height); ++i)
        image.samples.push_back(deep ? std::uint16_t(rows[2 * i] << 8 | rows[2 * i + 1])
                                     : std::uint16_t(257 * rows[i]));
    return image;
}

Image read_png(const fs::path& path) { return PngRows(path).all(); }

ImageSize read_png_size(const fs::path& path) { return PngRows(path).size(); }

namespace {

constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i) number = number << 8 | static_cast<unsigned char>(bytes[at + i]);
    return number;
}

/// State of a file that starts with these bytes, up to the first fault.
PngState state_of(std::string_view bytes) {
    PngState state;
    if (!bytes.starts_with(signature)) return state;
    bool head = false, pixels = false;
    for (std::size_t at = signature.size(); at + 12 <= bytes.size();) {
        const std::size_t size = number_at(bytes, at);
        if (size > bytes.size() - at - 12) return state;
        const std::string_view name = bytes.substr(at + 4, 4), data = bytes.substr(at + 8, size);
        const std::string_view checked = bytes.substr(at + 4, 4 + size);
        if (crc32_of(0, std::as_bytes(std::span(checked))) != number_at(bytes, at + 8 + size)) return state;
        at += 12 + size;
        if (!head && name != "IHDR") return state;
        head = true;
        pixels = pixels || name == "IDAT";
        if (name == "tEXt" && data.starts_with(png_mark_keyword) && data.size() > png_mark_keyword.size() &&
            data[png_mark_keyword.size()] == '\0')
            state.mark = data.substr(png_mark_keyword.size() + 1);
        if (name == "IEND") {
            state.whole = pixels && at == bytes.size();
            return state;
        }
    }
    return state;
}

}  // namespace

PngState state_of_png(const std::filesystem::path& path) {
    const std::optional<std::string> file = bytes_of_file(path);
    return file ? state_of(*file) : PngState();
}

std::optional<std::string> mark_of_png(const std::filesystem::path& path) {
    constexpr std::size_t head = 512;  // bytes: the mark ends at 150
    const std::optional<std::string> file = bytes_of_file(path, head);
    return file ? state_of(*file).mark : std::nullopt;
}

}  // namespace tumble
