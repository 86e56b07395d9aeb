// The AOV files aov_000000.npz, aov_000001.npz, ... and, with segmentation, the table of its numbers.
#pragma once

#include "output/temporary_file.h"
#include "render/aov/aov_kind.h"
#include "scene/description/description.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// The file of frame n. Six digits, more if needed.
std::filesystem::path aov_path(const std::filesystem::path& folder, std::int64_t frame);

/// The table of the numbers of a segmentation.
std::filesystem::path segmentation_table_path(const std::filesystem::path& folder);

/// The frame numbers of the files in a folder, ascending.
std::vector<std::int64_t> aovs_in(const std::filesystem::path& folder);

class AovFolder {
public:
    /// `folder` must exist (frame_folder.h). The scene must outlive it.
    AovFolder(const std::filesystem::path& folder, const SceneDescription& scene, const AovSet& aovs)
        : folder_(folder), scene_(scene), aovs_(aovs) {}

    const std::filesystem::path& path() const { return folder_; }
    const AovSet& aovs() const { return aovs_; }

    /// Describes the AOVs: the file is there before the first one has its name.
    void set_manifest(const std::filesystem::path& path, std::string text);
    /// Writes it and the table, if they are not there. Throws RunError.
    void write_manifest();

    /// Writes the file of one frame, without publishing it; table and manifest are there before the first one is
    /// published. Throws RunError naming the file.
    std::unique_ptr<TemporaryFile> write(std::int64_t frame, std::span<const std::byte> file);

    /// Writes the table of the numbers of a segmentation.
    void write_table() const;

private:
    std::filesystem::path folder_;
    const SceneDescription& scene_;
    AovSet aovs_;
    bool begun_ = false;
    std::filesystem::path manifest_path_;
    std::string manifest_;
};

}  // namespace tumble
