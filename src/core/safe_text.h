// Makes foreign text (names, titles, keys, file names, output of other programs) safe for a message: no cursor
// movement, no change of the terminal's state, no reversal of the reading direction, no line break, and a bounded
// length. Every such text passes through here on its way to standard output or standard error.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace tumble {

/// Bytes of a value in a message, so that the rest of the message stays visible.
inline constexpr std::size_t value_text_bytes = 80;
/// Bytes of a file name: PATH_MAX, the system's maximum, so that no name of an existing file is cut.
inline constexpr std::size_t path_text_bytes = 4096;
/// Bytes of a whole message: several file names.
inline constexpr std::size_t message_text_bytes = 16384;

/// Unprintable characters are written as escapes: control characters as \n, \t, \x1b; line separators, controls of the
/// reading direction and invisible characters as \u202e; bytes that are not UTF-8 as \xff. A result of more than
/// `longest` bytes ends after a complete character, with "... (N bytes)" and the length of the text. Backslashes are
/// kept, so that a safe text stays the same.
std::string safe_text(std::string_view text, std::size_t longest = value_text_bytes);

/// The same for text of several lines: line breaks and tabs stay.
std::string safe_lines(std::string_view text, std::size_t longest = message_text_bytes);

/// The same for a file name.
std::string safe_path(const std::filesystem::path& path);

/// True of characters that neither a line of a script nor a name can hold, such as line breaks and zero bytes.
bool has_control_characters(std::string_view text);

}  // namespace tumble
