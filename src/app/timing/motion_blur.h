// Motion blur: a frame as the mean, in linear light, of pictures at several moments while the shutter is open.
#pragma once

#include "render/aov/aov_renderer.h"
#include "sim/snapshot/snapshot.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

/// What one frame shows: its moments, in order; a single one without motion blur. What is not asked for, or is the same
/// as in the frame before, is left out.
struct MotionBlurFrame {
    std::int64_t frame = 0;
    std::vector<Snapshot> moments;
    std::optional<AovPoses> aovs;   // the true poses at the frame's own time, where the shutter opens
};

/// Each frame is simulated in so many equal parts; the first `moments` of them begin while the shutter is open.
struct Shutter {
    int parts = 1, moments = 1;

    /// A shutter of so many degrees (of 360, a whole frame) sampled so often; 0 degrees: a moment. The parts are a
    /// whole number, so that time stays a whole number of steps: the shutter is open for the nearest that can be (a half or a
    /// whole frame exactly).
    static Shutter of(double degrees, int samples);
};

inline constexpr int most_blur_samples = 64;

}  // namespace tumble
