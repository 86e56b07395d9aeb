#include "app/cli/command_line.h"

#include "app/cli/command.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/farm/shell_text.h"
#include "core/safe_text.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <exception>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {
namespace {

// The help of commands in lines that fit a terminal.

/// Breaks texts where a line is full. A line break in a text counts as a space; a list without spaces breaks after a
/// comma. In notes and examples only a line that is too long is broken. Precondition: each CLI::App is a Command.
class HelpFormatter : public CLI::Formatter {
public:
    static constexpr std::size_t most_columns = 100;

    std::string make_description(const CLI::App* app) const override;
    std::string make_subcommand(const CLI::App* command) const override;
    std::string make_footer(const CLI::App* app) const override;
    std::string make_option_desc(const CLI::Option* option) const override;
};

/// Takes the part of a word that fits, up to a comma; all of it if there is none.
std::string take_part(std::string& word, std::size_t columns) {
    const std::size_t comma = word.size() > columns ? word.rfind(',', columns - 1) : std::string::npos;
    std::string part = word.substr(0, comma == std::string::npos ? word.size() : comma + 1);
    word.erase(0, part.size());
    return part;
}

/// The words of a text in lines of at most so many columns, where no word is longer.
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

std::string sentence_of(const CLI::App* app) {
    const auto* const command = static_cast<const Command*>(app);
    return manual::sentence(command->get_description(), command->exit_codes);
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
    // The exit codes of the program are in its notes.
    const std::string text = app->get_parent() == nullptr ? app->get_description() : sentence_of(app);
    return in_lines(text, most_columns) + '\n';
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
    std::ostringstream out;
    CLI::detail::format_help(out, command->get_display_name(true),
                             in_lines(sentence_of(command), most_columns - get_column_width()), get_column_width());
    return out.str();
}

std::string HelpFormatter::make_footer(const CLI::App* app) const {
    const auto* const command = static_cast<const Command*>(app);
    const bool several = command->examples.find('\n') != std::string::npos;
    std::string parts[] = {command->notes, (several ? "Examples:\n" : "Example:\n") + command->examples};
    if (app->get_parent() == nullptr) parts[1] = "Start here:\n" + command->examples, std::swap(parts[0], parts[1]);
    std::string text;
    for (const std::string& part : parts)
        for (const std::string& line : manual::lines_of(part))
            text += (line.size() > most_columns ? in_lines(line, most_columns) : line) + '\n';
    return text;
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
    return in_lines(option->get_description(), most_columns - get_column_width());
}

struct CommandEntry {
    const char* name;
    const char* what;  // one sentence without its full stop
    void (*add)(Command& command);
    std::vector<manual::ExitCode> exit_codes = {};  // empty: the exit codes of the program
};

/// In the order of the help.
std::vector<CommandEntry> all_commands() {
    return {
        {"render", "Simulate a scene, draw it, and write a clip, PNG frames, or both", add_render},
        {"simulate", "Simulate a scene without drawing, and write tables of numbers", add_simulate},
        {"plot", "Simulate, and plot quantities over time", add_plot},
        {"export", "Simulate, and write the scene and its motion as a glTF file for 3D programs", add_export},
        {"page", "Simulate, and write a web page with the clip in 3D, its plots, impacts and numbers", add_page},
        {"lesson", "Write web pages from Markdown with scenes, equations and questions", add_lesson},
        {"encode", "Make a clip from existing frames", add_encode},
        {"compare",
         "Compare pictures, folders of them, clips, or a scene with its frames",
         add_compare,
         {{0, "alike"}, {1, "different"}, {2, "cannot compare"}, {3, "missing"}}},
        {"golden", "Check scenes against accepted images, by a suite of cases", add_golden},
        {"info", "Describe a scene and estimate its cost", add_info},
        {"sweep", "Make many samples of one scene, with other values in each", add_sweep},
        {"farm", "Make a clip on many machines: Slurm, or engines that read OpenJD", add_farm},
        {"doctor", "Check the requirements of rendering, and name a remedy for each that is not met", add_doctor},
        {"completion", "Print what a shell needs to complete commands and options", add_completion},
        {"manual", "Print all commands and options, for other programs", add_manual},
        {"man-pages", "Write the manual pages, for installation", add_man_pages},
    };
}

/// Form of the messages of a run.
struct LogOptions {
    bool json = false;
    int descriptor = 2;
};

/// To the commands that run for long, and to their commands.
void add_log(Command& command, LogOptions& log) {
    for (Command* part : command.commands) add_log(*part, log);
    if (!command.logs) return;
    add_choice<bool>(command, "--log", log.json, {{"text", false}, {"json", true}},
                     "Messages, progress and times as text, or as JSON: an object on each line\n"
                     "(docs/reference/log.md)")
        ->option_text("text|json [text]");
    command
        .add_option("--log-fd", log.descriptor, "With --log json: the open descriptor to write to, as in 3>log.jsonl")
        ->check(number_within(1, 1 << 20))
        ->option_text("N [2]");
}

void begin_log(const LogOptions& log, int argc, char** argv) {
    if (!log.json) return;
    messages().write_json_to(log.descriptor);
    messages().event("start", {{"version", TUMBLE_VERSION}, {"command", std::vector<std::string>(argv, argv + argc)}});
}

std::string nearest(std::string_view given, const std::vector<std::string>& known) {
    return did_you_mean(given, {known.begin(), known.end()});
}

std::string unknown_command(const Command& command, std::string_view word) {
    std::vector<std::string> names;
    for (const Command* one : command.commands)
        if (!one->get_group().empty()) names.push_back(one->get_name());
    return fmt::format("unknown command \"{}\"{}", safe_text(word), nearest(word, names));
}

std::string unknown_option(const CLI::App& command, std::string_view word) {
    std::vector<std::string> names;
    for (const CLI::Option* one : command.get_options())
        for (const std::string& name : one->get_lnames())
            if (!one->get_group().empty()) names.push_back("--" + name);
    std::string whole = command.get_name();
    for (const CLI::App* above = command.get_parent(); above != nullptr; above = above->get_parent())
        whole.insert(0, above->get_name() + ' ');
    return fmt::format("unknown option \"{}\" of {}{}", safe_text(word), whole, nearest(word, names));
}

/// The mistake for a message, with the nearest name, of the first word that names no command and no option; empty:
/// there is none. `words`: of the command line after the program's name.
std::string unknown_word(const Command& program, std::span<const char* const> words) {
    const Command* command = &program;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string word = words[i];
        if (word == "--") return "";
        if (word.size() > 1 && word[0] == '-') {
            const std::string name = word[1] == '-' ? word.substr(0, word.find('=')) : word.substr(0, 2);
            const CLI::Option* const option = command->get_option_no_throw(name);
            if (option == nullptr) return unknown_option(*command, word.substr(0, word.find('=')));
            if (option->get_items_expected_max() > 0 && name == word) ++i;  // its value
            continue;
        }
        const std::vector<Command*>& commands = command->commands;
        if (commands.empty()) continue;
        const auto found = std::ranges::find(commands, word, [](const Command* one) { return one->get_name(); });
        if (found == commands.end()) return unknown_command(*command, word);
        command = *found;
    }
    return "";
}

