// Which frames of a scene are drawn: all, or those from a moment on. What comes before is simulated, so that frame n is the
// same whichever frame was the first.
#pragma once

#include "scene/description/description.h"

#include <cstdint>

namespace tumble {

struct FrameRange {
    std::int64_t first = 0, end = 0;   // by their numbers in the scene, which begin with 0
    std::int64_t count() const { return end - first; }
};

/// Those at `start` or later (s), of a scene of that duration (s). Throws InputError where there are none.
FrameRange frames_from(const FrameTiming& timing, double duration, double start);

}  // namespace tumble
