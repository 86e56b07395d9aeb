#include "app/manual/manual.h"

#include <fmt/format.h>

namespace tumble::manual {
namespace {

/// Text between single quotes in which characters of _arguments are escaped.
std::string zsh_quoted(std::string text, bool in_brackets) {
    text = replaced(std::move(text), "\\", "\\\\");
    if (in_brackets) text = replaced(replaced(std::move(text), "[", "\\["), "]", "\\]");
    return replaced(replaced(std::move(text), ":", "\\:"), "'", "'\\''");
}

std::string files_action(const ValueKind& kind) {
    if (kind.folders && !kind.files) return "_files -/";
    if (kind.endings.empty()) return "_files";
    return fmt::format("_files -g \"*.({})(-.)\"", joined(kind.endings, "|"));
}

/// The action that completes a value: the last part of a specification of _arguments.
std::string action(const ValueKind& kind) {
    const bool paths = kind.files || kind.folders;
    if (kind.offers_nothing()) return " ";
    if (kind.words.empty()) return files_action(kind);
    const std::string words = joined(kind.words, " ");
    if (kind.word_list) return fmt::format("_values -s , value {}", words);
    if (!paths) return fmt::format("({})", words);
    return fmt::format("_alternative \"words\\:word\\:({})\" \"files\\:file\\:{}\"", words,
                       replaced(replaced(files_action(kind), "\"", "\\\""), ":", "\\:"));
}

std::string value_name(const OptionText& option) {
    return zsh_quoted(option.value.empty() ? option.names.front() : option.value, false);
}

/// A specification of an option: "'(-o --output)'{-o,--output=}'[help]:CLIP:_files'".
std::string option_line(const OptionText& option) {
    std::vector<std::string> forms, others = option.names;
    others.insert(others.end(), option.excluded.begin(), option.excluded.end());
    for (const std::string& name : option.names)
        forms.push_back(name + (!option.takes_value() ? "" : name.starts_with("--") ? "=" : "+"));
    const std::string before = option.repeated ? std::string("\\*") : fmt::format("'({})'", joined(others, " "));
    std::string text = forms.size() == 1 ? before + forms.front() : fmt::format("{}{{{}}}", before, joined(forms, ","));
    text += fmt::format("'[{}]", zsh_quoted(short_help(option.help), true));
    if (option.takes_value())
        text += fmt::format(":{}:{}", value_name(option), replaced(action(option.kind), "'", "'\\''"));
    return text + "'";
}

std::string argument_line(const OptionText& argument, std::size_t place) {
    const std::string where = argument.repeated ? "*" : fmt::format("{}{}", place, argument.required ? "" : ":");
    return fmt::format("'{}:{}:{}'", where, value_name(argument), action(argument.kind));
}

/// The function of a command, after the functions of its commands.
std::string function_of(const CommandText& command, const std::string& name) {
    std::string text, list, cases, lines;
    for (const CommandText& part : command.commands) {
        const std::string part_name = name + '_' + replaced(part.name, "-", "_");
        text += function_of(part, part_name);
        list += fmt::format("        '{}:{}'\n", part.name,
                            zsh_quoted(short_help(sentence(part.description, part.exit_codes)), false));
        cases += fmt::format("                {}) {} && ret=0 ;;\n", part.name, part_name);
    }
    for (const OptionText& option : command.options) lines += fmt::format(" \\\n        {}", option_line(option));
    for (std::size_t i = 0; i < command.arguments.size(); ++i)
        lines += fmt::format(" \\\n        {}", argument_line(command.arguments[i], i + 1));
    if (command.commands.empty()) return text + fmt::format("{}() {{\n    _arguments{}\n}}\n\n", name, lines);
    return text + fmt::format(
                      "{}() {{\n"
                      "    local curcontext=$curcontext state line ret=1\n"
                      "    local -A opt_args\n"
                      "    local -a commands=(\n{}    )\n"
                      "    _arguments -C{} \\\n        '1: :->command' '*:: :->rest' && ret=0\n"
                      "    case $state in\n"
                      "        command) _describe command commands && ret=0 ;;\n"
                      "        rest)\n            case $line[1] in\n{}            esac ;;\n"
                      "    esac\n    return ret\n}}\n\n",
                      name, list, lines, cases);
}

}  // namespace

std::string zsh_completion(const CommandText& program) {
    return fmt::format(
        "#compdef {0}\n# Completion of {0} for zsh. Written by \"{0} completion zsh\".\n\n{1}"
        "if [[ $funcstack[1] == _{0} ]]; then _{0} \"$@\"; else compdef _{0} {0}; fi\n",
        program.name, function_of(program, "_" + program.name));
}

}  // namespace tumble::manual
