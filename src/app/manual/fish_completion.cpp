#include "app/manual/manual.h"

#include <fmt/format.h>

namespace tumble::manual {
namespace {

// Above the table. PROGRAM is replaced, and PATHS by the commands.
constexpr const char* functions = R"fish(# Completion of PROGRAM for fish. Written by "PROGRAM completion fish".

function __PROGRAM_at -a wanted -d 'Whether the command of the line is this one'
    set -l words (commandline -opc)
    set -l path
    for word in $words[2..]
        set -l longer (string join -- ' ' $path $word)
        contains -- $longer PATHS; and set path $longer
    end
    test "$path" = "$wanted"
end

function __PROGRAM_files -d 'Files with these endings, and folders'
    set -l word (string replace -r -- '^--[a-z-]+=' '' (commandline -ct))
    set -l endings (string join -- '|' $argv)
    string match -r -- "^.*(?:\\.(?:$endings)|/)\$" (complete -C "__fish_command_without_completions $word")
end

complete -c PROGRAM -f
)fish";

std::string fish_quoted(const std::string& text) {
    return fmt::format("'{}'", replaced(replaced(text, "\\", "\\\\"), "'", "\\'"));
}

/// The offers for a value, as options of fish's `complete`.
std::string offers(const ValueKind& kind) {
    std::vector<std::string> sources;
    if (kind.word_list && !kind.words.empty())
        sources.push_back("(__fish_append , " + joined(kind.words, " ") + ")");
    else if (!kind.words.empty())
        sources.push_back(joined(kind.words, " "));
    if (!kind.endings.empty())
        sources.push_back("(__PROGRAM_files " + joined(kind.endings, " ") + ")");
    else if (kind.files)
        sources.emplace_back("(__fish_complete_path)");
    else if (kind.folders)
        sources.emplace_back("(__fish_complete_directories)");
    return sources.empty() ? "-x" : "-x -a " + fish_quoted(joined(sources, " "));
}

/// The lines of a command, and of its commands. `condition` is true where it is the command of the line.
void add_fish_command(const CommandText& command, const std::string& program, const std::string& path,
                      std::string& lines, std::vector<std::string>& paths) {
    const std::string begin = fmt::format("complete -c {} -n \"__{}_at '{}'\"", program, program, path);
    for (const OptionText& option : command.options) {
        lines += begin;
        for (const std::string& name : option.names)
            lines +=
                name.starts_with("--") ? fmt::format(" -l {}", name.substr(2)) : fmt::format(" -s {}", name.substr(1));
        if (option.takes_value()) lines += fmt::format(" {}", offers(option.kind));
        lines += fmt::format(" -d {}\n", fish_quoted(short_help(option.help)));
    }
    // Arguments of one command are of one kind, or the shell offers all kinds.
    for (const OptionText& argument : command.arguments)
        if (!argument.kind.offers_nothing()) lines += begin + " " + offers(argument.kind) + "\n";
    for (const CommandText& part : command.commands) {
        lines += fmt::format("{} -a {} -d {}\n", begin, part.name,
                             fish_quoted(short_help(sentence(part.description, part.exit_codes))));
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
    return replaced(replaced(functions, "PATHS", joined(paths, " ")) + lines, "PROGRAM", program.name);
}

}  // namespace tumble::manual
