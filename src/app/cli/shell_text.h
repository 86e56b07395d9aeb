// A command as text that a shell reads as the same command.
#pragma once

#include <span>
#include <string>

namespace tumble {

/// Words in single quotes where they need them. Empty if a word has control characters or the text is too long for a
/// message.
std::string shell_text(std::span<const char* const> words);

}  // namespace tumble
