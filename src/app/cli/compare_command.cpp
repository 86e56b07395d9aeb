#include "app/cli/compare_command.h"

#include "app/cli/command.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/files/output_plan.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "tumble/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace tumble {
namespace {

constexpr std::int64_t listed = 20;  // of each verdict: a screenful or two; files have them all

std::string indented(const std::string& lines) {
    std::string text = "  ";
    for (const char c : safe_lines(lines)) text += c == '\n' ? std::string("\n  ") : std::string(1, c);
    return text + "\n";
}

std::string entry(const ImageResult& image) {
    std::string text = fmt::format("{}: {}\n", name_of(image.verdict), safe_path(image.name));
    if (image.verdict == Verdict::different || image.verdict == Verdict::broken) text += indented(image.reason);
    if (image.verdict == Verdict::different)
        text += fmt::format("  {} pixels differ, by {} levels at most; changed: {} x {} pixels from x {}, y {}\n",
                            image.differing_pixels, image.max_difference, image.changed.width, image.changed.height,
                            image.changed.x, image.changed.y);
    for (const std::string& cause : image.causes) text += indented(cause);
    return text;
}

void print(const v0::Comparison& result) {
    const std::string differences =
        fmt::format("{} pixels differ, by {} levels at most", result.differing_pixels, result.max_difference);
    if (!result.alike)
        put("different: {}\n{}, at x {}, y {}\n", result.reason, differences, result.max_column, result.max_row);
    else if (result.differing_pixels == 0)
        put("alike: every pixel is the same\n");
    else
        put("alike: {}\n", differences);
    finish_standard_output();
}

/// Options for folders, clips and scenes.
void add_sets(CLI::App& command, CompareCommand& c) {
    command.add_option("--tolerances", c.tolerances, "Limits of the rules, metrics and masks by file pattern (TOML)")
        ->check(file_name("toml"))
        ->type_name("T.toml");
    command.add_option("--report", c.report, "Write a page with the pictures that differ")
        ->check(file_name("html"))
        ->type_name("R.html");
    command.add_option("--json", c.json, "Write the verdict, the figures and the limits of each picture")
        ->check(file_name("json"))
        ->type_name("R.json");
    command.add_option("--junit", c.junit, "Write the verdicts as JUnit XML, for CI services")
        ->check(file_name("xml"))
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
    add_workers(command, c.workers, "Pairs compared at a time, and render processes of a scene");
    command.add_flag("--quiet", c.quiet, "Print differences and errors only");
}

}  // namespace

void print_summary(const SetResult& result, bool brief) {
    for (const Verdict verdict : worst_first) {
        if (verdict == Verdict::alike || verdict == Verdict::same) continue;
        std::int64_t shown = 0;
        for (const ImageResult& image : result.images)
            if (image.verdict == verdict && shown++ < listed) put_text(entry(image));
        if (shown > listed) put("{} more {} pictures (--json lists all)\n", shown - listed, name_of(verdict));
    }
    if (const auto accepted = std::ranges::count_if(result.images, &ImageResult::accepted); accepted > 0 && !brief)
        put("accepted: {} {} now the reference\n", accepted, accepted == 1 ? "picture is" : "pictures are");
    if (!brief) {
        std::string counts;
        const auto numbers = result.counts();
        for (std::size_t i = 0; i < verdict_count; ++i)
            if (numbers[i] > 0)
                counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", numbers[i], name_of(Verdict(i)));
        put("{} {}: {}\n", result.images.size(), result.images.size() == 1 ? "picture" : "pictures", counts);
        if (!result.platform.empty())
            put("references of the platform {} replace general ones\n", safe_text(result.platform));
    }
    finish_standard_output();
}

namespace {

int run_compare(const CompareCommand& command) {
    if (compares_sets(command)) return compare_sets(command);
    OutputPlan plan;
    for (const auto& image : {command.a, command.b}) plan.add_input(image);
    if (command.difference) plan.add("--diff", *command.difference);
    const v0::Comparison result =
        v0::compare_png_files(command.a, command.b, command.options, command.difference.value_or(""));
    print(result);
    return result.alike ? 0 : 1;
}

}  // namespace

void add_compare(Command& command) {
    CompareCommand& c = command.keep<CompareCommand>();
    command.add_option("a", c.a, "The references: a picture (PNG, JPEG), a folder or a clip")
        ->required()
        ->check(file_name())
        ->type_name("A");
    command
        .add_option("b", c.b, "The pictures to test: the same, or a scene (TOML) that is drawn for a folder of\nframes")
        ->required()
        ->check(file_name())
        ->type_name("B");
    command
        .add_option("--diff", c.difference,
                    "Write a picture of the differences: red beyond the tolerance, blue within; of two sizes\nyellow "
                    "where only "
                    "A has pixels, green where only B has some. Of folders and clips a\nfolder of them")
        ->check(file_name("png"))
        ->type_name("D.png|DIR");
    command
        .add_option("--tolerance", c.options.tolerance,
                    "Levels (of 255) that a pixel may differ in each channel without counting")
        ->check(number_within(0, 255))
        ->option_text("N [3]");
    command
        .add_option("--fraction", c.options.fraction,
                    "Rule pixels: part of the pixels that may differ by more (rounded up to whole\npixels)")
        ->check(number_within(0.0, 1.0))
        ->option_text("F [0.0001]");
    command.add_option("--cluster", c.options.cluster, "Rule cluster: pixels of any 8 x 8 that may differ by more")
        ->check(number_within(0, 64))
        ->option_text("N [4 + 64 F]");
    command
        .add_option("--window", c.options.window,
                    "Rule window: levels that any 8 x 8 pixels may differ by on average. A single\npixel that is off "
                    "by 64 times that breaks it as well")
        ->check(number_within(0.0, 255.0))
        ->option_text("L [tolerance / 2 + 255 F]");
    command
        .add_option("--shade", c.options.shade,
                    "Rule shade: pixels of any 8 x 8 that may be brighter, or darker, by more than half\nthe tolerance "
                    "in a channel")
        ->check(number_within(0, 64))
        ->option_text("N [as cluster]");
    add_sets(command, c);
    command.notes =
        "Pictures are alike if all four rules hold. A rule that fails is named with its value, its limit and\n"
        "its place (x from the left, y from the top, from 0). Pictures of one scene from two processors pass;\n"
        "a small object moved by one pixel (cluster), a lost shadow (window) or a shifted color (shade) do\n"
        "not. The 8 x 8 pixels begin at every fourth row and column. To let single pixels differ by any\n"
        "amount: --window 255.\n"
        "Folders are compared file by file, by their relative names. Keys, files and verdicts:\n"
        "docs/reference/comparison.md.";
    command.examples =
        "  tumble compare golden.png frame_000100.png --diff difference.png\n"
        "  tumble compare golden/ frames/ --tolerances tolerances.toml --junit result.xml\n"
        "  tumble compare golden/ scene.toml --report report.html\n"
        "  tumble compare golden/ frames/ --accept           once the new pictures are right\n"
        "  tumble compare old.mp4 new.mp4";
    command.logs = true;
    command.judges = true;
    command.run = [&c] { return run_compare(c); };
}

}  // namespace tumble
