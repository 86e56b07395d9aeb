// Slow motion and speed-up: a clip at its frame rate whose motion is slower or faster than real time.
#pragma once

#include "scene/description/description.h"

namespace tumble {

inline constexpr double slowest_speed = 1e-3, fastest_speed = 1e3;

/// Sets the time between frames to speed / fps seconds of the scene's motion, instead of 1 / fps: the scene's rate
/// becomes fps / speed, and the clip keeps fps. Time stays an integer number of steps. If steps_per_frame * speed is an
/// integer, the step is unchanged (the motion is then the same to the last bit); else it becomes the next smaller one
/// that divides the frame. Throws InputError if that makes too many frames.
void apply_speed(SceneDescription& scene, double speed);

/// Divides each frame of the scene into `parts` (the moments of a shutter); the same rule applies to the step.
void divide_frames(SceneDescription& scene, int parts);

}  // namespace tumble
