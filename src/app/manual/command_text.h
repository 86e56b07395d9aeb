// The commands and options of the program as plain data, for manual pages and completions of shells.
#pragma once

#include "app/manual/value_hint.h"

#include <string>
#include <vector>

namespace tumble::manual {

/// An option, or an argument of a command.
struct OptionText {
    std::vector<std::string> names;  // "-o" and "--output"; of an argument its only name
    std::string value;               // as in the help, "CLIP" or "N [3]"; empty for a flag
    std::string help;                // lines as in the help
    bool required = false;
    bool repeated = false;                   // any number of values
    std::vector<std::string> excluded;       // names of options that cannot be given with it
    ValueHint hint = ValueHint::of("", "");  // of its value

    bool takes_value() const { return !value.empty(); }
};

struct CommandText {
    std::string name;         // "render"
    std::string description;  // one sentence without its full stop
    std::string footer;       // below the options in the help
    std::vector<OptionText> arguments, options;
    std::vector<CommandText> commands;
};

/// The first sentence of a help text, cut to the width of a list of completions.
std::string short_help(const std::string& help);

/// The lines of a text.
std::vector<std::string> lines_of(const std::string& text);

/// Texts with a separator between them.
std::string joined(const std::vector<std::string>& texts, const std::string& separator);

/// A text with each occurrence of `from` replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace tumble::manual
