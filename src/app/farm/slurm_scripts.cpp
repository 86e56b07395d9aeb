#include "app/farm/slurm_scripts.h"

#include "app/farm/farm_templates.h"
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
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

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

std::string slurm_values(const FarmJob& job) {
    std::vector<std::string> scenes, ranges;
    for (const fs::path& scene : job.scenes) scenes.push_back(scene.string());
    for (const FarmPart& part : job.parts) ranges.push_back(part.range());
    std::string text;
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
    return text + fmt::format("{}  # frames of each part; the first is part 1\n", shell_array("parts", ranges));
}

/// Writes the template of that name. `values`: for its marks, in the order of the marks.
void write_script(const fs::path& path, const std::vector<std::pair<std::string_view, std::string>>& values) {
    std::string text(farm_template(path.filename().string()));
    std::size_t at = 0;
    for (const auto& [mark, value] : values) {
        at = text.find(mark, at);
        text.replace(at, mark.size(), value);
        at += value.size();
    }
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
    write_farm_file(job);
    write_script(job.folder / "settings.sh", {{"@VALUES@\n", slurm_values(job)}});
    const std::string values = shell_word((job.folder / "settings.sh").string());
    const auto write = [&](const char* name, const std::string& title, const char* log) {
        write_script(job.folder / name,
                     {{"@SBATCH@\n", sbatch_lines(job, settings, title, log)}, {"@SETTINGS@", values}});
    };
    write("simulate.sh", "simulation", "simulate.log");
    write("frames.sh", "frames", "frames-%a.log");
    write("stitch.sh", "clip", "stitch.log");
    write_script(submit_script(job.folder), {{"@SETTINGS@", values}});
}

std::vector<std::string> slurm_file_names() {
    return {farm_file({}).string(), "settings.sh", "simulate.sh", "frames.sh", "stitch.sh", "submit.sh"};
}

fs::path submit_script(const fs::path& job_folder) { return job_folder / "submit.sh"; }

}  // namespace tumble
