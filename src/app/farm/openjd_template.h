// A job template of Open Job Description (2023-09) for render farms that read it, such as AWS Deadline Cloud: steps
// that simulate with checkpoints, draw the frames by chunks, and make the clip.
#pragma once

#include "app/farm/farm_job.h"

#include <filesystem>
#include <string>

namespace tumble {

/// The JSON text for a template at this path (absolute). Of the job: scene, meshes, clip (its name only), program,
/// frames, parts (the first one's length is that of a chunk) and options. Throws InputError for a value that a template
/// cannot hold.
std::string openjd_template(const FarmJob& job, const std::filesystem::path& file);

}  // namespace tumble
