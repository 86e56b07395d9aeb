#include "app/farm/farm_job.h"

#include "app/files/frame_set.h"
#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>

namespace tumble {

namespace fs = std::filesystem;

std::string FarmPart::range() const { return fmt::format("{}-{}", first, last); }

std::vector<FarmPart> divide_frames(std::int64_t frames, std::int64_t length) {
    TUMBLE_CHECK_LE(1, std::min(frames, length));
    std::vector<FarmPart> divided;
    for (std::int64_t first = 0; first < frames; first += length)
        divided.push_back({first, std::min(first + length, frames) - 1});
    return divided;
}

std::string part_list(const std::vector<int>& numbers) {
    FrameSet parts;
    for (const int number : numbers) parts.append(number, number + 1);
    return parts.text(numbers.size());
}

fs::path frames_folder(const fs::path& job_folder) { return job_folder / "frames"; }

fs::path checkpoints_folder(const fs::path& job_folder) { return job_folder / "checkpoints"; }

}  // namespace tumble
