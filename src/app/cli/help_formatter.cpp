#include "app/cli/help_formatter.h"

#include "app/cli/command.h"

#include <algorithm>
#include <sstream>

namespace tumble {
namespace {

/// Takes the part of a word that fits, up to a comma; all of it if there is none.
std::string take_part(std::string& word, std::size_t columns) {
    const std::size_t comma = word.size() > columns ? word.rfind(',', columns - 1) : std::string::npos;
    std::string part = word.substr(0, comma == std::string::npos ? word.size() : comma + 1);
    word.erase(0, part.size());
    return part;
}

/// The words of a text in lines of at most so many columns, where no word is longer.
std::string in_lines(const std::string& text, std::size_t columns) {
    std::istringstream words(text);
    std::string lines;
    std::size_t column = 0;
    for (std::string word; words >> word;)
        while (!word.empty()) {
            const std::string part = take_part(word, columns);
            if (column > 0) {
                const bool fits = column + 1 + part.size() <= columns;
                lines += fits ? ' ' : '\n';
                column = fits ? column + 1 : 0;
            }
            lines += part;
            column += part.size();
        }
    return lines;
}

std::string sentence_of(const CLI::App* app) {
    const auto* const command = static_cast<const Command*>(app);
    return manual::sentence(command->get_description(), command->exit_codes);
}

}  // namespace

std::string HelpFormatter::make_description(const CLI::App* app) const {
    // The exit codes of the program are in its notes.
    const std::string text = app->get_parent() == nullptr ? app->get_description() : sentence_of(app);
    return in_lines(text, most_columns) + '\n';
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
    std::ostringstream out;
    CLI::detail::format_help(out, command->get_display_name(true),
                             in_lines(sentence_of(command), most_columns - get_column_width()), get_column_width());
    return out.str();
}

std::string HelpFormatter::make_footer(const CLI::App* app) const {
    const auto* const command = static_cast<const Command*>(app);
    const bool several = command->examples.find('\n') != std::string::npos;
    std::string parts[] = {command->notes, (several ? "Examples:\n" : "Example:\n") + command->examples};
    if (app->get_parent() == nullptr) parts[1] = "Start here:\n" + command->examples, std::swap(parts[0], parts[1]);
    std::string text;
    for (const std::string& part : parts)
        for (const std::string& line : manual::lines_of(part))
            text += (line.size() > most_columns ? in_lines(line, most_columns) : line) + '\n';
    return text;
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
    return in_lines(option->get_description(), most_columns - get_column_width());
}

}  // namespace tumble
