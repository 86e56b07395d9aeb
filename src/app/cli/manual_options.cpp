#include "app/cli/command_line.h"

namespace tumble {

CLI::App* add_completion(CLI::App& app, CommandLine& line) {
    CLI::App* command = app.add_subcommand("completion", "Print what a shell needs to complete commands and options");
    add_choice<std::string>(*command, "shell", line.completion.shell,
                            {{"bash", "bash"}, {"zsh", "zsh"}, {"fish", "fish"}}, "The shell")
        ->required()
        ->option_text("bash|zsh|fish REQUIRED");
    command->footer(
        "The Debian package brings these files. Without it, in the start file of the shell:\n"
        "  source <(tumble completion bash)      ~/.bashrc\n"
        "  source <(tumble completion zsh)       ~/.zshrc, after compinit\n"
        "  tumble completion fish | source       ~/.config/fish/config.fish\n"
        "Example:\n"
        "  tumble completion bash > ~/.local/share/bash-completion/completions/tumble");
    return command;
}

CLI::App* add_man_pages(CLI::App& app, CommandLine& line) {
    CLI::App* command = app.add_subcommand("man-pages", "Write the manual pages, for installation");
    command->group("");  // not in the help
    command->add_option("folder", line.man_pages.folder, "The folder of tumble.1, tumble-render.1 and so on")
        ->check(some_name())
        ->required()
        ->type_name("DIR");
    command->footer("Example:\n  tumble man-pages man1 && man -l man1/tumble-render.1");
    return command;
}

}  // namespace tumble
