#include "app/speed.h"

#include "core/error.h"
#include "scene/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble {

void apply_speed(SceneDescription& scene, double speed) {
    if (speed == 1.0) return;
    const double fps = scene.output.fps / speed;
    const double frames = scene.simulation.duration * fps;
    const double steps = std::max(1.0, std::ceil(scene.simulation.steps_per_frame * speed * (1.0 - 1e-12)));
    if (frames > double(limits::frames))
        throw InputError(fmt::format("--speed: at {:g} the clip has more than {} frames", speed, limits::frames));
    if (steps > double(limits::steps_per_frame))
        throw InputError(fmt::format("--speed: at {:g} a frame takes more than {} steps", speed, limits::steps_per_frame));
    scene.output.fps = fps;
    scene.simulation.steps_per_frame = int(steps);
}

}  // namespace tumble
