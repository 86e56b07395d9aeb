#include "app/cli/help_formatter.h"

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

}  // namespace

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

std::string HelpFormatter::make_description(const CLI::App* app) const {
    const std::string text = in_lines(Formatter::make_description(app), most_columns);
    return text.empty() ? text : text + '\n';
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
    const std::size_t columns = most_columns - get_column_width();
    std::ostringstream out;
    CLI::detail::format_help(out, command->get_display_name(true), in_lines(command->get_description(), columns),
                             get_column_width());
    return out.str();
}

std::string HelpFormatter::make_footer(const CLI::App* app) const {
    std::istringstream footer(Formatter::make_footer(app));
    std::string text;
    for (std::string line; std::getline(footer, line);)
        text += (line.size() > most_columns ? in_lines(line, most_columns) : line) + '\n';
    return text;
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
    return in_lines(option->get_description(), most_columns - get_column_width());
}

}  // namespace tumble
