// A name for a scene by its content: scenes of equal hash have equal descriptions. Comments, the order of keys, the
// spelling of numbers and the paths of files do not matter; a mesh counts by its content, not by its name.
#pragma once

#include "scene/description/description.h"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// SHA-256 of the whole description, 64 hexadecimal digits. The name of the scene's file counts only where the clip
/// shows it: as the title overlay of a scene without a title.
std::string scene_hash(const SceneDescription& scene);

/// SHA-256 of the part that the motion depends on: simulation, frame rate, bodies without their appearance, forces and
/// wind. Equal for scenes that differ only in camera, light, colors, overlays, size or samples.
std::string motion_hash(const SceneDescription& scene);

/// Parts of a scene with a hash of each, to name the parts in which two scenes differ: "simulation", "camera" and the
/// like. The title counts where it is shown. Duration, size, frame rate and samples are not in them.
std::vector<std::pair<std::string, std::string>> scene_parts(const SceneDescription& scene);

}  // namespace tumble