/// The command as a shell reads it. Empty if a word has control characters or the text is too long for a message.
std::string call_text(int argc, char** argv) {
    std::string text;
    for (int i = 0; i < argc; ++i) text.append(i > 0 ? " " : "").append(shell_word(argv[i]));
    return safe_text(text, message_text_bytes / 2) == text ? text : "";
}

}  // namespace

int run_command_line(int argc, char** argv) {
    Command app("tumble", "Tumble: clips of rigid bodies that fall, bounce and come to rest, drawn without a screen.",
                {{0, "done"}, {1, "failed while running (or interrupted)"}, {2, "wrong usage or bad input"}});
    app.set_help_flag("-h,--help", "Print this help message and exit");
    app.set_version_flag("--version", "tumble " TUMBLE_VERSION, "Print the version");
    app.require_subcommand(1);
    app.formatter(std::make_shared<HelpFormatter>());
    app.get_formatter()->column_width(32);
    app.examples =
        "  tumble doctor                                     is everything there?\n"
        "  tumble info assets/scenes/falling_boxes.toml      bodies, shapes and settings of the scene\n"
        "  tumble render assets/scenes/falling_boxes.toml    makes falling_boxes.mp4";
    app.notes = "\"tumble COMMAND --help\" lists options. Exit codes: " + manual::codes_text(app.exit_codes) +
                ". Messages and progress go to standard error.";
    app.failure_message([&](const CLI::App*, const CLI::Error& error) {
        const std::string unknown = unknown_word(app, std::span(argv + 1, argv + argc));
        return fmt::format("error: {} (see \"tumble --help\" and \"tumble COMMAND --help\")\n",
                           unknown.empty() ? safe_text(error.what(), path_text_bytes) : unknown);
    });
    for (const CommandEntry& entry : all_commands()) entry.add(app.add(entry.name, entry.what, entry.exit_codes));
    LogOptions log;
    add_log(app, log);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::ostringstream asked_for, wrong;
        const int code = app.exit(error, asked_for, wrong);
        put_text(asked_for.str());
        say_text(wrong.str());
        return code == 0 ? 0 : 2;
    }
    begin_log(log, argc, argv);
    Command& command = app.parsed_command();
    command.call = call_text(argc, argv);
    if (!command.judges) return command.run();
    try {
        return command.run();
    } catch (const std::exception& error) {
        messages().fail(error);
        return 2;
    }
}

}  // namespace tumble
