#include "app/cli/command_line.h"

namespace tumble {

CLI::App* add_encode(CLI::App& app, CommandLine& line) {
    EncodeCommand& c = line.encode;
    CLI::App* command = app.add_subcommand("encode", "Make a clip from existing frames");
    command->add_option("frames", c.frames, "The folder with frame_000000.png, frame_000001.png and so on")
        ->required()
        ->type_name("DIR");
    command->add_option("-o,--output", c.clip, "The clip to write: .mp4 .mov .mkv .webm or .gif")
        ->required()
        ->type_name("CLIP");
    command
        ->add_option("--fps", c.fps,
                     "Frames per second, in place of that of the run that drew the frames (frames.json in\n"
                     "the folder; without it 60)")
        ->type_name("N");
    command->add_flag("--allow-missing", c.allow_missing,
                      "Encode the frames that are there. Without this, a folder with missing frames is refused");
    command->add_flag("--transparent", c.transparent,
                      "Keep the alpha of the frames (.webm and .mov); without this it is left out");
    add_quality(*command, c.quality);
    command->add_flag("--quiet", c.quiet, "Print errors only");
    command->footer("Example:\n  tumble encode out -o clip.mp4 --fps 30");
    return command;
}

CLI::App* add_compare(CLI::App& app, CommandLine& line) {
    CompareCommand& c = line.compare;
    CLI::App* command =
        app.add_subcommand("compare", "Compare two pictures: exit code 0 alike, 1 different, 2 cannot compare");
    command->add_option("a", c.a, "A picture (PNG)")->required()->type_name("A.png");
    command->add_option("b", c.b, "Another, of the same size")->required()->type_name("B.png");
    command
        ->add_option("--diff", c.difference,
                     "Write a picture of the differences: red beyond the tolerance, blue within")
        ->check(some_name())
        ->type_name("D.png");
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
    command->footer(
        "Pictures are alike if all three rules hold. A rule that fails is named with its value, its limit and its\n"
        "place (x from the left, y from the top, from 0). Pictures of one scene from two processors pass; a\n"
        "small object moved by one pixel (cluster), a lost shadow or a shifted color (window) do not. The 8 x 8 "
        "pixels\n"
        "begin at every fourth row and column. To let single pixels differ by any amount: --window 255.\n"
        "Example:\n  tumble compare golden.png frame_000100.png --diff difference.png");
    return command;
}

CLI::App* add_info(CLI::App& app, CommandLine& line) {
    CLI::App* command = app.add_subcommand("info", "Describe a scene and estimate its cost");
    add_scene(*command, line.info.scene);
    add_size(*command, line.info.overrides.width, line.info.overrides.height, "Picture size, in place of the scene's");
    add_frames_of_time(*command, line.info.overrides);
    command
        ->add_option("--bodies", line.info.bodies,
                     "CSV: one row per body, with mass, center of mass and inertia tensor in 17 digits; -\nis standard "
                     "output, in place of the description")
        ->check(csv_name())
        ->transform(or_standard_output())
        ->type_name("B.csv");
    command->footer("Example:\n  tumble info scene.toml");
    return command;
}

void add_doctor(CLI::App& app, CommandLine& line) {
    CLI::App* command =
        app.add_subcommand("doctor", "Check the requirements of rendering, and name a remedy for each that is not met");
    command
        ->add_option("--time-limit", line.doctor.time_limit, "Seconds that each program and driver may take to answer")
        ->check(number_within(0.001, 1e6))
        ->option_text(fmt::format("S [{:g}]", line.doctor.time_limit));
}

}  // namespace tumble
