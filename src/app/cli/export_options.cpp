#include "app/cli/command_line.h"

namespace tumble {

CLI::App* add_export(CLI::App& app, CommandLine& line) {
    ExportCommand& c = line.export_scene;
    CLI::App* command =
        app.add_subcommand("export", "Simulate, and write the scene and its motion as a glTF file for 3D programs");
    add_scene(*command, c.scene);
    command->add_option("-o,--output", c.output, "The glTF 2.0 file to write: .glb")
        ->required()
        ->check(some_name())
        ->type_name("FILE.glb");
    add_choice<KeyKind>(
        *command, "--keys", c.keys, {{"cubic", KeyKind::cubic}, {"frames", KeyKind::linear}},
        "cubic: few keys, exact in flight; frames: one a frame, interpolated linearly, for programs that "
        "leave out the tangents of cubics, as Blender")
        ->option_text("cubic|frames");
    add_frames_of_time(*command, c.overrides);
    add_run(*command, c.threads, std::to_string(c.threads), c.quiet);
    command->footer(
        "Planes become finite squares; patterns, cords and overlays are left out.\n"
        "Examples:\n"
        "  tumble export scene.toml -o scene.glb\n"
        "  tumble export scene.toml -o scene.glb --set simulation.impacts=exact   exact between frames too\n"
        "  tumble export scene.toml -o scene.glb --keys frames                    for Blender");
    return command;
}

}  // namespace tumble
