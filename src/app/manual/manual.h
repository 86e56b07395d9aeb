// Manual pages, and completions for shells: scripts that know the commands, the options and their values.
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

/// For bash 4 and later. It needs no other script; the package bash-completion only loads it.
std::string bash_completion(const CommandText& program);

/// For zsh: a file "_tumble" in a folder of its fpath; it can be sourced as well.
std::string zsh_completion(const CommandText& program);

/// For fish 3.
std::string fish_completion(const CommandText& program);

}  // namespace tumble::manual
