#include "app/timing/time_scaling.h"

#include "core/error.h"
#include "core/rounding.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {

namespace {

/// Number of steps, each at most as long as the scene's, in `frames` frames of the scene.
double steps_in(const SceneDescription& scene, double frames) {
    return std::max(1.0, std::ceil(whole_where_meant(scene.simulation.steps_per_frame * frames)));
}

}  // namespace

void divide_frames(SceneDescription& scene, int parts) {
    scene.simulation.steps_per_frame = int(steps_in(scene, 1.0 / parts));
    scene.output.fps *= parts;
}

void apply_speed(SceneDescription& scene, double speed) {
    if (speed == 1.0) return;
    const double fps = scene.output.fps / speed;
    const double frames = scene.simulation.duration * fps;
    const double steps = steps_in(scene, speed);
    if (frames > double(limits::frames))
        throw InputError(fmt::format("--speed: at {:g} the clip has more than {} frames", speed, limits::frames));
    if (steps > double(limits::steps_per_frame))
        throw InputError(fmt::format("--speed: at {:g} a frame takes more than {} steps", speed, limits::steps_per_frame));
    scene.output.fps = fps;
    scene.simulation.steps_per_frame = int(steps);
}

}  // namespace tumble
