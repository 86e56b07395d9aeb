#include "app/timing/frame_range.h"

#include "core/error.h"
#include "core/rounding.h"

#include <fmt/format.h>

#include <cmath>

namespace tumble {

FrameRange frames_from(const SceneDescription& scene, double start) {
    const std::int64_t end = scene.frame_count();
    const double last = double(end - 1) / scene.output.fps;
    const double first = std::ceil(whole_where_meant(start * scene.output.fps));
    if (!(first < double(end)))
        throw InputError(fmt::format("--start: the scene's last frame is at {:g} s ({:g} was given)", last, start));
    return {std::int64_t(first), end};
}

}  // namespace tumble
