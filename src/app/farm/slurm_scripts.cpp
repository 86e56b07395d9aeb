#include "app/farm/slurm_scripts.h"

#include "app/farm/sbatch_option.h"
#include "app/farm/shell_text.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/make_folder.h"
#include "output/temporary_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

// Functions that the scripts share, after the settings.
constexpr const char* shared_functions = R"bash(
# try NAME COMMAND...: runs the command, and again while it fails, at most "retries" times. Wrong input (exit code 2) stays
# wrong, and is not tried again.
try() {
    local name=$1 again code
    shift
    for ((again = 0; ; again++)); do
        "$@" && return 0
        code=$?
        echo "$name failed on $(hostname) with exit code $code" >&2
        ((code == 2 || again >= retries)) && return "$code"
        echo "$name: trying again ($((again + 1)) of $retries)" >&2
    done
}
)bash";

struct SlurmScript {
    const char *about, *code;
};

constexpr SlurmScript simulate_script = {
    R"bash(# The first job: simulates the scene, and writes a checkpoint where each part of the frames begins.
#   bash simulate.sh                  by hand
)bash",
    R"bash(try "the simulation" "$program" simulate "${scenes[@]}" "${simulate_options[@]}" --quiet \
    --checkpoints "$folder/checkpoints" --every "$every"
)bash"};

constexpr SlurmScript frames_script = {
    R"bash(# The second job, an array with a task for each part: draws the frames of a part. Finished frames of the same scene, version
# and settings are kept.
#   bash frames.sh PART               by hand, with the number of the part, from 1
#   sbatch --array=PART frames.sh     on the cluster
)bash",
    R"bash(part=${1:-${SLURM_ARRAY_TASK_ID-}}
