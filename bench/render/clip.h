// The poses of a clip, simulated beforehand, so that rendering is measured alone.
#pragma once

#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <vector>

namespace tumble::bench {

/// Frames `first` to before `end` of the scene, as they are drawn (src/render/scene/pose_filter.h).
std::vector<Snapshot> drawn_clip(const SceneDescription& scene, int first, int end);

}  // namespace tumble::bench
