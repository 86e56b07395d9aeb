// Job scripts for Slurm, in the job's folder: simulate.sh, frames.sh (an array of the parts), stitch.sh; settings.sh,
// which these read; submit.sh, which submits them. Each can be run by hand with bash, on any machine that has the
// program.
#pragma once

#include "app/farm/farm_job.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

struct SlurmSettings {
    std::string partition, time;  // empty: the cluster's default
    int cpus_per_task = 1;
    std::vector<std::string> more;  // options of sbatch, as in "--account=film"
};

/// Throws InputError for a folder or an option that Slurm's scripts cannot name.
void check_slurm(const FarmJob& job, const SlurmSettings& settings);

/// Makes the folder where it is missing, and writes the scripts. Precondition: check_slurm() has passed. Throws
/// RunError.
void write_slurm_scripts(const FarmJob& job, const SlurmSettings& settings);

/// The files that it writes, in the folder of the job.
std::vector<std::string> slurm_file_names();

std::filesystem::path submit_script(const std::filesystem::path& job_folder);

// An option that is passed on to sbatch, in a line of the scripts' settings.

/// Throws InputError for a text that is no single option, and for an option that the scripts set themselves, in any
/// spelling that sbatch reads: "-oX", "-QoX", "--out=X".
void check_sbatch_option(const std::string& option);

/// "--KEY=VALUE" or "-K VALUE" as sbatch reads it from a line of #SBATCH. Precondition: check_sbatch_option() has
/// passed.
std::string sbatch_line(const std::string& option);

/// A value in such a line, which sbatch takes apart by its own rules: '#' begins a comment, quotes are removed.
std::string sbatch_value(std::string_view text);

}  // namespace tumble
