#include "app/farm/farm_job.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_bytes.h"
#include "output/temporary_file.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace tumble {
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
