#include "app/farm/slurm_scripts.h"

#include "app/farm/farm_templates.h"
#include "app/farm/shell_text.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/output_path.h"
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

namespace {

/// An option that a farm sets, and the remedy; `letter` 0: there is no short form.
struct OwnOption {
    std::string_view name;
    char letter;
    const char* remedy;
};

constexpr const char* by_the_scripts = "is set by the scripts themselves";
constexpr OwnOption own_options[] = {
    {"array", 'a', by_the_scripts},
    {"cpus-per-task", 'c', "has an option of its own: --cpus-per-task"},
    {"dependency", 'd', by_the_scripts},
    {"job-name", 'J', by_the_scripts},
    {"kill-on-invalid-dep", 0, by_the_scripts},
    {"no-requeue", 0, by_the_scripts},
    {"open-mode", 0, by_the_scripts},
    {"output", 'o', by_the_scripts},
    {"parsable", 0, by_the_scripts},
    {"partition", 'p', "has an option of its own: --partition"},
    {"requeue", 0, by_the_scripts},
    {"test-only", 0, "submits nothing: use --write-only"},
    {"time", 't', "has an option of its own: --time"},
    {"wait", 'W', "would hold up the job: leave it out"},
    {"wrap", 0, by_the_scripts},
};
constexpr std::string_view short_flags = "hHIkOQsvVW";  // of sbatch: a letter after one of these is another option

/// The place of the value after the name: "=" of a long option, a space of both.
std::size_t end_of_name(std::string_view option) { return std::min(option.find_first_of("= "), option.size()); }

[[noreturn]] void refuse(std::string_view given, const char* why) {
    throw InputError(fmt::format("--sbatch: {} {}", safe_text(given), why));
}

void check_long(std::string_view name) {
    // sbatch takes the start of a name for the name.
    for (const OwnOption& own : own_options)
        if (own.name.starts_with(name)) refuse(fmt::format("--{}", own.name), own.remedy);
}

void check_short(std::string_view letters) {
    for (const char letter : letters) {
        for (const OwnOption& own : own_options)
            if (own.letter == letter) refuse(fmt::format("-{}", letter), own.remedy);
        if (short_flags.find(letter) == std::string_view::npos) return;  // the rest is its value
    }
}

/// One option, with a value in one word where it is not behind a '='.
bool is_one_option(std::string_view option) {
    const std::size_t end = end_of_name(option);
    const std::string_view name = option.substr(0, end);
    if (name.size() < 2 || name[0] != '-' || name == "--" || has_control_characters(option)) return false;
    if (end == option.size() || option[end] == '=') return name.find_first_of("\"'#\\") == std::string_view::npos;
    const std::string_view value = option.substr(end + 1);
    return !value.empty() && value[0] != '-' && is_plain_word(value);
}

}  // namespace

void check_sbatch_option(const std::string& option) {
    if (!is_one_option(option))
        throw InputError(fmt::format("--sbatch: must be one option of sbatch, as in --sbatch=--account=film (was '{}')",
                                     safe_text(option)));
    const std::string_view name = std::string_view(option).substr(0, end_of_name(option));
    if (name.starts_with("--"))
        check_long(name.substr(2));
    else
        check_short(std::string_view(option).substr(1));
}

std::string sbatch_line(const std::string& option) {
    const std::size_t end = end_of_name(option);
    if (end == option.size() || option[end] == ' ') return option;
    return fmt::format("{}={}", option.substr(0, end), sbatch_value(std::string_view(option).substr(end + 1)));
}

std::string sbatch_value(std::string_view text) {
    if (is_plain_word(text)) return std::string(text);
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "\"";
}

}  // namespace tumble
