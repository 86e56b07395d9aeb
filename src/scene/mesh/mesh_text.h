// Tokens and numbers of text mesh files (OBJ, STL).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tumble {

/// Reads a text line by line and token by token. A backslash at the end continues a line in the next one, and # begins
/// a comment.
class TextTokens {
public:
    explicit TextTokens(std::string_view text) : text_(text) {}

    /// The next token of the line; empty at the end of the line.
    std::string_view token();
    /// Goes to the next line; false at the end of the text.
    bool next_line();
    /// The number of the line, from 1.
    std::size_t line() const { return line_; }

private:
    bool at_line_end() const;
    bool skip_continuation();

    std::string_view text_;
    std::size_t at_ = 0, line_ = 1;
};

/// The words of a line from here on: the name of a material or of a file may hold spaces.
std::string rest_of_line(TextTokens& tokens);

/// A decimal number with a point or a comma, `nan` or `inf`. Integer part, fraction and power of ten are each rounded
/// to a float, as in assimp, so that coordinates equal those of assimp. Throws MeshError, which names the line, if the
/// token is not a number.
float mesh_number(std::string_view token, std::size_t line);

}  // namespace tumble
