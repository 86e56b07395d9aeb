// A command of the program: its options, its help, and its run.
#pragma once

#include "app/manual/command_text.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tumble {

class Command : public CLI::App {
public:
    /// `what`: one sentence without its full stop. `codes`: empty for the exit codes of the program.
    Command(const std::string& name, const std::string& what, std::vector<manual::ExitCode> codes,
            Command* parent = nullptr)
        : CLI::App(what, name, parent), exit_codes(std::move(codes)) {}

    /// Adds a command of this command.
    Command& add(const std::string& name, const std::string& what, std::vector<manual::ExitCode> codes = {}) {
        const auto command = std::make_shared<Command>(name, what, std::move(codes), this);
        add_subcommand(command);
        commands.push_back(command.get());
        return *command;
    }

    /// Values that live as long as the command, for its options to write to.
    template <class Values>
    Values& keep() {
        const auto values = std::make_shared<Values>();
        kept_.push_back(values);
        return *values;
    }

    /// The command that was parsed: this one, or one of its commands.
    Command& parsed_command() {
        for (Command* command : commands)
            if (command->parsed()) return command->parsed_command();
        return *this;
    }

    std::vector<Command*> commands;
    std::vector<manual::ExitCode> exit_codes;
    std::string notes, examples;  // lines below the options in the help
    bool logs = false;            // has --log
    bool judges = false;          // exit code 1 is a verdict about images: a failure has 2, as wrong input
    std::string call;             // as it was typed; empty: it does not fit into a message
    std::function<int()> run;     // returns the exit code; failures are InputError (2) or RunError (1)

private:
    std::vector<std::shared_ptr<void>> kept_;
};

// Each declares the options of a command, and sets `run`. The table of commands is in command_line.cpp.
void add_render(Command& command);
void add_simulate(Command& command);
void add_plot(Command& command);
void add_export(Command& command);
void add_page(Command& command);
void add_lesson(Command& command);
void add_encode(Command& command);
void add_compare(Command& command);
void add_golden(Command& command);
void add_info(Command& command);
void add_sweep(Command& command);
void add_farm(Command& command);
void add_doctor(Command& command);
void add_completion(Command& command);
void add_manual(Command& command);
void add_man_pages(Command& command);

}  // namespace tumble
