// Text that others wrote (names, titles, keys, file names, words of other programs) made fit for a message. Nothing in it
// moves the cursor, changes the terminal's state, reverses the order of reading or breaks the line, and it has a readable
// length. Every such text passes through here on its way to standard output or standard error.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace tumble {

/// Bytes of a value in a message: the rest of the message stays in sight.
inline constexpr std::size_t value_text_bytes = 80;
/// Bytes of a file name: PATH_MAX, the longest that the system takes, so that none that exists is cut.
inline constexpr std::size_t path_text_bytes = 4096;
/// Bytes of a whole message: several file names.
inline constexpr std::size_t message_text_bytes = 16384;

/// Characters that are not shown as themselves are written as escapes: control characters as \n, \t, \x1b; line separators,
/// controls of the reading direction and invisible characters as \u202e; bytes that are not UTF-8 as \xff. A result of more
/// than `longest` bytes ends after a whole character, in "... (N bytes)" with the text's own length. Backslashes stay:
/// making a text safe twice changes nothing more.
std::string safe_text(std::string_view text, std::size_t longest = value_text_bytes);

/// The same for text of several lines: line breaks and tabs stay.
std::string safe_lines(std::string_view text, std::size_t longest = message_text_bytes);

/// The same for a file name.
std::string safe_path(const std::filesystem::path& path);

}  // namespace tumble
