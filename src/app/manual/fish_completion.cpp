#include "app/manual/completion.h"

#include <fmt/format.h>

namespace tumble::manual {
namespace {

std::string fish_quoted(const std::string& text) {
    return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

/// The offers for a value, as options of fish's `complete`.
std::string offers(const ValueHint& hint) {
    std::vector<std::string> sources;
    if (hint.word_list && !hint.words.empty())
        sources.push_back("(__fish_append , " + joined(hint.words, " ") + ")");
    else if (!hint.words.empty())
        sources.push_back(joined(hint.words, " "));
    std::string endings;
    for (const std::string& ending : hint.endings) endings += " ." + ending;
    if (!endings.empty())
        sources.push_back("(__fish_complete_suffix" + endings + ")");
    else if (hint.files)
        sources.emplace_back("(__fish_complete_path)");
    else if (hint.folders)
        sources.emplace_back("(__fish_complete_directories)");
    return sources.empty() ? "-x" : "-k -x -a " + fish_quoted(joined(sources, " "));
}

/// The lines of a command, and of its commands. `condition` is true where it is the command of the line.
void add_fish_command(const CommandText& command, const std::string& program, const std::string& path,
                      std::string& lines, std::vector<std::string>& paths) {
    const std::string begin = fmt::format("complete -c {} -n \"__{}_at '{}'\"", program, program, path);
    for (const OptionText& option : command.options) {
        lines += begin;
        for (const std::string& name : option.names)
            lines += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        if (option.takes_value()) lines += " " + offers(option.hint);
        lines += " -d " + fish_quoted(short_help(option.help)) + "\n";
    }
    // Arguments of one command are of one kind, or the shell offers all kinds.
    for (const OptionText& argument : command.arguments)
        if (!argument.hint.empty()) lines += begin + " " + offers(argument.hint) + "\n";
    for (const CommandText& part : command.commands) {
        lines += fmt::format("{} -a {} -d {}\n", begin, part.name, fish_quoted(short_help(part.description)));
        const std::string part_path = path.empty() ? part.name : path + ' ' + part.name;
        paths.push_back(fish_quoted(part_path));
        add_fish_command(part, program, part_path, lines, paths);
    }
}

}  // namespace

std::string fish_completion(const CommandText& program) {
    std::string lines;
    std::vector<std::string> paths;
    add_fish_command(program, program.name, "", lines, paths);
    return fmt::format(
        "# Completion of {0} for fish. Written by \"{0} completion fish\".\n\n"
        "function __{0}_at -a wanted -d 'Whether the command of the line is this one'\n"
        "    set -l words (commandline -opc)\n"
        "    set -l path\n"
        "    for word in $words[2..]\n"
        "        set -l longer (string join -- ' ' $path $word)\n"
        "        contains -- $longer {1}; and set path $longer\n"
        "    end\n"
        "    test \"$path\" = \"$wanted\"\n"
        "end\n\n"
        "complete -c {0} -f\n{2}",
        program.name, joined(paths, " "), lines);
}

}  // namespace tumble::manual
