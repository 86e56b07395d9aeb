#include "app/pipeline/frame_range.h"

#include "core/error.h"
#include "core/rounding.h"

#include <fmt/format.h>

#include <cmath>

namespace tumble {

FrameRange frames_from(const FrameTiming& timing, double duration, double start) {
    const std::int64_t end = timing.frame_count(duration);
    const double last = double(end - 1) / timing.fps;
    const double first = std::ceil(rounded_if_nearly_whole(start * timing.fps));
    if (!(first < double(end)))
        throw InputError(fmt::format("--start: the scene's last frame is at {:g} s ({:g} was given)", last, start));
    return {std::int64_t(first), end};
}

}  // namespace tumble
