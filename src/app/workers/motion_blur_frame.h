// The poses of a frame, which is the mean, in linear light, of images at several times while the shutter is open.
#pragma once

#include "render/aov/aov_renderer.h"
#include "sim/snapshot/snapshot.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

/// Content of one frame: its blur samples in order; a single one without motion blur. Samples that are not requested,
/// or that equal those of the previous frame, are omitted.
struct MotionBlurFrame {
    std::int64_t frame = 0;
    std::vector<Snapshot> blur_samples;
    std::optional<AovPoses> aovs;  // the true poses at the frame's own time, when the shutter opens
};

}  // namespace tumble
