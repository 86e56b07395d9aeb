#include "app/cli/command_line.h"

#include <algorithm>

namespace tumble {
namespace {

/// Options for folders, clips and scenes.
void add_sets(CLI::App& command, CompareCommand& c) {
    command.add_option("--tolerances", c.tolerances, "Limits of the rules, metrics and masks by file pattern (TOML)")
        ->check(some_name())
        ->type_name("T.toml");
    command.add_option("--report", c.report, "Write a page with the pictures that differ")
        ->check(some_name())
        ->type_name("R.html");
    command.add_option("--json", c.json, "Write the verdict, the figures and the limits of each picture")
        ->check(some_name())
        ->type_name("R.json");
    command.add_option("--junit", c.junit, "Write the verdicts as JUnit XML, for CI services")
        ->check(some_name())
        ->type_name("R.xml");
    command
        .add_option("--platform", c.platform,
                    "References of A/NAME/ replace those of A/; none: no folder does. By default the\nprocessor: amd, "
                    "intel, arm or other")
        ->check(platform_name())
        ->type_name("NAME");
    command.add_flag(
        "--accept", c.accept,
        "Copy pictures that are not alike, and new ones, over the references in the folder A: all\nof them "
        "or none, through no link. With --platform, into the folder NAME");
    command.add_flag("--allow-added", c.allow_added, "A picture without a reference is no difference");
    add_fps(command, c.overrides.fps,
            "Frames per second: of a scene, in place of its own; of a clip, to take the frame\nshown at each "
            "moment (--variable-rate), in place of the stored frames");
    add_values(command, c.overrides);
    c.workers = std::min(machine_threads(), enough_workers);
    command.add_option("--workers", c.workers, "Pairs compared at a time, and render processes of a scene")
        ->check(CLI::Range(1, most_threads))
        ->option_text(fmt::format("N [{}]", c.workers));
    command.add_flag("--quiet", c.quiet, "Print differences and errors only");
}

}  // namespace

CLI::App* add_compare(CLI::App& app, CommandLine& line) {
    CompareCommand& c = line.compare;
    CLI::App* command =
        app.add_subcommand("compare",
                           "Compare pictures, folders of them, clips, or a scene with its frames: exit code 0 alike,\n"
                           "1 different, 2 cannot compare, 3 missing");
    command->add_option("a", c.a, "The references: a picture (PNG, JPEG), a folder or a clip")
        ->required()
        ->type_name("A");
    command
        ->add_option("b", c.b,
                     "The pictures to test: the same, or a scene (TOML) that is drawn for a folder of\nframes")
        ->required()
        ->type_name("B");
    command
        ->add_option("--diff", c.difference,
                     "Write a picture of the differences: red beyond the tolerance, blue within; of two sizes\nyellow "
                     "where only "
                     "A has pixels, green where only B has some. Of folders and clips a\nfolder of them")
        ->check(some_name())
        ->type_name("D.png|DIR");
    command
        ->add_option("--tolerance", c.options.tolerance,
                     "Levels (of 255) that a pixel may differ in each channel without counting")
        ->check(CLI::Range(0, 255))
        ->option_text("N [3]");
    command
        ->add_option("--fraction", c.options.fraction,
                     "Rule pixels: part of the pixels that may differ by more (rounded up to whole\npixels)")
        ->check(number_within(0.0, 1.0))
        ->option_text("F [0.0001]");
    command->add_option("--cluster", c.options.cluster, "Rule cluster: pixels of any 8 x 8 that may differ by more")
        ->check(CLI::Range(0, 64))
        ->option_text("N [4 + 64 F]");
    command
        ->add_option("--window", c.options.window,
                     "Rule window: levels that any 8 x 8 pixels may differ by on average. A single\npixel that is off "
                     "by 64 times that breaks it as well")
        ->check(number_within(0.0, 255.0))
        ->option_text("L [tolerance / 2 + 255 F]");
    command
        ->add_option(
            "--shade", c.options.shade,
            "Rule shade: pixels of any 8 x 8 that may be brighter, or darker, by more than half\nthe tolerance "
            "in a channel")
        ->check(CLI::Range(0, 64))
        ->option_text("N [as cluster]");
    add_sets(*command, c);
    command->footer(
        "Pictures are alike if all four rules hold. A rule that fails is named with its value, its limit and\n"
        "its place (x from the left, y from the top, from 0). Pictures of one scene from two processors pass;\n"
        "a small object moved by one pixel (cluster), a lost shadow (window) or a shifted color (shade) do\n"
        "not. The 8 x 8 pixels begin at every fourth row and column. To let single pixels differ by any\n"
        "amount: --window 255.\n"
        "Folders are compared file by file, by their relative names. Keys, files and verdicts:\n"
        "docs/reference/comparison.md.\n"
        "Examples:\n"
        "  tumble compare golden.png frame_000100.png --diff difference.png\n"
        "  tumble compare golden/ frames/ --tolerances tolerances.toml --junit result.xml\n"
        "  tumble compare golden/ scene.toml --report report.html\n"
        "  tumble compare golden/ frames/ --accept           once the new pictures are right\n"
        "  tumble compare old.mp4 new.mp4");
    return command;
}

}  // namespace tumble
