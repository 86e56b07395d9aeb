#include "app/frame_range.h"

#include "core/error.h"

#include <fmt/format.h>

#include <cmath>

namespace tumble {

FrameRange frames_from(const SceneDescription& scene, double start) {
    const std::int64_t end = scene.frame_count();
    const double last = double(end - 1) / scene.output.fps;
    // A start that is a frame's own time must not miss it by rounding.
    const double first = std::ceil(start * scene.output.fps * (1.0 - 1e-12));
    if (!(first < double(end)))
        throw InputError(fmt::format("--start: the scene's last frame is at {:g} s ({:g} was given)", last, start));
    return {std::int64_t(first), end};
}

}  // namespace tumble