if ! [[ $part =~ ^[1-9][0-9]*$ ]] || ((part > ${#parts[@]})); then
    echo "usage: frames.sh PART, a number from 1 to ${#parts[@]}" >&2
    exit 2
fi
cores=()   # those that Slurm has given to the task
[[ -n ${SLURM_CPUS_PER_TASK-} ]] && cores=(--workers "$SLURM_CPUS_PER_TASK" --threads "$SLURM_CPUS_PER_TASK")
try "part $part (frames ${parts[part - 1]})" "$program" render "${scenes[@]}" "${render_options[@]}" --quiet "${cores[@]}" \
    --frames "$folder/frames" --frames-range "${parts[part - 1]}" --from-checkpoints "$folder/checkpoints" --resume
)bash"};

constexpr SlurmScript stitch_script = {
    R"bash(# The last job, after the end of all tasks of the array, failed ones too: checks that all frames are there, and makes the
# clip. If frames are missing, it submits their parts and itself again, at most "retries" times.
#   bash stitch.sh                    by hand
)bash",
    R"bash(round=${1:-0}
missing=$("$program" farm status "$folder" --missing)
code=$?
if ((code == 3)); then
    "$program" farm status "$folder" >&2
    if [[ ! -e $folder/checkpoints/clip.tumble ]]; then
        echo "the simulation has not finished (log/simulate.log); submit everything again: bash $(printf %q "$folder/submit.sh")" >&2
    elif [[ -n ${SLURM_JOB_ID-} ]] && ((round < retries)) && command -v sbatch >/dev/null; then
        echo "submitting the missing parts again ($((round + 1)) of $retries)" >&2
        bash "$folder/submit.sh" "$missing" "$((round + 1))"
    fi
    exit 1
fi
((code == 0)) || exit "$code"
exec "$program" encode "$folder/frames" -o "$clip" "${encode_options[@]}" --quiet
)bash"};

constexpr SlurmScript submit_script_text = {R"bash(# Submits the jobs to Slurm.
#   bash submit.sh                    everything: the simulation, all parts, and the job that makes the clip
#   bash submit.sh PARTS              these parts again, as in 3,7-9, and the job that makes the clip
)bash",
                                            R"bash(wanted=${1-} round=${2:-0}
submitted=() after=()
stop() {
    ((${#submitted[@]} == 0)) || scancel "${submitted[@]}"
    exit 1
}
if [[ -z $wanted ]]; then
    job=$(sbatch --parsable "$folder/simulate.sh") || stop
    submitted+=("${job%%;*}")
    echo "job ${job%%;*}: simulation"
    # Without the simulation the parts would wait forever.
    after=("--dependency=afterok:${job%%;*}" --kill-on-invalid-dep=yes)
    wanted=1-${#parts[@]}
fi
job=$(sbatch --parsable "${after[@]}" "--array=$wanted" "$folder/frames.sh") || stop
submitted+=("${job%%;*}")
echo "job ${job%%;*}: frames, parts $wanted"
# Not afterok: the last job names the parts that failed.
job=$(sbatch --parsable "--dependency=afterany:${job%%;*}" "$folder/stitch.sh" "$round") || stop
echo "job ${job%%;*}: clip"
)bash"};

/// The options of sbatch in the script of a job.
std::string sbatch_lines(const FarmJob& job, const SlurmSettings& settings, const std::string& name,
                         const std::string& log) {
    std::string text;
    const auto option = [&](const std::string& key, std::string_view value) {
        text += fmt::format("#SBATCH --{}={}\n", key, sbatch_value(value));
    };
    option("job-name", fmt::format("{} {}", safe_path(job.clip.filename()), name));
    option("output", (job.folder / "log" / log).string());
    option("open-mode", "append");
    text += "#SBATCH --requeue\n";
    option("cpus-per-task", std::to_string(settings.cpus_per_task));
    if (!settings.partition.empty()) option("partition", settings.partition);
    if (!settings.time.empty()) option("time", settings.time);
    for (const std::string& more : settings.more) text += fmt::format("#SBATCH {}\n", sbatch_line(more));
    return text;
}

std::string slurm_settings_text(const FarmJob& job) {
    std::vector<std::string> scenes, ranges;
    for (const fs::path& scene : job.scenes) scenes.push_back(scene.string());
    for (const FarmPart& part : job.parts) ranges.push_back(part.range());
    std::string text = "# Settings of the scripts in this folder. Written by tumble farm slurm.\n";
    const auto set = [&](const char* name, const std::string& value, const char* comment) {
        text += fmt::format("{}={}  # {}\n", name, shell_word(value), comment);
    };
    set("program", job.program, "on each machine");
    set("folder", job.folder.string(), "this folder, the same path on each machine");
    set("clip", job.clip.string(), "the result");
    set("every", fmt::format("{}", job.checkpoint_period), "s between checkpoints, a part of the frames");
    set("retries", std::to_string(job.retries), "how often a failed part is run again");
    text += fmt::format("{}  # the same paths on each machine\n", shell_array("scenes", scenes));
    text += fmt::format("{}\n{}\n{}\n", shell_array("simulate_options", job.simulate_options),
                        shell_array("render_options", job.render_options),
                        shell_array("encode_options", job.encode_options));
    text += fmt::format("{}  # frames of each part; the first is part 1\n", shell_array("parts", ranges));
    return text + shared_functions;
}

void write_script(const fs::path& path, const std::string& text) {
    write_file(path, text);
    std::error_code ignored;  // bash reads a script that cannot be executed as well
    if (path.filename() != "settings.sh")
        fs::permissions(path, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                        fs::perm_options::add, ignored);
}

}  // namespace

void check_slurm(const FarmJob& job, const SlurmSettings& settings) {
    // Slurm replaces % and \ in the name of a log, also in the part that is the folder.
    const std::string folder = job.folder.string();
    if (folder.find_first_of("%\\") != std::string::npos || has_control_characters(folder))
        throw InputError(
            fmt::format("--folder: Slurm cannot write its logs into a folder with %, \\ or a control character in its "
                        "path (was '{}'); name another",
                        safe_path(folder)));
    for (const auto& [option, value] :
         {std::pair("--partition", settings.partition), std::pair("--time", settings.time)})
        if (has_control_characters(value))
            throw InputError(fmt::format("{}: must have no control characters (was '{}')", option, safe_text(value)));
    for (const std::string& more : settings.more) check_sbatch_option(more);
}

void write_slurm_scripts(const FarmJob& job, const SlurmSettings& settings) {
    make_folder(job.folder / "log");
    const std::string read_settings =
        fmt::format("set -u\nsource {} || exit\n", shell_word((job.folder / "settings.sh").string()));
    const auto write = [&](const char* name, const SlurmScript& script, const std::string& options) {
        write_script(job.folder / name,
                     fmt::format("#!/bin/bash\n{}{}{}{}", script.about, options, read_settings, script.code));
    };
    write_farm_file(job);
    write_script(job.folder / "settings.sh", slurm_settings_text(job));
    write("simulate.sh", simulate_script, sbatch_lines(job, settings, "simulation", "simulate.log"));
    write("frames.sh", frames_script, sbatch_lines(job, settings, "frames", "frames-%a.log"));
    write("stitch.sh", stitch_script, sbatch_lines(job, settings, "clip", "stitch.log"));
    write("submit.sh", submit_script_text, "");
}

std::vector<std::string> slurm_file_names() {
    return {farm_file({}).string(), "settings.sh", "simulate.sh", "frames.sh", "stitch.sh", "submit.sh"};
}

fs::path submit_script(const fs::path& job_folder) { return job_folder / "submit.sh"; }

}  // namespace tumble
