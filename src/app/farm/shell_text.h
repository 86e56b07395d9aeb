// Words in shell scripts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// True if the word means itself in a POSIX shell and in a line of #SBATCH, without quotes.
bool is_plain_word(std::string_view text);

/// The word as a POSIX shell reads it, for any characters: plain where possible, otherwise in single quotes.
std::string shell_word(std::string_view text);

/// "NAME=( WORD WORD )": an array of bash.
std::string shell_array(std::string_view name, const std::vector<std::string>& words);

}  // namespace tumble
