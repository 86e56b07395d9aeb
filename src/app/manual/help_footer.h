// The parts of the text below the options of a help text: notes, examples, exit codes.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tumble::manual {

struct HelpFooter {
    std::vector<std::string> notes;     // lines
    std::vector<std::string> examples;  // lines, indented
};

/// Examples are the indented lines below a line "Examples:", "Example:" or "Start here:".
HelpFooter read_footer(const std::string& footer);

using ExitCode = std::pair<int, std::string>;

/// The exit codes that a help text names, as in "Exit codes: 0 done, 1 failed, 2 wrong usage." Empty if there are none.
std::vector<ExitCode> exit_codes_in(const std::string& text);

}  // namespace tumble::manual
