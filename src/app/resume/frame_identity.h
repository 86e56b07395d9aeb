// The values that decide the pixels of a clip's frames: the program's version, the scenes and the settings of the
// drawing. A run goes on from the frames of another one if their marks are equal. The range of frames, the numbers of
// processes and threads, and the names of files do not count.
#pragma once

#include "app/composition/make_composition.h"
#include "app/files/named_values.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

struct FrameIdentity {
    struct Scene {
        std::string file;   // its name, for messages
        std::string label;  // of its panel
        std::string hash;   // scene_hash()
        NamedValues parts;  // scene_parts()
        friend bool operator==(const Scene&, const Scene&) = default;
    };
    std::string version;
    std::vector<Scene> scenes;
    NamedValues settings;
    std::int64_t frames = 0;  // of the whole clip; without effect on the mark
    double fps = 0.0;         // of the clip

    /// SHA-256 of all that decides pixels, 64 hexadecimal digits.
    std::string mark() const;
};

/// The identity of a clip of these scenes. `settings`: further ones than the scenes' own.
FrameIdentity identity_of(std::span<const ClipScene> scenes, const NamedValues& settings);

/// The differences of two clips, as a list for a message: "the camera of drop.toml, samples (4 there, 1 here)".
std::string differences(const FrameIdentity& there, const FrameIdentity& here);

/// As JSON, for a file beside the frames.
std::string manifest_text(const FrameIdentity& identity);

/// The identity in such a file; empty if it is missing or damaged.
std::optional<FrameIdentity> read_manifest(const std::filesystem::path& path);

}  // namespace tumble
