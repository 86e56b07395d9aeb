#include "app/farm/farm_job.h"

#include "app/farm/shell_text.h"
#include "app/files/frame_folder.h"
#include "app/files/frame_set.h"
#include "app/resume/frame_identity.h"
#include "app/resume/kept_frames.h"
#include "core/check.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_bytes.h"
#include "output/png_reader.h"
#include "output/temporary_file.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <system_error>

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

FarmStatus find_farm_status(const FarmJob& job) {
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

namespace {

namespace fs = std::filesystem;
using FarmJson = nlohmann::ordered_json;

constexpr int farm_format = 1;

[[noreturn]] void refuse_farm_file(const fs::path& file, const std::string& fault) {
    throw InputError({file.string(), 0, 0}, fault + " (tumble farm slurm writes this file)");
}

FarmJob farm_job_of(const FarmJson& json, const fs::path& job_folder) {
    FarmJob job;
    job.folder = job_folder;
    job.clip = json.at("clip").get<std::string>();
    job.frames = json.at("frames").get<std::int64_t>();
    for (const FarmJson& part : json.at("parts"))
        job.parts.push_back({part.at(0).get<std::int64_t>(), part.at(1).get<std::int64_t>()});
    return job;
}

/// The parts must be the frames of a clip, in order and without gaps.
bool parts_are_whole(const FarmJob& job) {
    std::int64_t next = 0;
    for (const FarmPart& part : job.parts) {
        if (part.first != next || part.last < part.first || part.last >= job.frames) return false;
        next = part.last + 1;
    }
    return next == job.frames && !job.parts.empty() && job.frames <= limits::frames;
}

}  // namespace

fs::path farm_file(const fs::path& job_folder) { return job_folder / "farm.json"; }

void write_farm_file(const FarmJob& job) {
    FarmJson json;
    json["format"] = farm_format;
    json["clip"] = job.clip.string();
    json["frames"] = job.frames;
    json["parts"] = FarmJson::array();
    for (const FarmPart& part : job.parts) json["parts"].push_back({part.first, part.last});
    write_file(farm_file(job.folder), json.dump(-1, ' ', false, FarmJson::error_handler_t::replace) + "\n");
}

FarmJob read_farm_file(const fs::path& job_folder) {
    const fs::path file = farm_file(job_folder);
    const std::optional<std::string> text = bytes_of_file(file);
    if (!text) refuse_farm_file(file, "cannot be read: the folder holds no farm job");
    FarmJob job;
    try {
        const FarmJson json = FarmJson::parse(*text);
        if (json.at("format") != farm_format) refuse_farm_file(file, "is of another version of the program");
        job = farm_job_of(json, job_folder);
    } catch (const FarmJson::exception& error) {
        refuse_farm_file(file, fmt::format("is broken: {}", safe_text(error.what())));
    }
    if (!parts_are_whole(job)) refuse_farm_file(file, "is broken: its parts are not the frames of a clip");
    return job;
}

}  // namespace tumble
