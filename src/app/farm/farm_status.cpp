#include "app/farm/farm_status.h"

#include "app/farm/shell_text.h"
#include "app/files/frame_folder.h"
#include "app/resume/frame_identity.h"
#include "app/resume/kept_frames.h"
#include "core/safe_text.h"
#include "output/png_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

/// Whole, and of the clip that the folder's manifest names.
bool is_drawn(const fs::path& frame, const std::optional<std::string>& mark) {
    const PngState state = state_of_png(frame);
    return state.whole && (!mark || state.mark == mark);
}

}  // namespace

std::vector<int> FarmStatus::incomplete() const {
    std::vector<int> numbers;
    for (std::size_t i = 0; i < missing.size(); ++i)
        if (!missing[i].empty()) numbers.push_back(int(i) + 1);
    return numbers;
}

FarmStatus look_at_farm(const FarmJob& job) {
    const fs::path folder = frames_folder(job.folder);
    const std::optional<FrameIdentity> manifest = read_manifest(manifest_path(folder, FrameFiles::pictures));
    const std::optional<std::string> mark = manifest ? std::optional(manifest->mark()) : std::nullopt;
    std::error_code ignored;
    const std::vector<std::int64_t> there =
        fs::is_directory(folder, ignored) ? frames_in(folder) : std::vector<std::int64_t>();
    const auto is_missing = [&](std::int64_t n) {
        return !std::ranges::binary_search(there, n) || !is_drawn(frame_path(folder, n), mark);
    };
    FarmStatus status;
    for (const FarmPart& part : job.parts) {
        status.missing.push_back(FrameSet(part.first, part.last + 1).where(is_missing));
        status.drawn += part.count() - status.missing.back().count();
    }
    return status;
}

std::string status_text(const FarmJob& job, const FarmStatus& status) {
    const std::vector<int> incomplete = status.incomplete();
    std::string text = fmt::format("{} of {} parts are complete, {} of {} frames\n",
                                   job.parts.size() - incomplete.size(), job.parts.size(), status.drawn, job.frames);
    for (const int number : incomplete) {
        const FarmPart& part = job.parts[std::size_t(number) - 1];
        const FrameSet& missing = status.missing[std::size_t(number) - 1];
        text += fmt::format("part {} (frames {}): {} of {} frames are missing: {}\n", number, part.range(),
                            missing.count(), part.count(), missing.text());
    }
    const auto script = [&](const char* name) {
        return safe_text(shell_word((job.folder / name).string()), path_text_bytes);
    };
    if (!incomplete.empty()) {
        text +=
            fmt::format("To draw them again on the cluster:  bash {} {}\n", script("submit.sh"), part_list(incomplete));
        text += fmt::format("or here:  for part in {}; do bash {} $part; done; bash {}\n", fmt::join(incomplete, " "),
                            script("frames.sh"), script("stitch.sh"));
        return text;
    }
    std::error_code ignored;
    if (fs::exists(job.clip, ignored))
        text += fmt::format("the clip is written: {}\n", safe_path(job.clip));
    else
        text += fmt::format("the clip is not written yet: bash {}\n", script("stitch.sh"));
    return text;
}

}  // namespace tumble
