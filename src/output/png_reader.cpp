#include "output/png_reader.h"

#include "core/error.h"

#include <fmt/format.h>
#include <png.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

/// libpng's "simplified" reader: it keeps its own setjmp inside and reports errors as values.
class Reader {
public:
    explicit Reader(const fs::path& path) : path_(path) {
        std::error_code ignored;
        if (fs::is_directory(path, ignored)) throw InputError(at(), "is a folder, not a PNG file");
        file_.reset(std::fopen(path.c_str(), "rbe"));
        if (!file_) throw InputError(at(), "cannot be read: " + std::generic_category().message(errno));
        image_.version = PNG_IMAGE_VERSION;
        if (png_image_begin_read_from_stdio(&image_, file_.get()) == 0) fail();
        const std::int64_t pixels = std::int64_t(image_.width) * std::int64_t(image_.height);
        if (pixels > max_picture_pixels) {
            png_image_free(&image_);   // a constructor that throws is not followed by the destructor
            throw InputError(at(), fmt::format("the picture is too large ({} x {}; at most {} pixels)", image_.width,
                                               image_.height, max_picture_pixels));
        }
    }
    ~Reader() { png_image_free(&image_); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    PictureSize size() const { return {static_cast<int>(image_.width), static_cast<int>(image_.height)}; }

    Image pixels() {
        Image image(size().width, size().height);
        image_.format = PNG_FORMAT_RGBA;
        // 16-bit files are sRGB like the 8-bit ones, unless they say otherwise.
        image_.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
        if (png_image_finish_read(&image_, nullptr, image.pixels.data(), 0, nullptr) == 0) fail();
        return image;
    }

private:
    SourceLocation at() const { return {path_.string(), 0, 0}; }
    [[noreturn]] void fail() const { throw InputError(at(), fmt::format("not a whole PNG file: {}", image_.message)); }

    fs::path path_;
    std::unique_ptr<std::FILE, CloseFile> file_;
    png_image image_{};
};

}  // namespace

Image read_png(const fs::path& path) { return Reader(path).pixels(); }

PictureSize read_png_size(const fs::path& path) { return Reader(path).size(); }

}  // namespace tumble
