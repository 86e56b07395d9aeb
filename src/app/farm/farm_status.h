// Which parts of a farm's clip are drawn.
#pragma once

#include "app/farm/farm_job.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// The missing and damaged frames of each part.
struct FarmStatus {
    std::vector<std::vector<std::int64_t>> missing;  // by part
    std::int64_t drawn = 0;                          // frames
    std::vector<int> incomplete() const;             // numbers of parts, from 1
};

/// Looks at each frame's file. Throws RunError if the folder cannot be read.
FarmStatus look_at_farm(const FarmJob& job);

/// The state as text of several lines, with the commands that draw the missing parts.
std::string status_text(const FarmJob& job, const FarmStatus& status);

}  // namespace tumble
