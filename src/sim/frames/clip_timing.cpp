#include "sim/frames/clip_timing.h"

#include "core/error.h"
#include "core/frame_rate.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The number of steps, each at most as long as the timing's, in a frame as long as `frames` of its frames.
double steps_in(const FrameTiming& timing, double frames) {
    return std::max(1.0, std::ceil(rounded_if_nearly_whole(timing.steps_per_frame * frames)));
}

}  // namespace

FrameTiming divided(const FrameTiming& timing, int parts) {
    return {timing.fps * parts, int(steps_in(timing, 1.0 / parts))};
}

FrameTiming timing_at_speed(const SceneDescription& scene, double speed) {
    const FrameTiming timing = scene.timing();
    if (speed == 1.0) return timing;
    const double fps = timing.fps / speed;
    const double steps = steps_in(timing, speed);
    if (scene.simulation.duration * fps > double(limits::frames))
        throw InputError(fmt::format("--speed: at {:g} the clip has more than {} frames", speed, limits::frames));
    if (steps > double(limits::steps_per_frame))
        throw InputError(
            fmt::format("--speed: at {:g} a frame takes more than {} steps", speed, limits::steps_per_frame));
    return {fps, int(steps)};
}

Shutter Shutter::of(double degrees, int blur_samples) {
    if (degrees <= 0.0 || blur_samples <= 1) return {};
    return {std::max(blur_samples, int(std::lround(360.0 / degrees * blur_samples))), blur_samples};
}

}  // namespace tumble
