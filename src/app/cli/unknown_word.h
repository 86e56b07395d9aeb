// The words of a call that name no command and no option.
#pragma once

#include <CLI/CLI.hpp>

#include <span>
#include <string>

namespace tumble {

/// The mistake for a message, with the nearest name, of the first such word; empty: there is none. `words`: of the
/// command line after the program's name.
std::string unknown_word(const CLI::App& program, std::span<const char* const> words);

}  // namespace tumble
