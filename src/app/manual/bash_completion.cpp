#include "app/manual/manual.h"

#include <fmt/format.h>

namespace tumble::manual {
namespace {

// Below the tables. PROGRAM is replaced.
constexpr const char* engine = R"sh(
# Offers the words of the list "$1" that begin with the current word.
_PROGRAM_words() {
    mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$1" -- "$current")
}

# Offers the words of the list "$1" that the current word, a list with commas, does not have yet.
_PROGRAM_list() {
    local word before="" last=$current
    if [[ $current == *,* ]]; then before=${current%,*}, last=${current##*,}; fi
    for word in $1; do
        [[ $word == "$last"* && ",$before" != *",$word,"* ]] && COMPREPLY+=("$before$word")
    done
    compopt -o nospace 2>/dev/null
}

# Offers folders, and files with the endings "$2", a pattern; $1 is "folders" or "files".
_PROGRAM_files() {
    local name start=$current
    start=${start#[\"\']} start=${start//\\/}
    while IFS= read -r name; do
        [[ ${name##*/} != .* || ${start##*/} == .* ]] || continue
        if [[ -d ${name/#\~/$HOME} || ( $1 == files && ( -z $2 || $name =~ \.($2)$ ) ) ]]; then COMPREPLY+=("$name"); fi
    done < <(compgen -f -- "$start")
    compopt -o filenames 2>/dev/null
}

# Offers values of the option or argument "$2" of the command "$1".
_PROGRAM_offer() {
    local takes words list kind endings
    _PROGRAM_value "$1" "$2"
    [[ -z $words ]] || _PROGRAM_words "$words"
    [[ -z $list ]] || _PROGRAM_list "$list"
    [[ -z $kind ]] || _PROGRAM_files "$kind" "$endings"
}

_PROGRAM() {
    COMPREPLY=()
    # Pieces of a word with = or : in it are one word again.
    local all=() piece glue="" index
    for ((index = 1; index <= COMP_CWORD; ++index)); do
        piece=${COMP_WORDS[index]}
        if [[ ${#all[@]} -gt 0 && ( $glue || $piece == [=:]* ) ]]; then all[-1]+=$piece; else all+=("$piece"); fi
        [[ $piece == *[=:] ]] && glue=yes || glue=""
    done
    local current=${all[-1]} word option="" only_arguments="" path="" arguments=0
    unset 'all[-1]'

    # The command, the number of arguments, and the option whose value comes next.
    local commands options takes words list kind endings
    for word in "${all[@]}"; do
        if [[ $option ]]; then
            option=""
        elif [[ $word == -- ]]; then
            only_arguments=yes
        elif [[ $word == -?* && -z $only_arguments ]]; then
            _PROGRAM_value "$path" "$word"
            [[ -z $takes || $word == *=* ]] || option=$word
        else
            _PROGRAM_names "$path"
            if [[ " $commands " == *" $word "* ]]; then path+=${path:+ }$word; else ((++arguments)); fi
        fi
    done

    local cut=""
    if [[ $option ]]; then
        _PROGRAM_offer "$path" "$option"
    elif [[ $current == --*=* && -z $only_arguments ]]; then
        option=${current%%=*} cut=$option= current=${current#*=}
        _PROGRAM_offer "$path" "$option"
    elif [[ $current == -* && -z $only_arguments ]]; then
        _PROGRAM_names "$path"
        _PROGRAM_words "$options"
    else
        _PROGRAM_names "$path"
        if [[ $commands ]]; then _PROGRAM_words "$commands"; else _PROGRAM_offer "$path" "@$((arguments + 1))"; fi
    fi

    # Readline replaces the part after the last = or :, if these divide words.
    local divider
    current=$cut$current cut=${#cut}
    for ((index = 0; index < ${#COMPREPLY[@]}; ++index)); do COMPREPLY[index]=${current:0:cut}${COMPREPLY[index]}; done
    for divider in = :; do
        if [[ $COMP_WORDBREAKS == *$divider* && $current == *$divider* ]]; then
            piece=${current%"$divider"*}$divider current=${current#"$piece"}
            COMPREPLY=("${COMPREPLY[@]#"$piece"}")
        fi
    done
}
complete -F _PROGRAM PROGRAM
)sh";

/// The case of a value: variables for _PROGRAM_offer.
std::string assignments(const ValueKind& kind) {
    std::string text = "takes=yes";
    if (!kind.words.empty())
        text += fmt::format(" {}=\"{}\"", kind.word_list ? "list" : "words", joined(kind.words, " "));
    if (kind.files)
        text += fmt::format(" kind=files endings=\"{}\"", joined(kind.endings, "|"));
    else if (kind.folders)
        text += " kind=folders";
    return text;
}

/// The lines of a command and of its commands in the two tables.
void add_bash_command(const CommandText& command, const std::string& path, std::string& names, std::string& values) {
    std::vector<std::string> commands, options;
    for (const CommandText& part : command.commands) commands.push_back(part.name);
    for (const OptionText& option : command.options) {
        std::string pattern;
        for (const std::string& name : option.names) {
            options.push_back(name);
            pattern += fmt::format("{}'{} {}'", pattern.empty() ? "" : " | ", path, name);
        }
        if (option.takes_value()) values += fmt::format("        {}) {} ;;\n", pattern, assignments(option.kind));
    }
    names += fmt::format("        '{}') commands=\"{}\" options=\"{}\" ;;\n", path, joined(commands, " "),
                         joined(options, " "));
    for (std::size_t i = 0; i < command.arguments.size(); ++i) {
        const OptionText& argument = command.arguments[i];
        const std::string place = argument.repeated ? "@'*" : fmt::format("@{}'", i + 1);
        values += fmt::format("        '{} {}) {} ;;\n", path, place, assignments(argument.kind));
    }
    for (const CommandText& part : command.commands)
        add_bash_command(part, path.empty() ? part.name : path + ' ' + part.name, names, values);
}

}  // namespace

std::string bash_completion(const CommandText& program) {
    std::string names, values;
    add_bash_command(program, "", names, values);
    const std::string tables = fmt::format(
        "# Completion of PROGRAM for bash. Written by \"PROGRAM completion bash\".\n\n"
        "# Commands and options of the command \"$1\".\n"
        "_PROGRAM_names() {{\n    commands=\"\" options=\"\"\n    case $1 in\n{}    esac\n}}\n\n"
        "# The value of the option or argument \"$2\" of the command \"$1\".\n"
        "_PROGRAM_value() {{\n    takes=\"\" words=\"\" list=\"\" kind=\"\" endings=\"\"\n    case \"$1 $2\" in\n{}    "
        "esac\n}}\n",
        names, values);
    return replaced(tables + engine, "PROGRAM", program.name);
}

}  // namespace tumble::manual
