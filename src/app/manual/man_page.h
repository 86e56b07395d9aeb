// Manual pages: tumble(1), and one for each command, from the texts of the help.
#pragma once

#include "app/manual/command_text.h"

#include <string>
#include <vector>

namespace tumble::manual {

struct ManPage {
    std::string file;  // "tumble-render.1"
    std::string text;  // roff
};

/// The pages of the program and its commands. They name no date, folder or machine, so that the same program has the
/// same pages.
std::vector<ManPage> man_pages(const CommandText& program, const std::string& version);

}  // namespace tumble::manual
