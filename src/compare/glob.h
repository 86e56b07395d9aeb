// Patterns of file names.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tumble {

/// True if the pattern stands for the name, a relative path with '/'.
///   *      any characters of a name, but no '/'
///   **     any characters, with '/'; `a/**/b` is also `a/b`
///   ?      one character, but no '/'
///   [a-z]  one of these characters; [!a-z] one of all others
///   \x     the character x
/// A pattern without '/' stands for the last part of the name, in any folder.
bool glob_matches(std::string_view pattern, std::string_view name);

/// The mistake of a pattern ("has a '[' without ']'"), or nothing.
std::optional<std::string> glob_mistake(std::string_view pattern);

}  // namespace tumble
