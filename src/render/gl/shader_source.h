// Shader text from files, with `#include "file"` lines resolved and the origin of every line kept for compiler
// messages.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// One shader ready for the compiler. Line origins are stored here, not in #line directives, because Mesa's compiler
/// drops their file numbers.
struct ShaderSource {
    struct Origin {
        std::size_t file;  // index into files
        int line;
    };
    std::string text;
    std::vector<std::filesystem::path> files;
    std::vector<Origin> lines;  // of each line of the text

    /// A compiler log in which "0:LINE" or "0(LINE)" at the start of a line reads "FILE:LINE".
    std::string with_file_names(const std::string& log) const;
};

/// Reads folder/name and its includes, each file once, from the same folder. `defines` (e.g. "SHADOWS 1") are placed
/// after the first line, which must be the #version. Throws RunError for a missing file.
ShaderSource read_shader(const std::filesystem::path& folder, const std::string& name,
                         const std::vector<std::string>& defines = {});

// The folder of the shader files.

/// $TUMBLE_SHADERS if set; otherwise a folder beside the installed program or shared library; otherwise the source tree
/// of the build. Throws RunError that names the searched folders.
std::filesystem::path find_shader_folder();

}  // namespace tumble
