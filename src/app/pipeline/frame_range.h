// The frames of a scene that are drawn: all, or those from a time on. Earlier frames are simulated, so that frame n
// does not depend on the first drawn frame.
#pragma once

#include "scene/description/description.h"

#include <cstdint>

namespace tumble {

struct FrameRange {
    std::int64_t first = 0, end = 0;  // frame numbers in the scene, from 0
    std::int64_t count() const { return end - first; }
};

/// Those at `start` or later (s), of a scene of that duration (s). Throws InputError where there are none.
FrameRange frames_from(const FrameTiming& timing, double duration, double start);

}  // namespace tumble
