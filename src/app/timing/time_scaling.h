// Slow motion and speed-up: a clip at its frame rate, of a motion that is slower or faster than the scene's.
#pragma once

#include "scene/description/description.h"

namespace tumble {

inline constexpr double slowest_speed = 1e-3, fastest_speed = 1e3;

/// The timing of a simulation whose frames are speed / fps seconds of the scene's motion apart, for a clip of the scene's fps.
/// Time remains a whole number of steps. The step is the scene's where steps_per_frame * speed is a whole number (the motion
/// is then the same to the last bit), else the next smaller one that divides the frame. Throws InputError for too many frames.
FrameTiming timing_at_speed(const SceneDescription& scene, double speed);

/// The timing with `parts` frames in place of each (for the samples of a shutter). The step follows the same rule.
FrameTiming divided(const FrameTiming& timing, int parts);

}  // namespace tumble
