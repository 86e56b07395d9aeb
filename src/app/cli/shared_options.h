// Options that several commands have, and kinds of values.
#pragma once

#include "app/manual/command_text.h"
#include "app/threads/task_group.h"
#include "core/safe_text.h"
#include "output/video_format.h"
#include "scene/keys/overrides.h"
#include "scene/toml/error_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace tumble {

inline constexpr int enough_workers =
    8;  // render processes, 65 MiB each; the simulation and the encoder keep no more busy

// Each checks a value, and says its kind to completions and the manual (kind_of).
/// Not empty: an empty name comes from an unset variable of a script.
CLI::Validator some_name();
/// A file, with one of the endings; none: any.
CLI::Validator file_name(const std::string& endings = "");
CLI::Validator folder_name();
/// The name of a folder in a folder of references.
CLI::Validator platform_name();
/// A file that is written as CSV only.
CLI::Validator csv_name();
/// A number in a range; CLI::Range lets NaN through.
CLI::Validator number_within(double least, double most);
// These check nothing.
CLI::Validator number();
CLI::Validator one_of(const std::string& words);   // "a|b"
CLI::Validator list_of(const std::string& words);  // "a,b"
/// Shows and offers the words "a|b" as values.
CLI::Option* offer(CLI::Option* option, const std::string& words);
manual::ValueKind kind_of(CLI::Option& option);

/// Takes "-" as the file of standard output.
CLI::Validator or_standard_output();

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

/// --camera.
void add_camera(CLI::App& command, SceneOverrides& overrides);
/// --vary; `what` is made for each value: "A panel", "A run".
void add_vary(CLI::App& command, std::vector<std::string>& vary, const std::string& what);
void add_quality(CLI::App& command, VideoQuality& quality);

/// An option with one of a list of names as its value.
template <class T>
CLI::Option* add_choice(CLI::App& command, const std::string& option, T& value,
                        const std::vector<std::pair<std::string, T>>& choices, const std::string& help) {
    std::string words;
    for (const auto& choice : choices) words += (words.empty() ? "" : "|") + choice.first;
    return command
        .add_option_function<std::string>(
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
            help)
        ->check(one_of(words))
        ->option_text(words);
}

/// --threads and --quiet.
template <class Threads>
void add_run(CLI::App& command, Threads& threads, const std::string& unless_told, bool& quiet) {
    command.add_option("--threads", threads, "Threads of the simulation; the result is the same for any number")
        ->check(number_within(1, most_threads))
        ->option_text(fmt::format("N [{}]", unless_told));
    command.add_flag("--quiet", quiet, "Print errors only");
}

/// --workers; by default as many as there are processors, or `most`.
void add_workers(CLI::App& command, int& workers, const std::string& help, int most = enough_workers);

}  // namespace tumble
