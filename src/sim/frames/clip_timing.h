// Slow motion, speed-up and motion blur: the times that the frames of a clip show.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/limits.h"

namespace tumble {

inline constexpr double slowest_speed = limits::clip_speed.min, fastest_speed = limits::clip_speed.max;
inline constexpr int most_blur_samples = 64;

/// The timing of a simulation whose frames are speed / fps seconds of the scene's motion apart, for a clip of the
/// scene's fps. Time remains a whole number of steps. The step is the scene's where steps_per_frame * speed is a whole
/// number (the motion is then the same to the last bit), otherwise the next smaller one that divides the frame. Throws
/// InputError for too many frames.
FrameTiming timing_at_speed(const SceneDescription& scene, double speed);

/// The timing with `parts` frames instead of each (for the samples of a shutter). The step follows the same rule.
FrameTiming divided(const FrameTiming& timing, int parts);

/// Each frame is simulated in equal intervals; while the shutter is open, a sample is at the middle of each.
struct Shutter {
    int intervals = 1, blur_samples = 1;

    /// A shutter of `degrees` (360: a whole frame) with that many samples; 0 degrees: a single one. The number of
    /// intervals is whole, so that time stays a whole number of steps: the opening is rounded to the nearest possible
    /// one (a half and a whole frame are exact).
    static Shutter of(double degrees, int blur_samples);
};

}  // namespace tumble
