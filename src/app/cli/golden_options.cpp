#include "app/cli/command_line.h"
#include "core/error.h"
#include "scene/toml/limits.h"

#include <algorithm>
#include <charconv>

namespace tumble {
namespace {

void add_suite(CLI::App& command, GoldenCommand& c) {
    command.add_option("suite", c.suite, "The suite (TOML; docs/reference/golden-suite.md)")
        ->check(some_name())
        ->required()
        ->type_name("SUITE");
}

constexpr const char* checked_platform =
    "References of the folder NAME replace general ones; none: no folder does. By default\n"
    "the processor: amd, intel, arm or other";
constexpr const char* accepted_platform_help =
    "Write references for processors of that name, in the folder NAME, in place of general\nones";

void add_common(CLI::App& command, GoldenCommand& c, const char* platform) {
    command.add_option("--platform", c.platform, platform)->check(platform_name())->type_name("NAME");
    command.add_option("--jobs", c.jobs, "Cases drawn at a time")
        ->check(CLI::Range(1, most_threads))
        ->option_text(fmt::format("N [{}]", c.jobs));
    command.add_flag("--quiet", c.quiet, "Print differences and errors only");
}

void add_cases(CLI::App& command, GoldenCommand& c, const std::string& help) {
    command.add_option("cases", c.cases, help)->check(some_name())->type_name("CASE");
}

/// "0,45,90", ascending.
std::vector<std::int64_t> read_frames(const std::string& text) {
    std::vector<std::int64_t> frames;
    const char *at = text.data(), *const end = at + text.size();
    for (;;) {
        std::int64_t frame = -1;
        const auto [next, error] = std::from_chars(at, end, frame);
        const bool in_order = frames.empty() || frame > frames.back();
        if (error != std::errc() || frame < 0 || frame > limits::frames || !in_order || (next != end && *next != ','))
            throw InputError(fmt::format("--frames: must be ascending numbers of frames, as in 0,45,90 (given '{}')",
                                         safe_text(text)));
        frames.push_back(frame);
        if (next == end) return frames;
        at = next + 1;
    }
}

void add_check(CLI::App& golden, GoldenCommand& c) {
    CLI::App* command =
        golden.add_subcommand("check",
                              "Draw the cases and compare them with their references: exit code 0 alike,\n"
                              "1 different, 2 broken, 3 a reference is missing");
    add_suite(*command, c);
    add_cases(*command, c, "Names of cases; without one: all");
    command->add_option("--report", c.report, "Write a page with the images that differ, and the causes")
        ->check(some_name())
        ->type_name("R.html");
    command->add_option("--json", c.json, "Write the verdict, the figures, the limits and the causes of each image")
        ->check(some_name())
        ->type_name("R.json");
    command->add_option("--junit", c.junit, "Write the verdicts as JUnit XML, for CI services")
        ->check(some_name())
        ->type_name("R.xml");
    command
        ->add_option("--failures", c.failures,
                     "Write new_NAME.png and difference_NAME.png of each image that is not alike")
        ->check(some_name())
        ->type_name("DIR");
    command
        ->add_option("--cache", c.cache,
                     "Folder of drawn images, in place of tumble/golden in $XDG_CACHE_HOME or ~/.cache: a case is\n"
                     "drawn again only if its scene, the program, a library or a font has changed; none: all\nare "
                     "drawn, and removed at the end")
        ->check(some_name())
        ->type_name("DIR");
    command->add_flag("--force", c.force, "Draw all cases, changed or not");
    add_common(*command, c, checked_platform);
    command->footer(
        "Examples:\n"
        "  tumble golden check golden.toml\n"
        "  tumble golden check golden.toml falling_boxes --report report.html --junit result.xml");
}

void add_accept(CLI::App& golden, GoldenCommand& c) {
    CLI::App* command =
        golden.add_subcommand("accept",
                              "Draw cases twice and take the images as references; an image that does not render\n"
                              "twice alike is refused (exit code 1)");
    add_suite(*command, c);
    add_cases(*command, c, "Names of the cases to accept");
    command->add_flag("--all", c.all, "All cases");
    command->add_flag("--even-alike", c.even_alike,
                      "Replace references also where the new image is within the tolerances");
    add_common(*command, c, accepted_platform_help);
    command->footer("Example:\n  tumble golden accept golden.toml falling_boxes");
}

void add_add(CLI::App& golden, GoldenCommand& c) {
    NewCase& added = c.added;
    CLI::App* command =
        golden.add_subcommand("add", "Add a case to the suite, which is made if it does not exist, and accept it");
    add_suite(*command, c);
    add_scene(*command, added.scene);
    command->add_option("--name", added.name, "Name of the case, in place of the scene's file name")
        ->check(some_name())
        ->type_name("NAME");
    command
        ->add_option_function<std::string>(
            "--frames", [&added](const std::string& text) { added.frames = read_frames(text); },
            "Numbers of the frames, from 0; without this: those of [defaults], else the first one")
        ->type_name("N,N");
    add_size(*command, added.overrides.width, added.overrides.height, "Picture size, in place of the scene's");
    add_frames_of_time(*command, added.overrides);
    add_overlay(*command, added.overrides, "Overlays of the pictures, in place of the scene's: none, or a list out of");
    command->add_option("--plot", added.overrides.plot, "Curves of quantities in the pictures (tumble render --help)")
        ->type_name("LIST");
    command->add_flag("--transparent", added.transparent, "Draw the bodies alone on a transparent background");
    add_common(*command, c, accepted_platform_help);
    command->footer("Example:\n  tumble golden add golden.toml scene.toml --frames 0,45,90 --size 160x90");
}

}  // namespace

CLI::App* add_golden(CLI::App& app, CommandLine& line) {
    GoldenCommand& c = line.golden;
    c.jobs = std::min(machine_threads(), enough_workers);
    CLI::App* command = app.add_subcommand("golden", "Check scenes against accepted images, by a suite of cases");
    command->require_subcommand(1);
    add_check(*command, c);
    add_accept(*command, c);
    add_add(*command, c);
    command->footer(
        "Examples:\n"
        "  tumble golden add golden.toml scene.toml --frames 0,45\n"
        "  tumble golden check golden.toml --report report.html");
    return command;
}

int run_golden(const CLI::App& command, const GoldenCommand& golden) {
    if (command.got_subcommand("check")) return run_golden_check(golden);
    if (command.got_subcommand("accept")) return run_golden_accept(golden);
    return run_golden_add(golden);
}

}  // namespace tumble
