#include "output/clip_check.h"

#include "core/error.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// The fault, thrown by the parsers.
struct Fault {
    std::string text;
};

/// A file with random access.
class FileBytes {
public:
    explicit FileBytes(const fs::path& path) : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
        struct stat status {};
        if (file_ < 0 || ::fstat(file_, &status) != 0) {
            const int error = errno;
            if (file_ >= 0) ::close(file_);
            throw Fault{"the file cannot be read: " + std::generic_category().message(error)};
        }
        size_ = static_cast<std::uint64_t>(status.st_size);
    }
    ~FileBytes() { ::close(file_); }
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    std::uint64_t size() const { return size_; }

    std::uint8_t at(std::uint64_t place) {
        if (place < window_at_ || place >= window_at_ + filled_) {
            const ssize_t n =
                place < size_ ? ::pread(file_, window_.data(), window_.size(), static_cast<off_t>(place)) : 0;
            if (n <= 0) throw Fault{"the file ends too early"};
            window_at_ = place;
            filled_ = static_cast<std::uint64_t>(n);
        }
        return window_[static_cast<std::size_t>(place - window_at_)];
    }

    /// A big-endian number.
    std::uint64_t number(std::uint64_t place, int bytes) {
        std::uint64_t value = 0;
        for (int i = 0; i < bytes; ++i) value = value << 8 | at(place + static_cast<std::uint64_t>(i));
        return value;
    }

    std::string text(std::uint64_t place, std::uint64_t bytes) {
        std::string text;
        for (std::uint64_t i = 0; i < bytes; ++i) text += static_cast<char>(at(place + i));
        return text;
    }

private:
    int file_;
    std::uint64_t size_ = 0, window_at_ = 0, filled_ = 0;
    std::array<std::uint8_t, 4096> window_;
};

/// MP4 and MOV (ISO/IEC 14496-12): nested boxes. Counts the samples of the tracks of pictures.
class BoxReader {
public:
    explicit BoxReader(FileBytes& file) : file_(file) {}

    std::int64_t frames() {
        walk(0, file_.size());
        if (!type_ || !data_) throw Fault{"it has no frames"};
        return samples_;
    }

private:
    void walk(std::uint64_t place, std::uint64_t end) {
        while (place < end) {
            std::uint64_t size = file_.number(place, 4), head = 8;
            const std::string type = file_.text(place + 4, 4);
            if (size == 1) {
                size = file_.number(place + 8, 8);
                head = 16;
            }
            if (place == 0 && type != "ftyp") throw Fault{"it is of another kind"};
            if (size < head || size > end - place) throw Fault{"the file ends too early"};
            if (type == "ftyp")
                type_ = true;
            else if (type == "mdat")
                data_ = true;
            else if (type == "hdlr" && file_.text(place + head + 8, 4) == "vide")
                pictures_ = true;
            else if (type == "hdlr" && file_.text(place + head + 8, 4) == "soun")
                pictures_ = false;
            else if (type == "stsz" && pictures_)
                samples_ += static_cast<std::int64_t>(file_.number(place + head + 8, 4));
            else if (type == "moov" || type == "trak" || type == "mdia" || type == "minf" || type == "stbl")
                walk(place + head, place + size);
            place += size;
        }
    }

    FileBytes& file_;
    bool type_ = false, data_ = false, pictures_ = true;
    std::int64_t samples_ = 0;
};

/// Matroska and WebM (RFC 9559): nested elements. Counts the blocks of the first track.
class ElementReader {
public:
    ElementReader(FileBytes& file, std::string_view kind) : file_(file), kind_(kind) {}

    std::int64_t frames() {
        enum : std::uint64_t {
            ebml = 0x1a45dfa3,
            doc_type = 0x4282,
            segment = 0x18538067,
            cluster = 0x1f43b675,
            block_group = 0xa0,
            block = 0xa1,
            simple_block = 0xa3
        };
        if (file_.number(0, 4) != ebml) throw Fault{"it is of another kind"};
        std::int64_t blocks = 0;
        std::string kind;
        while (position_ < file_.size()) {
            const std::uint64_t element = variable_number(true), size = variable_number(false);
            if (element == ebml || element == segment || element == cluster || element == block_group)
                continue;  // its content comes next
            if (size > file_.size() - position_) throw Fault{"the file ends too early"};
            constexpr std::uint8_t first_track = 0x81;  // with the mark of its length
            if ((element == block || element == simple_block) && size > 0 && file_.at(position_) == first_track)
                ++blocks;
            if (element == doc_type) kind = file_.text(position_, std::min<std::uint64_t>(size, 16));
            position_ += size;
        }
        if (kind.substr(0, kind.find('\0')) != kind_) throw Fault{"it is of another kind"};
        return blocks;
    }

private:
    /// The number of leading zeros gives the number of further bytes. The first one bit is part of an id, and only a
    /// marker in a length.
    std::uint64_t variable_number(bool with_mark) {
        const std::uint8_t first = file_.at(position_);
        int bytes = 1;
        while (bytes <= 8 && (first & (0x80 >> (bytes - 1))) == 0) ++bytes;
        if (bytes > 8) throw Fault{"it is of another kind"};
        std::uint64_t value = file_.number(position_, bytes);
        if (!with_mark) value &= ~(std::uint64_t(1) << (7 * bytes));
        position_ += static_cast<std::uint64_t>(bytes);
        return value;
    }

    FileBytes& file_;
    std::string_view kind_;
    std::uint64_t position_ = 0;
};

/// GIF (version 89a). Counts the images.
class GifReader {
public:
    explicit GifReader(FileBytes& file) : file_(file) {}

    std::int64_t frames() {
        constexpr int extension = 0x21, image = 0x2c, trailer = 0x3b;
        if (file_.text(0, 6) != "GIF89a") throw Fault{"it is of another kind"};
        position_ = 6 + 4;  // after the size of the screen
        skip_colors(2);
        for (std::int64_t images = 0;;) {
            switch (file_.at(position_++)) {
                case trailer:
                    return images;
                case extension:
                    ++position_;
                    break;
                case image:
                    ++images;
                    position_ += 8;
                    skip_colors(0);
                    ++position_;
                    break;
                default:
                    throw Fault{"it is broken"};
            }
            while (const std::uint8_t block = file_.at(position_++)) position_ += block;
        }
    }

private:
    /// Skips `more` bytes after the flags of a color table, and the table, if there is one.
    void skip_colors(std::uint64_t more) {
        const std::uint8_t flags = file_.at(position_);
        position_ += 1 + more;
        if ((flags & 0x80) != 0) position_ += std::uint64_t(3) << ((flags & 7) + 1);
    }

    FileBytes& file_;
    std::uint64_t position_ = 0;
};

std::int64_t frames_of(FileBytes& file, const std::string& container) {
    if (container == "gif") return GifReader(file).frames();
    if (container == "mp4" || container == "mov") return BoxReader(file).frames();
    return ElementReader(file, container).frames();
}

}  // namespace

std::optional<std::string> fault_of_clip(const fs::path& path, const std::string& container, std::int64_t frames) {
    try {
        FileBytes file(path);
        if (file.size() == 0) throw Fault{"the file is empty"};
        const std::int64_t found = frames_of(file, container);
        const bool complete = container == "gif" ? found > 0 && found <= frames : found == frames;
        if (!complete) throw Fault{fmt::format("it has {} frames of {}", found, frames)};
    } catch (const Fault& fault) {
        return fault.text;
    }
    return std::nullopt;
}

}  // namespace tumble
