#include "output/npz_check.h"

#include "core/check.h"
#include "output/checksum.h"
#include "output/file_bytes.h"

#include <fmt/format.h>

namespace tumble {
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
