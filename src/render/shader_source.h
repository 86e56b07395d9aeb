// Shader text from files, with `#include "file"` lines resolved and every line's origin kept for the compiler's words.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// One shader ready for the compiler. `#line` directives number the files: source string number i is files[i].
struct ShaderSource {
    std::string text;
    std::vector<std::filesystem::path> files;

    /// A compiler log in which "N:LINE" or "N(LINE)" at the start of a line reads "FILE:LINE".
    std::string with_file_names(const std::string& log) const;
};

/// Reads folder/name and what it includes, each file once, from the same folder. `defines` (e.g. "SHADOWS 1") come
/// right after the first line, which must be the #version. Throws RunError for a missing file.
ShaderSource read_shader(const std::filesystem::path& folder, const std::string& name,
                         const std::vector<std::string>& defines = {});

}  // namespace tumble
