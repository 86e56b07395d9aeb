#include "app/manual/manual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace tumble::manual {
namespace {

constexpr int section = 1;  // of the manual: commands of users

/// A line that begins with a control character is text all the same.
std::string guarded(const std::string& line) {
    return !line.empty() && (line[0] == '.' || line[0] == '\'') ? "\\&" + line : line;
}

/// Lines of one list without spaces, "a,b," and "c,d", become one: a filled paragraph would put a space between them.
std::vector<std::string> with_whole_lists(const std::vector<std::string>& lines) {
    std::vector<std::string> whole;
    for (const std::string& line : lines) {
        const std::size_t comma = line.substr(0, line.find(' ')).find(',');
        if (!whole.empty() && whole.back().ends_with(',') && comma != std::string::npos && comma + 1 < line.size())
            whole.back() += line;
        else
            whole.push_back(line);
    }
    return whole;
}

/// Characters that roff would take for markup are escaped.
std::string roff(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const char next = i + 1 < text.size() ? text[i + 1] : ' ';
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else if (c == '"')
            out += "\\(dq";
        else if (c == '\'')
            out += "\\(aq";
        else if (c == '`')
            out += "\\(ga";
        else if (c == '^')
            out += "\\(ha";
        else if (c == '~')
            out += "\\(ti";
        else
            out += c;
        if (c == ',' && std::isspace(static_cast<unsigned char>(next)) == 0) out += "\\:";  // long lists may break
    }
    return guarded(out);
}

/// The same for a file, option or command that users copy: hyphens are not typographic ones.
std::string roff_code(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }

/// Lines as they are.
std::string roff_lines(const std::vector<std::string>& lines) {
    std::string out = ".nf\n";
    for (const std::string& line : lines) out += roff(line) + '\n';
    return out + ".fi\n";
}

/// Lines of a help text as filled paragraphs. Indented lines and lists keep their line breaks.
std::string roff_paragraphs(const std::vector<std::string>& lines) {
    std::string out;
    std::vector<std::string> indented;
    const auto finish = [&] {
        if (!indented.empty()) out += roff_lines(indented);
        indented.clear();
    };
    for (const std::string& line : with_whole_lists(lines)) {
        if (line.starts_with(' ')) {
            indented.push_back(line);
            continue;
        }
        finish();
        out += line.empty() ? ".PP\n" : roff(line) + '\n';
    }
    finish();
    return out;
}

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

std::string heading(const std::string& title) { return ".SH " + title + '\n'; }

/// The name of the value in italics, its default as it is.
std::string value_text(const OptionText& option) {
    return "\\fI" + roff(option.value) + "\\fR" + (option.usual.empty() ? "" : roff(" [" + option.usual + ']'));
}

std::string option_names(const OptionText& option) {
    std::string text;
    for (const std::string& name : option.names) text += (text.empty() ? "" : ", ") + roff_code(name);
    return option.takes_value() ? text + ' ' + value_text(option) : text;
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
    for (const OptionText& argument : arguments) text += ".TP\n" + value_text(argument) + '\n' + help_text(argument);
    return text;
}

/// "tumble encode [OPTIONS] -o CLIP DIR"
std::string usage(const std::string& path, const CommandText& command) {
    std::string text = roff_code(path);
    if (!command.options.empty()) text += " [\\fIOPTIONS\\fR]";
    for (const OptionText& option : command.options)
        if (option.required) text += ' ' + roff_code(option.names.front()) + ' ' + value_text(option);
    if (!command.commands.empty()) text += " \\fICOMMAND\\fR [...]";
    for (const OptionText& argument : command.arguments) {
        const std::string value = value_text(argument) + (argument.repeated ? "..." : "");
        text += ' ' + (argument.required ? value : '[' + value + ']');
    }
    return text + '\n';
}

std::string rows_text(const Rows& rows, const char* font) {
    std::string text;
    for (const auto& [name, meaning] : rows) text += ".TP\n" + (font + roff(name)) + "\\fR\n" + roff(meaning) + '\n';
    return text;
}

