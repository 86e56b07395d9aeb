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
    add_fps(*command, c.fps,
            "Frames per second, in place of that of the run that drew the frames (frames.json in\n"
            "the folder; without it 60)");
    command->add_flag("--allow-missing", c.allow_missing,
                      "Encode the frames that are there. Without this, a folder with missing frames is refused");
    command->add_flag("--transparent", c.transparent,
                      "Keep the alpha of the frames (.webm and .mov); without this it is left out");
    add_quality(*command, c.quality);
    command->add_flag("--quiet", c.quiet, "Print errors only");
    command->footer("Example:\n  tumble encode out -o clip.mp4 --fps 30");
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
