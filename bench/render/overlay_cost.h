// The cost of overlays beside that of the frames that they are drawn over, in one run.
#pragma once

#include "scene/description/description.h"

namespace tumble::bench {

/// Draws frames `first` to before `end` with the overlays of the scene and prints the CPU ms of each part. Frames are
/// drawn as for a clip: changed regions only, or everything (`full`).
void measure_overlay(const SceneDescription& scene, int first, int end, bool full);

}  // namespace tumble::bench