/// All help texts of a command and its commands.
std::string all_text_of(const CommandText& command) {
    std::string text = command.description + command.notes;
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
        if (!part.exit_codes.empty())
            text += fmt::format(".PP\nOf {}:\n{}", roff_code(part_path), code_entries(part.exit_codes));
        text += nested_exit_codes(part_path, part);
    }
    return text;
}

/// The codes of the command, otherwise of the program; then the codes of its own commands.
std::string exit_status(const CommandText& program, const CommandText& command, const std::string& path) {
    const std::string text =
        heading("EXIT STATUS") + code_entries(command.exit_codes.empty() ? program.exit_codes : command.exit_codes);
    return &command == &program ? text : text + nested_exit_codes(path, command);
}

/// The variables that all commands read, and variables that the help of the command names.
std::string environment_of(const CommandText& command) {
    Rows rows = environment();
    const std::string text = all_text_of(command);
    for (const auto& row : named_environment())
        if (text.find(row.first) != std::string::npos) rows.push_back(row);
    std::sort(rows.begin(), rows.end());
    return heading("ENVIRONMENT") + rows_text(rows, "\\fB");
}

std::string title(const std::string& name, const std::string& version) {
    std::string capitals;
    for (const char c : name) capitals += c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    // No hyphenation, left-adjusted: options and lists do not survive either.
    return fmt::format(".\\\" Written by tumble man\\-pages.\n.TH {} 1 \"\" \"tumble {}\" \"Tumble\"\n.nh\n.ad l\n",
                       roff(capitals), roff(version));
}

std::string reference(const std::string& name) { return "\\fB" + roff(name) + "\\fR(1)"; }

std::string sentence_of(const CommandText& command) {
    return roff(replaced(sentence(command.description, command.exit_codes), "\n", " ")) + ".\n";
}

/// A command of a command, as in "golden check": a part of its page.
std::string nested_command(const std::string& path, const CommandText& command) {
    std::string text = fmt::format(".SS {}\n{}", roff(path), usage(path, command));
    text += ".PP\n" + sentence_of(command) + roff_paragraphs(lines_of(command.notes));
    text += argument_entries(command.arguments) + option_entries(command.options);
    if (!command.examples.empty()) text += ".PP\nExamples:\n" + roff_lines(lines_of(command.examples));
    for (const CommandText& part : command.commands) text += nested_command(path + ' ' + part.name, part);
    return text;
}

/// The common part of the pages of the program and of a command. `commands`: the section about the commands, if any.
std::string page_body(const CommandText& program, const CommandText& command, const std::string& path,
                      const std::string& commands) {
    std::string text = heading("SYNOPSIS") + usage(path, command);
    text += heading("DESCRIPTION") + (&command == &program ? roff(command.description) + ".\n" : sentence_of(command));
    if (!command.notes.empty()) text += ".PP\n" + roff_paragraphs(lines_of(command.notes));
    if (!command.arguments.empty()) text += heading("ARGUMENTS") + argument_entries(command.arguments);
    if (!command.options.empty()) text += heading("OPTIONS") + option_entries(command.options);
    text += commands + exit_status(program, command, path) + environment_of(command);
    text += heading("FILES") + rows_text(files(), "\\fI");
    return command.examples.empty() ? text : text + heading("EXAMPLES") + roff_lines(lines_of(command.examples));
}

ManPage command_page(const CommandText& program, const CommandText& command, const std::string& version) {
    const std::string name = program.name + '-' + command.name, path = program.name + ' ' + command.name;
    std::string commands;
    if (!command.commands.empty()) commands = heading("COMMANDS");
    for (const CommandText& part : command.commands) commands += nested_command(path + ' ' + part.name, part);
    std::string text = title(name, version) + heading("NAME");
    text += fmt::format("{} \\- {}\n", roff(name), roff(replaced(command.description, "\n", " ")));
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
        commands += fmt::format(".TP\n{}\n{}", page, sentence_of(command));
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
