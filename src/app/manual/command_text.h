// The commands and options of the program as plain data: for manual pages, completions of shells, and other programs.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tumble::manual {

/// The values of an option, which a shell can offer. There may be alternatives: words, or a file.
struct ValueKind {
    std::vector<std::string> words;    // choices
    bool word_list = false;            // several of the words, separated by commas
    bool files = false;                // names of files,
    std::vector<std::string> endings;  // of these kinds, without the dot; empty: all
    bool folders = false;              // names of folders
    bool number = false;

    bool offers_nothing() const { return words.empty() && !files && !folders; }
};

/// An option, or an argument of a command.
struct OptionText {
    std::vector<std::string> names;  // "-o" and "--output"; of an argument its only name
    std::string value;               // its name in the help, "CLIP"; empty for a flag
    std::string usual;               // the value without the option, "3"; empty: none, or as the help says
    std::string help;                // lines as in the help
    bool required = false;
    bool repeated = false;              // any number of values
    std::vector<std::string> excluded;  // names of options that cannot be given with it
    ValueKind kind;

    bool takes_value() const { return !value.empty(); }
};

/// A code and its meaning.
using ExitCode = std::pair<int, std::string>;

struct CommandText {
    std::string name;                  // "render"
    std::string description;           // one sentence without its full stop
    std::vector<ExitCode> exit_codes;  // empty: the exit codes of the program
    std::string notes, examples;       // lines below the options in the help
    std::vector<OptionText> arguments, options;
    std::vector<CommandText> commands;
};

/// "0 alike, 1 different"
std::string codes_text(const std::vector<ExitCode>& codes);

/// The description, and the command's own exit codes: "Compare pictures: exit code 0 alike, 1 different".
std::string sentence(const std::string& description, const std::vector<ExitCode>& codes);

/// The program with all commands as JSON (docs/reference/cli.md).
std::string to_json(const CommandText& program, const std::string& version);

/// The first sentence of a help text, cut to the width of a list of completions.
std::string short_help(const std::string& help);

/// The lines of a text.
std::vector<std::string> lines_of(const std::string& text);

/// Texts with a separator between them.
std::string joined(const std::vector<std::string>& texts, const std::string& separator);

/// A text with each occurrence of `from` replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace tumble::manual
