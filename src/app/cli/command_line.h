// The options of all commands: a function that declares those of each command, and the parts that several share.
#pragma once

#include "app/cli/commands.h"
#include "app/cli/golden_command.h"
#include "app/threads/thread_budget.h"
#include "core/safe_text.h"
#include "scene/toml/error_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace tumble {

inline constexpr int enough_workers =
    8;  // render processes, 65 MiB each; the simulation and the encoder keep no more busy

/// Form of the messages of a run.
struct LogOptions {
    bool json = false;
    int descriptor = 2;
};

/// All options of the command line; each command uses those that it declares.
struct CommandLine {
    LogOptions log;
    RenderCommand render;
    SimulateCommand simulate;
    PlotCommand plot;
    ExportCommand export_scene;
    PageCommand page;
    LessonCommand lesson;
    EncodeCommand encode;
    CompareCommand compare;
    GoldenCommand golden;
    InfoCommand info;
    SweepCommand sweep;
    FarmCommand farm;
    DoctorCommand doctor;
    CompletionCommand completion;
    ManPagesCommand man_pages;
};

CLI::App* add_render(CLI::App& app, CommandLine& line);
CLI::App* add_simulate(CLI::App& app, CommandLine& line);
CLI::App* add_plot(CLI::App& app, CommandLine& line);
CLI::App* add_export(CLI::App& app, CommandLine& line);
CLI::App* add_page(CLI::App& app, CommandLine& line);
CLI::App* add_lesson(CLI::App& app, CommandLine& line);
CLI::App* add_encode(CLI::App& app, CommandLine& line);
CLI::App* add_compare(CLI::App& app, CommandLine& line);
CLI::App* add_golden(CLI::App& app, CommandLine& line);
int run_golden(const CLI::App& command, const GoldenCommand& golden);
CLI::App* add_info(CLI::App& app, CommandLine& line);
CLI::App* add_sweep(CLI::App& app, CommandLine& line);
CLI::App* add_farm(CLI::App& app, CommandLine& line);
void add_doctor(CLI::App& app, CommandLine& line);
CLI::App* add_completion(CLI::App& app, CommandLine& line);
CLI::App* add_man_pages(CLI::App& app, CommandLine& line);

/// A number in a range; CLI::Range lets NaN through.
CLI::Validator number_within(double least, double most);
/// Not empty: an empty name comes from an unset variable of a script.
CLI::Validator some_name();
/// The name of a folder in a folder of references.
CLI::Validator platform_name();
/// A file that is written as CSV only.
CLI::Validator csv_name();
/// Takes "-" as the file of standard output.
CLI::Validator or_standard_output();

/// All options of `render`.
void add_render_options(CLI::App& command, RenderCommand& c);
void add_scene(CLI::App& command, std::filesystem::path& scene);
/// "1280x720" to a width and a height. Their range is checked elsewhere. Throws InputError.
std::pair<int, int> read_size(const std::string& text, const char* option = "--size");
/// --size.
template <class Number>
CLI::Option* add_size(CLI::App& command, Number& width, Number& height, const std::string& help) {
    return command
        .add_option_function<std::string>(
            "--size", [&](const std::string& text) { std::tie(width, height) = read_size(text); }, help)
        ->check(some_name())
        ->type_name("WxH");
}
/// --fps: a number, or a fraction.
void add_fps(CLI::App& command, std::optional<double>& fps, const std::string& help);
/// --method, --set and --seed.
void add_values(CLI::App& command, SceneOverrides& overrides);
/// The same with --fps and --duration.
void add_frames_of_time(CLI::App& command, SceneOverrides& overrides);
/// --overlay; the help is followed by the names.
void add_overlay(CLI::App& command, SceneOverrides& overrides, const std::string& help);
/// --vary; `what` is made for each value: "A panel", "A run".
void add_vary(CLI::App& command, std::vector<std::string>& vary, const std::string& what);
/// --vary and --layout; `what` as in add_vary().
void add_panels(CLI::App& command, RenderCommand& clip, const std::string& what);
/// --overlay, --plot and --plot-place.
void add_text(CLI::App& command, SceneOverrides& overrides);
/// --speed, --shutter and --blur-samples.
void add_clip_times(CLI::App& command, RenderCommand& clip);
void add_quality(CLI::App& command, VideoQuality& quality);

/// An option with one of a list of names as its value.
template <class T>
CLI::Option* add_choice(CLI::App& command, const std::string& option, T& value,
                        const std::vector<std::pair<std::string, T>>& choices, const std::string& help) {
    return command.add_option_function<std::string>(
        option,
        [=, &value](const std::string& text) {
            std::vector<std::string_view> names;
            for (const auto& [name, choice] : choices) {
                if (name == text) {
                    value = choice;
                    return;
                }
                names.push_back(name);
            }
            throw CLI::ValidationError(option, fmt::format("must be one of {} (was '{}'){}", fmt::join(names, ", "),
                                                           safe_text(text), did_you_mean(text, names)));
        },
        help);
}

/// --threads and --quiet.
template <class Threads>
void add_run(CLI::App& command, Threads& threads, const std::string& unless_told, bool& quiet) {
    command.add_option("--threads", threads, "Threads of the simulation; the result is the same for any number")
        ->check(CLI::Range(1, most_threads))
        ->option_text(fmt::format("N [{}]", unless_told));
    command.add_flag("--quiet", quiet, "Print errors only");
}

}  // namespace tumble
