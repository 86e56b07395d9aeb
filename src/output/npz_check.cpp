#include "output/npz_check.h"

#include "output/file_bytes.h"

#include <fmt/format.h>
#include <isa-l/crc.h>

#include <algorithm>
#include <array>

namespace tumble {
namespace {

constexpr std::string_view keyword = "Tumble-Scene ";
constexpr std::size_t mark_size = 64, checksum_size = 8;  // digits
constexpr std::size_t comment_size = keyword.size() + mark_size + 1 + checksum_size;
constexpr std::size_t end_record_size = 22;

}  // namespace

std::string npz_comment(std::string_view mark, std::uint32_t checksum) {
    return fmt::format("{}{} {:08x}", keyword, mark, checksum);
}

std::optional<std::string> mark_of_whole_npz(const std::filesystem::path& path) {
    const std::optional<std::string> file = bytes_of_file(path);
    constexpr std::size_t end_size = end_record_size + comment_size;
    if (!file || file->size() < end_size) return std::nullopt;
    const std::size_t end = file->size() - end_size;
    const std::string_view comment = std::string_view(*file).substr(end + end_record_size);
    const std::string_view mark = comment.substr(keyword.size(), mark_size);
    const auto* bytes = reinterpret_cast<const unsigned char*>(file->data());
    // The record has a signature, numbers that the checksum of the directory does not cover, and the comment's size.
    const std::array<unsigned char, 4> signature{'P', 'K', 5, 6};
    const bool record = std::equal(signature.begin(), signature.end(), bytes + end) &&
                        bytes[end + 20] == comment_size && bytes[end + 21] == 0;
    const std::uint64_t directory = bytes[end + 16] | std::uint64_t(bytes[end + 17]) << 8 |
                                    std::uint64_t(bytes[end + 18]) << 16 | std::uint64_t(bytes[end + 19]) << 24;
    const std::uint64_t directory_size = bytes[end + 12] | std::uint64_t(bytes[end + 13]) << 8 |
                                         std::uint64_t(bytes[end + 14]) << 16 | std::uint64_t(bytes[end + 15]) << 24;
    if (!record || directory + directory_size != end) return std::nullopt;
    if (comment != npz_comment(mark, crc32_gzip_refl(0, bytes, end))) return std::nullopt;
    return std::string(mark);
}

}  // namespace tumble
