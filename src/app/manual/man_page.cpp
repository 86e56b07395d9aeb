#include "app/manual/man_page.h"

#include "app/manual/help_footer.h"
#include "app/manual/roff.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tumble::manual {
namespace {

constexpr int section = 1;  // of the manual: commands of users

using Rows = std::vector<std::pair<std::string, std::string>>;

// Each variable that the program reads; a test compares them with the sources.
const Rows& environment() {
    static const Rows rows = {
        {"PATH",
         "The ffmpeg program, which writes and reads clips, and node, which compiles lessons, are looked for here."},
        {"TMPDIR", "Folder of intermediate files, in place of /tmp."},
        {"TUMBLE_LANES",
         "4, 8 or 16: at most so many bodies at a time in the vector code of the simulation. For tests: "
         "the result is the same."},
        {"TUMBLE_SHADERS", "Folder of the shaders, in place of PREFIX/share/tumble/shaders."},
        {"TUMBLE_WEB", "Folder of the player of pages, in place of PREFIX/share/tumble/web."},
    };
    return rows;
}

// Variables of some commands, whose help names them.
const Rows& named_environment() {
    static const Rows rows = {
        {"XDG_CACHE_HOME", "Folder of caches, in place of ~/.cache."},
    };
    return rows;
}

const Rows& files() {
    static const Rows rows = {
        {"PREFIX/share/tumble/shaders",
         "The shaders. PREFIX is the folder above that of the program: /usr in packages."},
        {"PREFIX/share/tumble/web", "The player of pages and the compiler of lessons, where they were built."},
        {"PREFIX/share/tumble/assets",
         "Demo scenes and meshes: here is assets/scenes/falling_boxes.toml of the examples."},
        {"PREFIX/share/doc/tumble/docs",
         "The documents: the format of scenes is in reference/scene-format.md. Names such "
         "as docs/reference/aovs.md in these pages are files of this folder."},
    };
    return rows;
}

/// A description may have several lines in the help.
std::string one_line(const CommandText& command) { return roff(replaced(command.description, "\n", " ")); }

std::string heading(const std::string& title) { return ".SH " + title + '\n'; }

/// The name of the value in italics, its default as it is.
std::string value_text(const std::string& value) {
    const std::size_t space = std::min(value.find(' '), value.size());
    return "\\fI" + roff(value.substr(0, space)) + "\\fR" + roff(value.substr(space));
}

std::string option_names(const OptionText& option) {
    std::string text;
    for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + roff_code(name);
    return option.takes_value() ? text + ' ' + value_text(option.value) : text;
}

std::string help_text(const OptionText& option) {
    return roff_paragraphs(lines_of(option.help.ends_with('.') ? option.help : option.help + '.'));
}

std::string option_entries(const std::vector<OptionText>& options) {
    std::string text;
    for (const OptionText& option : options) {
        text += ".TP\n" + option_names(option) + '\n' + help_text(option);
        if (option.required) text += "Required.\n";
        if (!option.excluded.empty()) text += "Not together with " + roff(joined(option.excluded, ", ")) + ".\n";
    }
    return text;
}

std::string argument_entries(const std::vector<OptionText>& arguments) {
    std::string text;
    for (const OptionText& argument : arguments)
        text += ".TP\n" + value_text(argument.value) + '\n' + help_text(argument);
    return text;
}

/// "tumble encode [OPTIONS] -o CLIP DIR"
std::string usage(const std::string& path, const CommandText& command) {
    std::string text = roff_code(path);
    if (!command.options.empty()) text += " [\\fIOPTIONS\\fR]";
    for (const OptionText& option : command.options)
        if (option.required) text += ' ' + roff_code(option.names.front()) + ' ' + value_text(option.value);
    if (!command.commands.empty()) text += " \\fICOMMAND\\fR [...]";
    for (const OptionText& argument : command.arguments) {
        const std::string value = value_text(argument.value) + (argument.repeated ? "..." : "");
        text += ' ' + (argument.required ? value : '[' + value + ']');
    }
    return text + '\n';
}

std::string rows_text(const Rows& rows, const char* font) {
    std::string text;
    for (const auto& [name, meaning] : rows) text += ".TP\n" + (font + roff(name)) + "\\fR\n" + roff(meaning) + '\n';
    return text;
}

std::string text_of(const CommandText& command) { return command.description + ".\n" + command.footer; }

/// All help texts of a command and its commands.
std::string all_text_of(const CommandText& command) {
    std::string text = text_of(command);
    for (const OptionText& option : command.options) text += option.help + '\n';
    for (const CommandText& part : command.commands) text += all_text_of(part);
    return text;
}

std::string code_entries(const std::vector<ExitCode>& codes) {
    std::string text;
    for (const auto& [code, meaning] : codes) text += fmt::format(".TP\n\\fB{}\\fR\n{}.\n", code, roff(meaning));
    return text;
}

/// Codes of commands in the command at `path` that have codes of their own.
std::string nested_exit_codes(const std::string& path, const CommandText& command) {
    std::string text;
    for (const CommandText& part : command.commands) {
        const std::string part_path = path + ' ' + part.name;
        if (const std::vector<ExitCode> codes = exit_codes_in(text_of(part)); !codes.empty())
            text += fmt::format(".PP\nOf {}:\n{}", roff_code(part_path), code_entries(codes));
        text += nested_exit_codes(part_path, part);
    }
    return text;
}

/// The codes of the command, else those of the program; then those of its own commands.
std::string exit_status(const CommandText& program, const CommandText& command, const std::string& path) {
    const std::vector<ExitCode> own = exit_codes_in(text_of(command));
    std::string text = heading("EXIT STATUS") + code_entries(own.empty() ? exit_codes_in(text_of(program)) : own);
    return &command == &program ? text : text + nested_exit_codes(path, command);
}

/// The variables that all commands read, and those that the help of the command names.
std::string environment_of(const CommandText& command) {
    Rows rows = environment();
    const std::string text = all_text_of(command);
    for (const auto& row : named_environment())
        if (text.find(row.first) != std::string::npos) rows.push_back(row);
    std::sort(rows.begin(), rows.end());
    return heading("ENVIRONMENT") + rows_text(rows, "\\fB");
}

std::string examples(const std::vector<std::string>& lines) {
    return lines.empty() ? std::string() : heading("EXAMPLES") + roff_lines(lines);
}

std::string title(const std::string& name, const std::string& version) {
    std::string capitals;
    for (const char c : name) capitals += c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    // No hyphenation, left-adjusted: options and lists do not survive either.
    return fmt::format(".\\\" Written by tumble man\\-pages.\n.TH {} 1 \"\" \"tumble {}\" \"Tumble\"\n.nh\n.ad l\n",
                       roff(capitals), roff(version));
}

std::string reference(const std::string& name) { return "\\fB" + roff(name) + "\\fR(1)"; }

std::string sentence(const CommandText& command) { return one_line(command) + ".\n"; }

/// A command of a command, as in "golden check": a part of its page.
std::string nested_command(const std::string& path, const CommandText& command) {
    const HelpFooter footer = read_footer(command.footer);
    std::string text = fmt::format(".SS {}\n{}", roff(path), usage(path, command));
    text += ".PP\n" + sentence(command) + roff_paragraphs(footer.notes);
    text += argument_entries(command.arguments) + option_entries(command.options);
    if (!footer.examples.empty()) text += ".PP\nExamples:\n" + roff_lines(footer.examples);
    for (const CommandText& part : command.commands) text += nested_command(path + ' ' + part.name, part);
    return text;
}

/// The common part of the pages of the program and of a command. `commands`: the section about the commands, if any.
std::string page_body(const CommandText& program, const CommandText& command, const std::string& path,
                      const std::string& commands) {
    const HelpFooter footer = read_footer(command.footer);
    std::string text = heading("SYNOPSIS") + usage(path, command);
    text += heading("DESCRIPTION") + sentence(command);
    if (!footer.notes.empty()) text += ".PP\n" + roff_paragraphs(footer.notes);
    if (!command.arguments.empty()) text += heading("ARGUMENTS") + argument_entries(command.arguments);
    if (!command.options.empty()) text += heading("OPTIONS") + option_entries(command.options);
    text += commands + exit_status(program, command, path) + environment_of(command);
    text += heading("FILES") + rows_text(files(), "\\fI");
    return text + examples(footer.examples);
}

ManPage command_page(const CommandText& program, const CommandText& command, const std::string& version) {
    const std::string name = program.name + '-' + command.name, path = program.name + ' ' + command.name;
    std::string commands;
    if (!command.commands.empty()) commands = heading("COMMANDS");
    for (const CommandText& part : command.commands) commands += nested_command(path + ' ' + part.name, part);
    std::string text = title(name, version) + heading("NAME");
    const std::string what = command.description.substr(0, command.description.find(": exit code"));
    text += fmt::format("{} \\- {}\n", roff(name), roff(replaced(what, "\n", " ")));
    text += page_body(program, command, path, commands);
    text += heading("SEE ALSO") + reference(program.name);
    for (const CommandText& other : program.commands)
        if (&other != &command) text += ",\n" + reference(program.name + '-' + other.name);
    return {fmt::format("{}.{}", name, section), text + '\n'};
}

ManPage program_page(const CommandText& program, const std::string& version) {
    std::string commands = heading("COMMANDS"), others;
    for (const CommandText& command : program.commands) {
        const std::string page = reference(program.name + '-' + command.name);
        commands += fmt::format(".TP\n{}\n{}", page, sentence(command));
        others += (others.empty() ? "" : ",\n") + page;
    }
    std::string text = title(program.name, version) + heading("NAME");
    const std::string what = program.description.substr(program.description.find(": ") + 2);  // after "Tumble: "
    text += fmt::format("{} \\- {}\n", roff(program.name), roff(what));
    text += page_body(program, program, program.name, commands);
    return {fmt::format("{}.{}", program.name, section), text + heading("SEE ALSO") + others + '\n'};
}

}  // namespace

std::vector<ManPage> man_pages(const CommandText& program, const std::string& version) {
    std::vector<ManPage> pages{program_page(program, version)};
    for (const CommandText& command : program.commands) pages.push_back(command_page(program, command, version));
    return pages;
}

}  // namespace tumble::manual
