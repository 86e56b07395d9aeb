#include "app/cli/command.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/manual/manual.h"
#include "output/output_path.h"
#include "output/temporary_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace tumble {
namespace {

using manual::CommandText, manual::OptionText;

/// The value's name and its default: "N" and "3" of "N [3]". The number of processor cores as a default would tie the
/// text to a machine.
void read_value(const CLI::Option& option, OptionText& text) {
    if (option.get_items_expected_max() == 0) return;
    text.value = option.get_option_text();
    if (text.value.empty()) text.value = option.get_type_name();
    if (const std::size_t at = text.value.find(" REQUIRED"); at != std::string::npos) text.value.resize(at);
    const std::size_t bracket = text.value.find(" [");
    if (bracket == std::string::npos) return;
    text.usual = text.value.substr(bracket + 2, text.value.size() - bracket - 3);
    text.value.resize(bracket);
    const bool by_cores = option.check_lname("threads") || option.check_lname("workers") || option.check_lname("jobs");
    if (by_cores && text.usual.find_first_not_of("0123456789") == std::string::npos) text.usual = "by the cores";
}

OptionText read_option(CLI::Option& option) {
    OptionText text;
    if (option.nonpositional()) {
        for (const std::string& name : option.get_snames()) text.names.push_back("-" + name);
        for (const std::string& name : option.get_lnames()) text.names.push_back("--" + name);
    } else {
        text.names.push_back(option.get_name(true));
    }
    read_value(option, text);
    text.help = option.get_description();
    text.required = option.get_required();
    const bool several = option.get_expected_max() == CLI::detail::expected_max_vector_size;
    text.repeated = several || option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
    for (const CLI::Option* other : option.get_excludes()) text.excluded.push_back("--" + other->get_lnames().front());
    std::sort(text.excluded.begin(), text.excluded.end());  // CLI11 sorts them by address
    text.kind = kind_of(option);
    return text;
}

/// The command with its options and commands, without the group "", which the help does not show either.
CommandText read_command(Command& command) {
    CommandText text{
        command.get_name(), command.get_description(), command.exit_codes, command.notes, command.examples, {}, {}, {}};
    if (text.description.ends_with('.')) text.description.pop_back();
    for (CLI::Option* option : command.get_options({}))
        if (!option->get_group().empty())
            (option->nonpositional() ? text.options : text.arguments).push_back(read_option(*option));
    for (Command* part : command.commands)
        if (!part->get_group().empty()) text.commands.push_back(read_command(*part));
    return text;
}

CommandText program_of(Command& command) { return read_command(*static_cast<Command*>(command.get_parent())); }

int print(const std::string& text) {
    put_text(text);
    finish_standard_output();
    return 0;
}

}  // namespace

void add_completion(Command& command) {
    auto& shell = command.keep<std::string (*)(const CommandText&)>();
    add_choice<std::string (*)(const CommandText&)>(
        command, "shell", shell,
        {{"bash", manual::bash_completion}, {"zsh", manual::zsh_completion}, {"fish", manual::fish_completion}},
        "The shell")
        ->required()
        ->option_text("bash|zsh|fish REQUIRED");
    command.notes =
        "The Debian package brings these files. Without it, in the start file of the shell:\n"
        "  source <(tumble completion bash)      ~/.bashrc\n"
        "  source <(tumble completion zsh)       ~/.zshrc, after compinit\n"
        "  tumble completion fish | source       ~/.config/fish/config.fish";
    command.examples = "  tumble completion bash > ~/.local/share/bash-completion/completions/tumble";
    command.run = [&shell, &command] { return print(shell(program_of(command))); };
}

void add_manual(Command& command) {
    auto& json = command.keep<bool>();
    command.add_flag("--json", json, "As JSON (docs/reference/cli.md)")->required();
    command.examples = "  tumble manual --json";
    command.run = [&command] { return print(manual::to_json(program_of(command), TUMBLE_VERSION)); };
}

void add_man_pages(Command& command) {
    command.group("");  // not in the help
    auto& folder = command.keep<std::filesystem::path>();
    command.add_option("folder", folder, "The folder of tumble.1, tumble-render.1 and so on")
        ->check(folder_name())
        ->required()
        ->type_name("DIR");
    command.examples = "  tumble man-pages man1 && man -l man1/tumble-render.1";
    command.run = [&folder, &command] {
        make_folder(folder);
        for (const manual::ManPage& page : manual::man_pages(program_of(command), TUMBLE_VERSION))
            write_file(confined_path(folder, page.file), page.text);
        return 0;
    };
}

}  // namespace tumble
