#include "app/cli/command_line.h"
#include "app/plots/quantities.h"
#include "core/error.h"
#include "scene/toml/limits.h"

#include <algorithm>

namespace tumble {
namespace {

/// The mode of impacts, or the file of their table.
void read_impacts(const std::string& text, SimulateCommand& c) {
    const std::filesystem::path file = text == "-" ? "/dev/stdout" : text;
    const bool is_file =
        file.extension() == ".csv" || file.extension() == ".npz" || text.find('/') != std::string::npos;
    if (text == "-" || is_file)
        c.tables.impacts = file;
    else if (text == "stepped" || text == "exact")
        c.overrides.impacts = text;
    else
        throw InputError(
            fmt::format("--impacts: must be stepped or exact, or a file that ends with .csv or .npz (was '{}'){}",
                        safe_text(text), did_you_mean(text, {"stepped", "exact"})));
}

/// The folders of checkpoints, and the settings of the clip that is drawn from them.
void add_checkpoints(CLI::App& command, SimulateCommand& c) {
    CLI::Option* const folder =
        command
            .add_option("--checkpoints", c.checkpoints,
                        "Write the state of the simulation to DIR, from which parts of a clip are drawn:\n"
                        "tumble render --from-checkpoints DIR (docs/how-to/long-renders.md)")
            ->check(some_name())
            ->type_name("DIR");
    command.add_option("--every", c.every, "Seconds of the clip between two checkpoints")
        ->check(number_within(1e-6, limits::duration.max))
        ->needs(folder)
        ->option_text("S [1]");
    command
        .add_flag_callback(
            "--no-motion", [&c] { c.motion = false; },
            "Leave the motion of the frames out: DIR is smaller, but each part simulates its\nframes once more")
        ->needs(folder);
    CLI::Option* const from =
        command
            .add_option("--from-checkpoints", c.from_checkpoints,
                        "Go on from the last checkpoint before --start, in place of the start of the scene")
            ->check(some_name())
            ->excludes(folder)
            ->type_name("DIR");
    command.add_option("--start", c.start, "Seconds of the scene before the first rows of the tables")
        ->check(number_within(limits::duration.min, limits::duration.max))
        ->needs(from)
        ->option_text("S [0]");
    // Options of the clip: the same as the options of render.
    const std::vector<CLI::Option*> before = command.get_options();
    add_size(command, c.overrides.width, c.overrides.height, "Of the clip: picture size, in place of the scene's");
    add_clip_times(command, c.clip);
    add_panels(command, c.clip, "A panel");
    add_text(command, c.overrides);
    std::vector<CLI::Option*> of_clip = command.get_options();
    std::erase_if(of_clip, [&](CLI::Option* o) { return std::find(before.begin(), before.end(), o) != before.end(); });
    command.parse_complete_callback([of_clip, folder, from] {
        for (const CLI::Option* const option : of_clip)
            if (option->count() > 0 && folder->count() + from->count() == 0)
                throw CLI::RequiresError(option->get_name(), "--checkpoints or --from-checkpoints");
    });
}

}  // namespace

CLI::App* add_simulate(CLI::App& app, CommandLine& line) {
    SimulateCommand& c = line.simulate;
    CLI::App* command = app.add_subcommand("simulate", "Simulate a scene without drawing, and write tables of numbers");
    command
        ->add_option("scene", c.scenes, "The scene file (TOML); several with --checkpoints of a clip that shows them")
        ->check(some_name())
        ->required()
        ->type_name("SCENE");
    command
        ->add_option("--trajectory", c.tables.trajectory,
                     "CSV: one row per frame and moving body, with its center of mass, orientation\nand velocities; - "
                     "is standard output")
        ->check(csv_name())
        ->transform(or_standard_output())
        ->type_name("T.csv");
    command
        ->add_option("--energy", c.tables.energy,
                     "CSV: one row per frame, with energies, momenta and contacts; - is standard output")
        ->check(csv_name())
        ->transform(or_standard_output())
        ->type_name("E.csv");
    CLI::Option* step = command
                            ->add_option("--step", c.overrides.step,
                                         "The fixed step in s, in place of the scene's; it must divide 1/fps")
                            ->type_name("H");
    command->add_option("--steps-per-frame", c.overrides.steps_per_frame, "The same as a number of steps per frame")
        ->excludes(step)
        ->type_name("N");
    command
        ->add_option("--integrator", c.overrides.integrator,
                     "Method that advances the bodies from step to step, in place of the scene's")
        ->option_text("symplectic-euler|explicit-euler|splitting|rk4|exact");
    command
        ->add_option_function<std::string>(
            "--impacts", [&c](const std::string& text) { read_impacts(text, c); },
            "stepped: resolved in the steps; exact: each at its own time. Or a table: a row for each\nimpulse, as CSV "
            "or "
            ".npz; - is standard output. Give it twice for both")
        ->take_all()
        ->allow_extra_args(false)
        ->trigger_on_parse()
        ->option_text("stepped|exact|I.csv");
    command
        ->add_option("--contacts", c.tables.contacts,
                     "CSV or .npz: one row per frame and contact point, with forces and slip; - is standard\noutput")
        ->check(some_name())
        ->transform(or_standard_output())
        ->type_name("C.csv");
    command
        ->add_option("--loads", c.tables.loads,
                     "CSV or .npz: one row per frame and dynamic body, with the force and moment of gravity,\nwind and "
                     "[[force]]s; - is standard output")
        ->check(some_name())
        ->transform(or_standard_output())
        ->type_name("L.csv");
    command
        ->add_option(
            "--joints", c.tables.joints,
            "CSV or .npz: one row per frame and joint, with coordinates, speeds, force and torque,\ngap, limits "
            "and breaking; - is standard output")
        ->check(some_name())
        ->transform(or_standard_output())
        ->type_name("J.csv");
    command->add_option("--impact-law", c.overrides.impact_law, "Rule for several contacts at once")
        ->option_text("propagating|simultaneous");
    add_frames_of_time(*command, c.overrides);
    add_checkpoints(*command, c);
    c.threads = machine_threads();
    add_run(*command, c.threads, std::to_string(c.threads), c.quiet);
    command->footer(
        "Examples:\n"
        "  tumble simulate scene.toml --checkpoints states --every 10\n"
        "  tumble simulate scene.toml --from-checkpoints states --start 50 --energy e.csv\n"
        "  tumble simulate scene.toml --trajectory t.csv --energy e.csv\n"
        "  tumble simulate scene.toml --energy e.csv --fps 1000 --steps-per-frame 1   every step is a row");
    return command;
}

CLI::App* add_plot(CLI::App& app, CommandLine& line) {
    PlotCommand& c = line.plot;
    CLI::App* command = app.add_subcommand("plot", "Simulate, and plot quantities over time");
    command->add_option("scenes", c.scenes, "Scene files (TOML); several are drawn into one plot")
        ->required()
        ->check(some_name())
        ->type_name("SCENE");
    command->add_option("--of", c.quantities, "Quantities, separated by commas, as in energy,body.ball.y")
        ->required()
        ->check(some_name())
        ->type_name("LIST");
    command->add_option("-o,--output", c.output, "The plot to write: .svg .png or .pdf")
        ->required()
        ->check(some_name())
        ->type_name("FILE");
    command
        ->add_option(
            "--vary", c.vary,
            "A run for each value of a key, as in\nsimulation.integrator=explicit-euler,symplectic-euler; may be "
            "repeated")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("PATH=VALUES");
    command->add_flag("--difference", c.difference, "Plot the difference of each run to the first one");
    command->add_flag("--log", c.log, "Logarithmic vertical axes; of differences the absolute value");
    command->add_option("--title", c.title, "Title, in place of the first scene's")->type_name("TEXT");
    add_size(*command, c.width, c.height, "Size in pixels (points of a PDF)")->option_text("WxH [900x540]");
    add_frames_of_time(*command, c.overrides);
    add_run(*command, c.threads, std::to_string(c.threads), c.quiet);
    command->footer(
        quantity_help() +
        "\nExamples:\n"
        "  tumble plot scene.toml --of energy,contacts -o energy.svg\n"
        "  tumble plot scene.toml --of body.ball.y --vary simulation.integrator=explicit-euler,exact -o y.png");
    return command;
}

}  // namespace tumble
