#include "app/cli/command.h"
#include "app/cli/render_run.h"
#include "app/cli/say.h"
#include "app/cli/shared_options.h"
#include "app/clip/render_scenes.h"
#include "app/farm/farm_job.h"
#include "app/farm/slurm_scripts.h"
#include "app/files/output_plan.h"
#include "core/error.h"
#include "core/frame_rate.h"
#include "core/safe_text.h"
#include "output/process.h"
#include "output/temporary_file.h"
#include "output/video_format.h"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

struct FarmCommand {
    RenderCommand render;  // scene, clip, and the options that decide the frames
    std::vector<std::string> simulate_options, render_options, encode_options;  // the given ones, as words
    std::optional<std::filesystem::path> folder;  // of the job; without this, the clip's name with .farm
    int parts = 0;
    int retries = 2;
    SlurmSettings slurm;
    bool write_only = false;          // does not submit the job
    std::filesystem::path job;        // of OpenJD (JSON)
    int chunk = 0;                    // frames; 0: so many that there are about 20 parts
    std::string program = "tumble";   // on the machines of the farm
    std::filesystem::path status_of;  // folder of a job
    bool missing = false;             // only the numbers of the missing parts
};

constexpr int usual_parts = 20;   // of an OpenJD job
constexpr int parts_missing = 3;  // exit code

fs::path whole_path(const fs::path& path) { return fs::absolute(path).lexically_normal(); }

/// The scenes and the options of the drawing, checked as a render checks them.
FarmJob job_of(const FarmCommand& command, const RenderScenes& scenes) {
    const RenderCommand& render = command.render;
    if (scenes.shows_damage())
        throw InputError(
            "--overlay: damage shows where a frame differs from the one before, which the first frame of a part does "
            "not know; "
            "leave it out on a farm");
    FarmJob job;
    for (const fs::path& scene : render.scenes) job.scenes.push_back(whole_path(scene));
    for (const fs::path& input : scenes.inputs)
        if (std::ranges::find(render.scenes, input) == render.scenes.end()) job.meshes.push_back(whole_path(input));
    job.program =
        command.program.find('/') == std::string::npos ? command.program : whole_path(command.program).string();
    job.frames = scenes.clip_frames;
    job.fps = scenes.first().output.fps;
    job.simulate_options = command.simulate_options;
    job.render_options = command.render_options;
    job.encode_options = command.encode_options;
    job.encode_options.insert(job.encode_options.begin(), {"--fps", fps_text(job.fps)});
    job.retries = command.retries;
    return job;
}

RenderScenes scenes_of(const RenderCommand& render) {
    return {render, Shutter::of(render.shutter, render.blur_samples)};
}

/// Throws InputError if the folder has frames of another clip.
void check_old_frames(const FarmJob& job, const RenderScenes& scenes, RenderCommand render) {
    render.clip.reset();
    render.frames = frames_folder(job.folder);
    render.frames_range = FarmPart{0, job.frames - 1}.range();
    plan_render(render, scenes);
}

/// The length of at most so many equal parts.
std::int64_t part_length(const FarmJob& job, int parts) { return (job.frames + parts - 1) / parts; }

/// A checkpoint where each part begins.
void divide(FarmJob& job, std::int64_t length) {
    job.parts = divide_frames(job.frames, length);
    job.checkpoint_period = double(job.parts.front().count()) / job.fps;
}

void add_inputs(OutputPlan& plan, const FarmJob& job) {
    plan.add_inputs(job.scenes);
    plan.add_inputs(job.meshes);
}

/// `files`: names in the folder of the job.
void check_clip(const FarmJob& job, const RenderCommand& render, const std::vector<std::string>& files = {}) {
    video_format(job.clip, job.fps, render.drawing.transparent);
    OutputPlan plan;
    add_inputs(plan, job);
    plan.add("--output", job.clip);
    if (!job.folder.empty()) plan.add("--folder", job.folder);
    for (const std::string& name : files) plan.add_below("--folder", job.folder, name);
}

