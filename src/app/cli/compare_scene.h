// Draws the frames of a scene that a folder of references holds.
#pragma once

#include "app/cli/commands.h"
#include "compare/image_folder.h"

#include <filesystem>

namespace tumble {

/// The references that are frames (frame_000041.png), which a scene can be compared with. Throws InputError if there
/// are none.
NamedFiles frames_among(const NamedFiles& references, const std::filesystem::path& folder);

/// Draws the frames with the numbers of the references into `to`, at the size of the first of them. Frames beyond the
/// end of the scene are left out.
void draw_frames_of(const CompareCommand& command, const std::filesystem::path& scene, const NamedFiles& references,
                    const std::filesystem::path& to);

}  // namespace tumble
