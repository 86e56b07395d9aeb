// The record of a finished sample: a line of JSON, which is in the sample's folder and in the manifest.
#pragma once

#include "app/sweep/sample_folder.h"
#include "app/sweep/sweep_sample.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Figures of the run: the same for each run of the sample.
struct SampleFigures {
    std::int64_t frames = 0, drawn = 0;  // drawn: that differ from the one before
    std::int64_t bodies = 0;
    int width = 0, height = 0;  // pixels
    double fps = 0.0, duration = 0.0;
};

struct SampleRecord {
    SweepSample sample;
    std::string scene_hash;
    std::string identity;  // of all that decides the bytes: see identity_of()
    SampleFigures figures;
    std::vector<SampleFile> files;
};

/// A line without a line break.
std::string record_text(const SweepPlan& plan, const SampleRecord& record);
/// The line of a sample that failed.
std::string failure_text(const SweepPlan& plan, const SweepSample& sample, const std::string& reason);

/// The identity and files in the record of a folder; empty if there is none, or a broken one.
struct KnownRecord {
    std::string text, identity;
    std::vector<SampleFile> files;
};
std::optional<KnownRecord> read_sample_record(const std::filesystem::path& folder);

/// Differs where the files or the record of the sample would: by the version, the scene, the values and the settings.
std::string identity_of(const SweepPlan& plan, const SweepSample& sample, const std::string& scene_hash);

}  // namespace tumble