/// Throws InputError for a folder that holds other files than a job's, which scripts would replace, and for a clip
/// whose folder is missing, which would show at the end of the job.
void check_folders(const FarmJob& job) {
    std::error_code error;
    if (fs::exists(job.folder, error) && !fs::exists(farm_file(job.folder), error) &&
        !(fs::is_directory(job.folder, error) && fs::is_empty(job.folder, error)))
        throw InputError(fmt::format("--folder: '{}' holds other files than those of a farm job; name another folder",
                                     safe_path(job.folder)));
    if (!fs::is_directory(job.clip.parent_path(), error))
        throw InputError(fmt::format("--output: there is no folder '{}'", safe_path(job.clip.parent_path())));
}

/// Runs the script that submits the job; its messages name the jobs.
void submit(const FarmJob& job) {
    if (!find_program("sbatch"))
        throw RunError(fmt::format(
            "there is no program 'sbatch' on the PATH; the scripts are written: on a machine of the cluster, "
            "run bash {}",
            safe_path(submit_script(job.folder))));
    const auto bash = find_program("bash");
    if (!bash) throw RunError("there is no program 'bash' on the PATH");
    Process process(*bash, {submit_script(job.folder).string()}, STDOUT_FILENO);
    const ProcessEnd end = process.finish();
    if (!end.ok()) throw RunError(fmt::format("the job could not be submitted:\n{}", safe_lines(end.error_text)));
}

int run_slurm(const FarmCommand& command) {
    const RenderScenes scenes = scenes_of(command.render);
    FarmJob job = job_of(command, scenes);
    divide(job, part_length(job, command.parts));
    job.clip = whole_path(*command.render.clip);
    job.folder = command.folder ? whole_path(*command.folder) : fs::path(job.clip.string() + ".farm");
    check_clip(job, command.render, slurm_file_names());
    check_slurm(job, command.slurm);
    check_folders(job);
    check_old_frames(job, scenes, command.render);
    write_slurm_scripts(job, command.slurm);
    if (!command.render.quiet)
        say("wrote the scripts of {} parts of {} frames to {}\n", job.parts.size(), job.parts.front().count(),
            safe_path(job.folder));
    if (!command.write_only) submit(job);
    return 0;
}

int run_openjd(const FarmCommand& command) {
    FarmJob job = job_of(command, scenes_of(command.render));
    divide(job, command.chunk > 0 ? command.chunk : part_length(job, usual_parts));
    const char* ending = command.render.drawing.transparent ? ".webm" : ".mp4";
    job.clip = command.render.clip ? *command.render.clip : fs::path(job.scenes.front().stem().string() + ending);
    if (job.clip.has_parent_path())
        throw InputError(
            fmt::format("--clip: must be a name without a folder (was '{}'); the job's output folder is chosen "
                        "when it is submitted",
                        safe_path(job.clip)));
    check_clip(job, command.render);
    OutputPlan plan;
    add_inputs(plan, job);
    plan.add("--output", command.job);
    write_file(command.job, openjd_template(job, whole_path(command.job)));
    if (!command.render.quiet)
        say("wrote {}: {} frames in chunks of {}\n", safe_path(command.job), job.frames, job.parts.front().count());
    return 0;
}

int run_status(const FarmCommand& command) {
    const FarmJob job = read_farm_file(whole_path(command.status_of));
    const FarmStatus status = find_farm_status(job);
    const std::vector<int> incomplete = status.incomplete();
    if (!command.missing)
        put("{}", status_text(job, status));
    else if (!incomplete.empty())
        put("{}\n", part_list(incomplete));
    return incomplete.empty() ? 0 : parts_missing;
}

// The options of `render` that decide the frames. `simulate` gets all of them but the options of drawing.
constexpr std::array frame_options{"--size",  "--method",  "--set",     "--seed", "--fps",         "--duration",
                                   "--speed", "--shutter", "--overlay", "--plot", "--plot-place",  "--blur-samples",
                                   "--vary",  "--layout",  "--samples", "--gl",   "--transparent", "--camera"};
constexpr std::array only_drawing{"--samples", "--gl", "--transparent"};
// The options that `encode` gets.
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
        ->check(file_name("toml"))
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
    // The values of the scene must equal the values of the frames; `simulate` has no option for the samples of a pixel.
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

