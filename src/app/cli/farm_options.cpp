#include "app/cli/command_line.h"
#include "app/farm/farm_job.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace tumble {
namespace {

// The options of `render` that decide the frames. `simulate` gets all of them but those of the drawing alone.
constexpr std::array frame_options{"--size",  "--method",  "--set",     "--seed", "--fps",        "--duration",
                                   "--speed", "--shutter", "--overlay", "--plot", "--plot-place", "--blur-samples",
                                   "--vary",  "--layout",  "--samples", "--gl",   "--transparent"};
constexpr std::array only_drawing{"--samples", "--gl", "--transparent"};
// Those that `encode` gets.
constexpr std::array clip_options{"--quality", "--transparent"};

template <class List>
bool has(const List& list, std::string_view name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

/// The options of `render` that decide the frames and the clip, and its scene.
void add_drawing(CLI::App& command, RenderCommand& c) {
    add_render_options(command, c);
    const auto all = command.get_options([](const CLI::Option*) { return true; });
    for (CLI::Option* option : all) {
        const std::string name = option->get_name();
        if (has(frame_options, name) || has(clip_options, name))
            option->group("Drawing, as in tumble render");
        else if (option != command.get_help_ptr())
            command.remove_option(option);
    }
    command.add_option("scene", c.scenes, "The scene files (TOML); several are shown side by side")
        ->check(some_name())
        ->required()
        ->type_name("SCENE");
}

/// The given options out of a list and not in another, as words of a command line.
template <class List, class Others = std::array<const char*, 0>>
std::vector<std::string> given_options(const CLI::App& command, const List& list, const Others& but = {}) {
    std::vector<std::string> words;
    for (const CLI::Option* option : command.get_options()) {
        if (!has(list, option->get_name()) || has(but, option->get_name())) continue;
        const bool flag = option->get_items_expected_max() == 0;
        for (const std::string& value : option->results())
            words.push_back(flag ? option->get_name() : option->get_name() + "=" + value);
    }
    return words;
}

void take_given_options(const CLI::App& command, FarmCommand& c) {
    c.render_options = given_options(command, frame_options);
    c.simulate_options = given_options(command, frame_options, only_drawing);
    // The values of the scene must be those of the frames; `simulate` has no option for the samples of a pixel.
    for (const std::string& samples : command.get_option("--samples")->results())
        c.simulate_options.push_back("--set=output.samples=" + samples);
    c.encode_options = given_options(command, clip_options);
}

void add_program(CLI::App& command, FarmCommand& c) {
    command
        .add_option("--program", c.program,
                    "The tumble program on the machines of the farm: a name on their PATH, or a path")
        ->check(some_name())
        ->option_text("PROGRAM [tumble]");
}

void add_slurm(CLI::App& farm, FarmCommand& c) {
    CLI::App* command =
        farm.add_subcommand("slurm", "Make a clip on a Slurm cluster: write job scripts, and submit them");
    add_drawing(*command, c.render);
    command->add_option("--parts", c.parts, "Parts of the frames, each a task of a job array")
        ->check(CLI::Range(1, most_parts))
        ->required()
        ->type_name("N");
    command->add_option("-o,--output", c.render.clip, "The clip to make: .mp4 .mov .mkv .webm or .gif")
        ->check(some_name())
        ->required()
        ->type_name("CLIP");
    command
        ->add_option(
            "--folder", c.folder,
            "Folder of the job: scripts, checkpoints, frames and logs. All machines must reach it\nand the scene by "
            "the same path")
        ->check(some_name())
        ->option_text("DIR [CLIP.farm]");
    command->add_flag("--write-only,--dry-run", c.write_only, "Write the scripts, and do not submit them");
    command->add_option("--retries", c.retries, "How often a failed part is run again")
        ->check(CLI::Range(0, 100))
        ->option_text("N [2]");
    add_program(*command, c);
    command->add_option("--partition", c.slurm.partition, "Partition of the cluster")
        ->check(some_name())
        ->type_name("NAME");
    command->add_option("--time", c.slurm.time, "Time limit of each job, as sbatch takes it")
        ->check(some_name())
        ->type_name("TIME");
    command
        ->add_option("--cpus-per-task", c.slurm.cpus_per_task,
                     "Processors of each job, and with them its render processes")
        ->check(CLI::Range(1, most_threads))
        ->option_text("N [1]");
    command
        ->add_option("--sbatch", c.slurm.more,
                     "Another option of sbatch for each job, as in --sbatch=--account=film; may be repeated")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("OPTION");
    command->add_flag("--quiet", c.render.quiet, "Print errors only");
    command->footer(
        "Examples:\n"
        "  tumble farm slurm scene.toml --parts 40 -o clip.mp4 --partition cpu --time 30:00\n"
        "  tumble farm slurm scene.toml --parts 40 -o clip.mp4 --write-only   then: bash clip.mp4.farm/submit.sh\n"
        "Guide: docs/how-to/farm.md");
    command->callback([&c, command] {
        c.action = FarmAction::slurm;
        take_given_options(*command, c);
    });
}

void add_openjd(CLI::App& farm, FarmCommand& c) {
    CLI::App* command = farm.add_subcommand("openjd", "Write a job template of Open Job Description (2023-09)");
    add_drawing(*command, c.render);
    command->add_option("-o,--output", c.job, "The template to write (JSON)")
        ->check(some_name())
        ->required()
        ->type_name("JOB.json");
    command
        ->add_option("--clip", c.render.clip,
                     "Name of the clip in the job's output folder; it can be changed when the job is submitted")
        ->check(some_name())
        ->option_text("CLIP [SCENE.mp4]");
    command->add_option("--chunk", c.chunk, "Frames that a task draws; it can be changed when the job is submitted")
        ->check(CLI::Range(1, 1000000000))
        ->option_text("N [a twentieth]");
    add_program(*command, c);
    command->add_flag("--quiet", c.render.quiet, "Print errors only");
    command->footer(
        "Example:\n"
        "  tumble farm openjd scene.toml -o job.json --chunk 12\n"
        "Guide: docs/how-to/farm.md");
    command->callback([&c, command] {
        c.action = FarmAction::openjd;
        take_given_options(*command, c);
    });
}

void add_status(CLI::App& farm, FarmCommand& c) {
    CLI::App* command = farm.add_subcommand("status", "Name the missing parts of a job: exit code 0 none, 3 some");
    command->add_option("folder", c.status_of, "The folder of the job")
        ->check(some_name())
        ->required()
        ->type_name("DIR");
    command->add_flag("--missing", c.missing, "Print only the numbers of the missing parts, as in 3,7-9");
    command->callback([&c] { c.action = FarmAction::status; });
}

}  // namespace

CLI::App* add_farm(CLI::App& app, CommandLine& line) {
    CLI::App* command = app.add_subcommand("farm", "Make a clip on many machines: Slurm, or engines that read OpenJD");
    command->require_subcommand(1);
    add_slurm(*command, line.farm);
    add_openjd(*command, line.farm);
    add_status(*command, line.farm);
    command->footer(
        "Examples:\n"
        "  tumble farm slurm scene.toml --parts 20 -o clip.mp4\n"
        "  tumble farm openjd scene.toml -o job.json");
    return command;
}

}  // namespace tumble
