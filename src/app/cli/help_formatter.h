// The help of commands in lines that fit a terminal.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace tumble {

/// Breaks texts where a line is full. A line break in a text counts as a space; a list without spaces breaks after a
/// comma. In notes and examples only a line that is too long is broken. Precondition: each CLI::App is a Command.
class HelpFormatter : public CLI::Formatter {
public:
    static constexpr std::size_t most_columns = 100;

    std::string make_description(const CLI::App* app) const override;
    std::string make_subcommand(const CLI::App* command) const override;
    std::string make_footer(const CLI::App* app) const override;
    std::string make_option_desc(const CLI::Option* option) const override;
};

}  // namespace tumble
