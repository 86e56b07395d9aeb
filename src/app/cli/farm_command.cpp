#include "app/cli/commands.h"
#include "app/cli/render_plan.h"
#include "app/cli/say.h"
#include "app/clip/render_scenes.h"
#include "app/farm/farm_status.h"
#include "app/farm/openjd_template.h"
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
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

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

/// Throws InputError for a folder that holds other files than a job's, which scripts would replace, and for a clip whose
/// folder is missing, which would show at the end of the job.
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
    const FarmStatus status = look_at_farm(job);
    const std::vector<int> incomplete = status.incomplete();
    if (!command.missing)
        put("{}", status_text(job, status));
    else if (!incomplete.empty())
        put("{}\n", part_list(incomplete));
    return incomplete.empty() ? 0 : parts_missing;
}

}  // namespace

int run_farm(const FarmCommand& command) {
    switch (command.action) {
        case FarmAction::slurm:
            return run_slurm(command);
        case FarmAction::openjd:
            return run_openjd(command);
        case FarmAction::status:
            return run_status(command);
    }
    return 0;
}

}  // namespace tumble
