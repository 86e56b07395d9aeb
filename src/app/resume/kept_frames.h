// Frames of an earlier run that a run with --resume keeps.
#pragma once

#include "app/files/frame_set.h"
#include "app/resume/frame_identity.h"

#include <filesystem>

namespace tumble {

/// The kinds of files with a frame each.
enum class FrameFiles { pictures, aovs };

/// The manifest in a folder of such files: frames.json, aovs.json.
std::filesystem::path manifest_path(const std::filesystem::path& folder, FrameFiles kind);

/// Throws InputError if the manifest of the folder names another clip, with the differences and the remedy.
void require_same_clip(const std::filesystem::path& folder, FrameFiles kind, const FrameIdentity& identity);

/// The frames among `wanted` that are in the folder, whole and of this clip. Damaged and cut files are not among them.
/// Throws InputError for whole files of another clip.
FrameSet kept_frames(const std::filesystem::path& folder, FrameFiles kind, const FrameIdentity& identity,
                     const FrameSet& wanted);

}  // namespace tumble
