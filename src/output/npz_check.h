// The mark of an .npz file, and whether the file is whole, without unpacking it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace tumble {

/// The zip comment of a marked file: the mark of 64 characters, and the CRC-32 of all bytes before the comment.
inline constexpr std::size_t npz_comment_size = 86;
std::string npz_comment(std::string_view mark, std::uint32_t checksum);

/// The mark of a file whose bytes all have the checksum in its comment; empty for a damaged, cut or unmarked file, or
/// where there is none.
std::optional<std::string> mark_of_whole_npz(const std::filesystem::path& path);

}  // namespace tumble
