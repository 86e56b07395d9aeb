// Text in the markup of manual pages (man(7), groff).
#pragma once

#include <string>
#include <vector>

namespace tumble::manual {

/// Characters that roff would take for markup are escaped.
std::string roff(const std::string& text);

/// The same for a file, option or command that users copy: hyphens are not typographic ones.
std::string roff_code(const std::string& text);

/// Lines of a help text as filled paragraphs. Indented lines and lists keep their line breaks.
std::string roff_paragraphs(const std::vector<std::string>& lines);

/// Lines as they are.
std::string roff_lines(const std::vector<std::string>& lines);

}  // namespace tumble::manual