void add_slurm(Command& farm) {
    Command& command = farm.add("slurm", "Make a clip on a Slurm cluster: write job scripts, and submit them");
    FarmCommand& c = command.keep<FarmCommand>();
    add_drawing(command, c.render);
    command.add_option("--parts", c.parts, "Parts of the frames, each a task of a job array")
        ->check(number_within(1, most_parts))
        ->required()
        ->type_name("N");
    command.add_option("-o,--output", c.render.clip, "The clip to make: .mp4 .mov .mkv .webm or .gif")
        ->check(file_name("mp4 mov mkv webm gif"))
        ->required()
        ->type_name("CLIP");
    command
        .add_option(
            "--folder", c.folder,
            "Folder of the job: scripts, checkpoints, frames and logs. All machines must reach it\nand the scene by "
            "the same path")
        ->check(folder_name())
        ->option_text("DIR [CLIP.farm]");
    command.add_flag("--write-only,--dry-run", c.write_only, "Write the scripts, and do not submit them");
    command.add_option("--retries", c.retries, "How often a failed part is run again")
        ->check(number_within(0, 100))
        ->option_text("N [2]");
    add_program(command, c);
    command.add_option("--partition", c.slurm.partition, "Partition of the cluster")
        ->check(some_name())
        ->type_name("NAME");
    command.add_option("--time", c.slurm.time, "Time limit of each job, as sbatch takes it")
        ->check(some_name())
        ->type_name("TIME");
    command
        .add_option("--cpus-per-task", c.slurm.cpus_per_task,
                    "Processors of each job, and with them its render processes")
        ->check(number_within(1, most_threads))
        ->option_text("N [1]");
    command
        .add_option("--sbatch", c.slurm.more,
                    "Another option of sbatch for each job, as in --sbatch=--account=film; may be repeated")
        ->take_all()
        ->allow_extra_args(false)
        ->type_name("OPTION");
    command.add_flag("--quiet", c.render.quiet, "Print errors only");
    command.notes = "Guide: docs/how-to/farm.md";
    command.examples =
        "  tumble farm slurm scene.toml --parts 40 -o clip.mp4 --partition cpu --time 30:00\n"
        "  tumble farm slurm scene.toml --parts 40 -o clip.mp4 --write-only   then: bash clip.mp4.farm/submit.sh";
    command.run = [&c, &command] {
        take_given_options(command, c);
        return run_slurm(c);
    };
}

void add_openjd(Command& farm) {
    Command& command = farm.add("openjd", "Write a job template of Open Job Description (2023-09)");
    FarmCommand& c = command.keep<FarmCommand>();
    add_drawing(command, c.render);
    command.add_option("-o,--output", c.job, "The template to write (JSON)")
        ->check(file_name("json"))
        ->required()
        ->type_name("JOB.json");
    command
        .add_option("--clip", c.render.clip,
                    "Name of the clip in the job's output folder; it can be changed when the job is submitted")
        ->check(file_name("mp4 mov mkv webm gif"))
        ->option_text("CLIP [SCENE.mp4]");
    command.add_option("--chunk", c.chunk, "Frames that a task draws; it can be changed when the job is submitted")
        ->check(number_within(1, 1000000000))
        ->option_text("N [a twentieth]");
    add_program(command, c);
    command.add_flag("--quiet", c.render.quiet, "Print errors only");
    command.notes = "Guide: docs/how-to/farm.md";
    command.examples = "  tumble farm openjd scene.toml -o job.json --chunk 12";
    command.run = [&c, &command] {
        take_given_options(command, c);
        return run_openjd(c);
    };
}

void add_status(Command& farm) {
    Command& command = farm.add("status", "Name the missing parts of a job", {{0, "none"}, {parts_missing, "some"}});
    FarmCommand& c = command.keep<FarmCommand>();
    command.add_option("folder", c.status_of, "The folder of the job")
        ->check(folder_name())
        ->required()
        ->type_name("DIR");
    command.add_flag("--missing", c.missing, "Print only the numbers of the missing parts, as in 3,7-9");
    command.examples = "  tumble farm status clip.mp4.farm";
    command.run = [&c] { return run_status(c); };
}

}  // namespace

void add_farm(Command& command) {
    command.require_subcommand(1);
    add_slurm(command);
    add_openjd(command);
    add_status(command);
    command.examples =
        "  tumble farm slurm scene.toml --parts 20 -o clip.mp4\n"
        "  tumble farm openjd scene.toml -o job.json";
}

}  // namespace tumble
