// Which parts of a farm's clip are drawn.
#pragma once

#include "app/farm/farm_job.h"
#include "app/files/frame_set.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tumble {

/// The frames of each part that are missing, damaged, or of another clip.
struct FarmStatus {
    std::vector<FrameSet> missing;        // by part
    std::int64_t drawn = 0;               // frames
    std::vector<int> incomplete() const;  // numbers of parts, from 1
};

/// Reads each frame's file, and does not unpack it: the job that makes the clip does.
FarmStatus look_at_farm(const FarmJob& job);

/// The state as text of several lines, with the commands that draw the missing parts.
std::string status_text(const FarmJob& job, const FarmStatus& status);

}  // namespace tumble
