#include "output/npz_archive.h"

#include "core/check.h"
#include "core/error.h"
#include "output/file_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

namespace tumble {
namespace {

static_assert(std::endian::native == std::endian::little);  // the byte order in the arrays' types

constexpr std::size_t npy_alignment = 64;          // bytes: the values of an .npy file start at a multiple of it
constexpr std::size_t most_of_names = 1024;        // bytes of all headers of one array: below 300
constexpr std::size_t most_of_small_array = 1024;  // bytes of values: a camera has 128
constexpr std::uint16_t deflated = 8, version = 20;
constexpr std::uint16_t first_day = 1 << 5 | 1;  // 1980-01-01, the first date of the zip format

/// The header of an .npy file, format 1.0.
std::string npy_head(const std::string& kind, const ArrayShape& shape) {
    std::string dimensions;
    for (const std::size_t length : shape) dimensions += fmt::format("{}, ", length);
    std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", kind, dimensions);
    const std::size_t before = 10;  // magic, version and length
    while ((before + header.size() + 1) % npy_alignment != 0) header += ' ';
    header += '\n';
    std::string head = "\x93NUMPY";
    head += '\x01';
    head += '\0';
    head += char(header.size() & 0xff);
    head += char(header.size() >> 8);
    return head + header;
}

/// A sequence of little-endian numbers.
class LittleEndianBytes {
public:
    LittleEndianBytes& u16(std::size_t value) { return number(value, 2); }
    LittleEndianBytes& u32(std::size_t value) { return number(value, 4); }
    LittleEndianBytes& text(std::string_view value) {
        bytes_ += value;
        return *this;
    }
    std::span<const std::byte> all() const { return std::as_bytes(std::span(bytes_)); }

private:
    LittleEndianBytes& number(std::size_t value, int size) {
        for (int i = 0; i < size; ++i) bytes_ += char(value >> (8 * i) & 0xff);
        return *this;
    }
    std::string bytes_;
};

void copy_to(std::vector<std::byte>& file, std::size_t& used, std::span<const std::byte> bytes) {
    if (file.size() < used + bytes.size()) file.resize(used + bytes.size());
    std::memcpy(file.data() + used, bytes.data(), bytes.size());
    used += bytes.size();
}

}  // namespace

void NpzArchive::add(std::string_view name, const ArrayShape& shape, std::span<const float> values) {
    add_bytes(name, "<f4", shape, std::as_bytes(values));
}
void NpzArchive::add(std::string_view name, const ArrayShape& shape, std::span<const double> values) {
    add_bytes(name, "<f8", shape, std::as_bytes(values));
}
void NpzArchive::add(std::string_view name, const ArrayShape& shape, std::span<const std::int32_t> values) {
    add_bytes(name, "<i4", shape, std::as_bytes(values));
}
void NpzArchive::add(std::string_view name, const ArrayShape& shape, std::span<const std::uint8_t> values) {
    add_bytes(name, "|u1", shape, std::as_bytes(values));
}

/// Appends to the file; returns the number of bytes.
std::uint32_t NpzArchive::compress(std::span<const std::byte> head, std::span<const std::byte> values) {
    const std::size_t room = Deflater::bound(head.size() + values.size());
    if (file_.size() < used_ + room) file_.resize(used_ + room);
    return static_cast<std::uint32_t>(
        deflater_.compress({head, values}, Deflater::End::last, std::span(file_).subspan(used_, room)));
}

/// The same; the compressed bytes of the previous file's array are taken if its content is the same.
std::uint32_t NpzArchive::compress_small(std::span<const std::byte> head, std::span<const std::byte> values) {
    small_.resize(std::max(small_.size(), members_.size() + 1));
    SmallArray& before = small_[members_.size()];
    const auto same = [&] {
        return before.content.size() == head.size() + values.size() &&
               std::equal(head.begin(), head.end(), before.content.begin()) &&
               std::equal(values.begin(), values.end(), before.content.begin() + std::ptrdiff_t(head.size()));
    };
    if (!before.packed.empty() && same()) {
        std::size_t end = used_;
        copy_to(file_, end, before.packed);
        return std::uint32_t(before.packed.size());
    }
    const std::uint32_t packed = compress(head, values);
    const auto bytes = std::span(file_).subspan(used_, packed);
    before.packed.assign(bytes.begin(), bytes.end());
    before.content.assign(head.begin(), head.end());
    before.content.insert(before.content.end(), values.begin(), values.end());
    return packed;
}

void NpzArchive::add_bytes(std::string_view name, const std::string& kind, const ArrayShape& shape,
                           std::span<const std::byte> values) {
    const std::string text = npy_head(kind, shape);
    const std::span<const std::byte> head = std::as_bytes(std::span(text));
    if (used_ + bytes_bound(values.size()) > std::numeric_limits<std::uint32_t>::max())
        throw RunError(fmt::format("'{}' does not fit into an .npz file: it would have more than 4 GiB", name));

    Member member;
    member.name = fmt::format("{}.npy", name);
    member.offset = static_cast<std::uint32_t>(used_);
    member.size = static_cast<std::uint32_t>(head.size() + values.size());
    member.checksum = crc32_of(crc32_of(0, head), values);
    const std::size_t local = 30 + member.name.size();
    used_ += local;  // written below, when the compressed size is known
    member.packed = values.size() <= most_of_small_array ? compress_small(head, values) : compress(head, values);
    const std::size_t end = used_ + member.packed;
    used_ = member.offset;
    copy_to(file_, used_,
            LittleEndianBytes()
                .u32(0x04034b50)
                .u16(version)
                .u16(0)
                .u16(deflated)
                .u16(0)
                .u16(first_day)
                .u32(member.checksum)
                .u32(member.packed)
                .u32(member.size)
                .u16(member.name.size())
                .u16(0)
                .text(member.name)
                .all());
    used_ = end;
    members_.push_back(std::move(member));
}

std::span<const std::byte> NpzArchive::finish(std::string_view mark) {
    const std::size_t directory = used_;
    for (const Member& m : members_)
        copy_to(file_, used_,
                LittleEndianBytes()
                    .u32(0x02014b50)
                    .u16(version)
                    .u16(version)
                    .u16(0)
                    .u16(deflated)
                    .u16(0)
                    .u16(first_day)
                    .u32(m.checksum)
                    .u32(m.packed)
                    .u32(m.size)
                    .u16(m.name.size())
                    .u16(0)
                    .u16(0)
                    .u16(0)
                    .u16(0)
                    .u32(0)
                    .u32(m.offset)
                    .text(m.name)
                    .all());
    const std::size_t size = used_ - directory;
    copy_to(file_, used_,
            LittleEndianBytes()
                .u32(0x06054b50)
                .u16(0)
                .u16(0)
                .u16(members_.size())
                .u16(members_.size())
                .u32(size)
                .u32(directory)
                .u16(mark.empty() ? 0 : npz_comment_size)
                .all());
    if (!mark.empty()) {
        const std::string comment = npz_comment(mark, crc32_of(0, std::span<const std::byte>(file_).first(used_)));
        copy_to(file_, used_, std::as_bytes(std::span(comment)));
    }
    const std::size_t all = std::exchange(used_, 0);
    members_.clear();
    return std::span<const std::byte>(file_).first(all);
}

std::size_t NpzArchive::bytes_bound(std::size_t bytes_of_values) {
    return Deflater::bound(bytes_of_values) + most_of_names;
}

namespace {

constexpr std::string_view keyword = "Tumble-Scene ";
constexpr std::size_t mark_size = 64;

}  // namespace

std::string npz_comment(std::string_view mark, std::uint32_t checksum) {
    std::string comment = fmt::format("{}{} {:08x}", keyword, mark, checksum);
    TUMBLE_CHECK_EQ(comment.size(), npz_comment_size);
    return comment;
}

std::optional<std::string> mark_of_whole_npz(const std::filesystem::path& path) {
    const std::optional<std::string> file = bytes_of_file(path);
    if (!file || file->size() < npz_comment_size) return std::nullopt;
    const std::size_t before = file->size() - npz_comment_size;
    const std::string_view comment = std::string_view(*file).substr(before);
    const std::string_view mark = comment.substr(keyword.size(), mark_size);
    const std::uint32_t checksum = crc32_of(0, std::as_bytes(std::span(*file).first(before)));
    return comment == npz_comment(mark, checksum) ? std::optional(std::string(mark)) : std::nullopt;
}

}  // namespace tumble
