// Motion blur: a frame as the mean, in linear light, of images at several moments while the shutter is open.
#pragma once

#include "render/aov/aov_renderer.h"
#include "sim/snapshot/snapshot.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

/// Content of one frame: its moments in order; a single one without motion blur. Moments that are not requested, or
/// that equal those of the previous frame, are omitted.
struct MotionBlurFrame {
    std::int64_t frame = 0;
    std::vector<Snapshot> moments;
    std::optional<AovPoses> aovs;  // the true poses at the frame's own time, when the shutter opens
};

/// Each frame is simulated in this many equal parts; the first `moments` of them begin while the shutter is open.
struct Shutter {
    int parts = 1, moments = 1;

    /// A shutter of `degrees` (360: a whole frame) with `samples` samples; 0 degrees: a single moment. The number of
    /// parts is an integer, so that time stays an integer number of steps: the opening is rounded to the nearest
    /// possible one (a half and a whole frame are exact).
    static Shutter of(double degrees, int samples);
};

inline constexpr int most_blur_samples = 64;

}  // namespace tumble
