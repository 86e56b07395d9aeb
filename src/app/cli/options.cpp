#include "app/cli/options.h"

#include "app/cli/command_line.h"
#include "app/cli/command_reader.h"
#include "app/cli/help_formatter.h"
#include "app/cli/say.h"
#include "app/cli/unknown_word.h"
#include "app/farm/shell_text.h"
#include "core/safe_text.h"

#include <nlohmann/json.hpp>

#include <exception>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace tumble {
namespace {

void add_log(CLI::App& command, LogOptions& log) {
    add_choice<bool>(command, "--log", log.json, {{"text", false}, {"json", true}},
                     "Messages, progress and times as text, or as JSON: an object on each line\n"
                     "(docs/reference/log.md)")
        ->option_text("text|json [text]");
    command
        .add_option("--log-fd", log.descriptor, "With --log json: the open descriptor to write to, as in 3>log.jsonl")
        ->check(CLI::Range(1, 1 << 20))
        ->option_text("N [2]");
}

/// To the commands that run for long. `plot` has another --log: its axes.
void add_log_to_commands(CLI::App& app, LogOptions& log) {
    for (const char* name : {"render", "simulate", "export", "page", "lesson", "encode", "compare", "sweep"})
        add_log(*app.get_subcommand(name), log);
    for (const char* name : {"check", "accept"}) add_log(*app.get_subcommand("golden")->get_subcommand(name), log);
}

void begin_log(const LogOptions& log, int argc, char** argv) {
    if (!log.json) return;
    messages().write_json_to(log.descriptor);
    messages().event("start", {{"version", TUMBLE_VERSION}, {"command", std::vector<std::string>(argv, argv + argc)}});
}

/// The exit code of a command whose 1 is a verdict about images: a failure of the run has 2, as wrong input.
template <class Command>
int judged(const Command& command) {
    try {
        return command();
    } catch (const std::exception& error) {
        messages().fail(error);
        return 2;
    }
}

/// The command as a shell reads it. Empty if a word has control characters or the text is too long for a message.
std::string call_text(int argc, char** argv) {
    std::string text;
    for (int i = 0; i < argc; ++i) text.append(i > 0 ? " " : "").append(shell_word(argv[i]));
    return safe_text(text, message_text_bytes / 2) == text ? text : "";
}

}  // namespace

int run_command_line(int argc, char** argv) {
    CommandLine line;
    CLI::App app("Tumble: clips of rigid bodies that fall, bounce and come to rest, drawn without a screen.", "tumble");
    app.set_version_flag("--version", "tumble " TUMBLE_VERSION, "Print the version");
    app.require_subcommand(1);
    app.formatter(std::make_shared<HelpFormatter>());
    app.get_formatter()->column_width(32);
    app.footer(
        "Start here:\n"
        "  tumble doctor                                     is everything there?\n"
        "  tumble info assets/scenes/falling_boxes.toml      bodies, shapes and settings of the scene\n"
        "  tumble render assets/scenes/falling_boxes.toml    makes falling_boxes.mp4\n"
        "\"tumble COMMAND --help\" lists options. Exit codes: 0 done, 1 failed while running (or interrupted),\n"
        "2 wrong usage or bad input. Messages and progress go to standard error.");
    app.failure_message([&](const CLI::App*, const CLI::Error& error) {
        const std::string unknown = unknown_word(app, std::span(argv + 1, argv + argc));
        return fmt::format("error: {} (see \"tumble --help\" and \"tumble COMMAND --help\")\n",
                           unknown.empty() ? safe_text(error.what(), path_text_bytes) : unknown);
    });
    const CLI::App* render = add_render(app, line);
    const CLI::App* simulate = add_simulate(app, line);
    const CLI::App* plot = add_plot(app, line);
    const CLI::App* export_scene = add_export(app, line);
    const CLI::App* page = add_page(app, line);
    const CLI::App* lesson = add_lesson(app, line);
    const CLI::App* encode = add_encode(app, line);
    const CLI::App* compare = add_compare(app, line);
    const CLI::App* golden = add_golden(app, line);
    const CLI::App* info = add_info(app, line);
    const CLI::App* sweep = add_sweep(app, line);
    const CLI::App* farm = add_farm(app, line);
    add_doctor(app, line);
    const CLI::App* completion = add_completion(app, line);
    const CLI::App* man_pages = add_man_pages(app, line);
    add_log_to_commands(app, line.log);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::ostringstream asked_for, wrong;
        const int code = app.exit(error, asked_for, wrong);
        put_text(asked_for.str());
        say_text(wrong.str());
        return code == 0 ? 0 : 2;
    }
    begin_log(line.log, argc, argv);
    line.render.call = call_text(argc, argv);
    if (render->parsed())
        run_render(line.render);
    else if (simulate->parsed())
        run_simulate(line.simulate);
    else if (plot->parsed())
        run_plot(line.plot);
    else if (export_scene->parsed())
        run_export(line.export_scene);
    else if (page->parsed())
        run_page(line.page);
    else if (lesson->parsed())
        return run_lesson(line.lesson);
    else if (encode->parsed())
        run_encode(line.encode);
    else if (compare->parsed())
        return judged([&] { return run_compare(line.compare); });
    else if (golden->parsed())
        return judged([&] { return run_golden(*golden, line.golden); });
    else if (info->parsed())
        run_info(line.info);
    else if (sweep->parsed())
        return run_sweep(line.sweep);
    else if (completion->parsed())
        run_completion(line.completion, read_command(app));
    else if (man_pages->parsed())
        run_man_pages(line.man_pages, read_command(app));
    else if (farm->parsed())
        return run_farm(line.farm);
    else
        return run_doctor(line.doctor);
    return 0;
}

}  // namespace tumble
