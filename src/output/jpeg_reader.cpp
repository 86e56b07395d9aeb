#include "output/jpeg_reader.h"

#include "core/available_memory.h"
#include "core/check.h"
#include "core/error.h"

#include <fmt/format.h>

#include <jpeglib.h>
// After it, because it needs its types.
#include <jerror.h>

#include <csetjmp>
#include <new>
#include <utility>

namespace tumble {
namespace {

constexpr int most_scans = 500;  // of a progressive file: encoders make about ten, a hostile file thousands

/// State that libjpeg's callbacks may change: plain values, because longjmp skips destructors.
struct Failure {
    jpeg_error_mgr manager;  // first: libjpeg's pointer to it is one to this
    std::jmp_buf jump;
    char message[JMSG_LENGTH_MAX] = {};
    bool out_of_memory = false;
};

void fail(j_common_ptr jpeg) {
    auto* failure = reinterpret_cast<Failure*>(jpeg->err);
    failure->out_of_memory = jpeg->err->msg_code == JERR_OUT_OF_MEMORY;
    jpeg->err->format_message(jpeg, failure->message);
    std::longjmp(failure->jump, 1);
}

/// libjpeg warns of damaged data and goes on with gray pixels. Bytes between two parts are harmless.
void warn(j_common_ptr jpeg, int level) {
    if (level < 0 && jpeg->err->msg_code != JWRN_EXTRANEOUS_DATA) fail(jpeg);
}

void ignore(j_common_ptr) {}

void limit_scans(j_common_ptr jpeg) {
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= most_scans) return;
    jpeg->err->msg_code = JERR_BAD_PROGRESSION;
    fail(jpeg);
}

}  // namespace

/// libjpeg reports errors by longjmp: the functions that call it have no objects with destructors.
struct JpegRows::File {
    OpenFile file;
    std::string name;
    Failure failure;
    jpeg_progress_mgr progress{};
    jpeg_decompress_struct jpeg{};

    File(OpenFile opened_file, const std::string& its_name) : file(std::move(opened_file)), name(its_name) {
        jpeg.err = jpeg_std_error(&failure.manager);
        failure.manager.error_exit = fail;
        failure.manager.emit_message = warn;
        failure.manager.output_message = ignore;
        progress.progress_monitor = limit_scans;
    }
    ~File() { jpeg_destroy_decompress(&jpeg); }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    SourceLocation at() const { return {name, 0, 0}; }

    [[noreturn]] void throw_failure() const {
        if (failure.out_of_memory) throw std::bad_alloc();
        throw InputError(at(), fmt::format("not a whole JPEG file: {}", failure.message));
    }

    /// False: `failure` has the reason.
    bool read_head() {
        if (setjmp(failure.jump) != 0) return false;
        jpeg_create_decompress(&jpeg);
        jpeg.progress = &progress;
        jpeg_stdio_src(&jpeg, file.get());
        jpeg_read_header(&jpeg, TRUE);
        return true;
    }

    bool start() {
        if (setjmp(failure.jump) != 0) return false;
        jpeg.out_color_space = JCS_EXT_RGBA;
        jpeg.dct_method = JDCT_ISLOW;
        jpeg_start_decompress(&jpeg);
        return true;
    }

    bool read_row(std::uint8_t* to) {
        if (setjmp(failure.jump) != 0) return false;
        jpeg_read_scanlines(&jpeg, &to, 1);
        return true;
    }

    /// The end of the file is read with it.
    bool finish() {
        if (setjmp(failure.jump) != 0) return false;
        jpeg_finish_decompress(&jpeg);
        return true;
    }
};

JpegRows::JpegRows(OpenFile file, const std::string& name) : file_(std::make_unique<File>(std::move(file), name)) {
    if (!file_->read_head()) file_->throw_failure();
    const jpeg_decompress_struct& jpeg = file_->jpeg;
    const std::int64_t pixels = std::int64_t(jpeg.image_width) * jpeg.image_height;
    if (pixels > max_image_pixels)
        throw InputError(file_->at(), fmt::format("the picture is too large ({} x {}; at most {} pixels)",
                                                  jpeg.image_width, jpeg.image_height, max_image_pixels));
    if (jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK)
        throw InputError(file_->at(), "has colors for printing (CMYK); save it as RGB");
    if (jpeg.progressive_mode != FALSE)
        require_memory(6 * std::uint64_t(pixels),
                       fmt::format("a progressive picture of {} x {} pixels", jpeg.image_width, jpeg.image_height),
                       "saved as a baseline JPEG file, it is read row by row");
    if (!file_->start()) file_->throw_failure();
    TUMBLE_CHECK_EQ(jpeg.output_components, 4);
}

JpegRows::~JpegRows() = default;

ImageSize JpegRows::size() const { return {int(file_->jpeg.image_width), int(file_->jpeg.image_height)}; }

std::span<const std::uint8_t> JpegRows::next() {
    TUMBLE_CHECK_LT(next_, size().height);
    row_.resize(4 * std::size_t(size().width));
    if (!file_->read_row(row_.data())) file_->throw_failure();
    if (++next_ == size().height && !file_->finish()) file_->throw_failure();
    return row_;
}

}  // namespace tumble
