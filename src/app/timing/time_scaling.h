// Slow motion and speed-up: a clip at its frame rate, of a motion that passes faster or slower than in life.
#pragma once

#include "scene/description/description.h"

namespace tumble {

inline constexpr double slowest_speed = 1e-3, fastest_speed = 1e3;

/// Makes the scene's frames speed / fps seconds of its motion apart, in place of 1 / fps: its own rate becomes
/// fps / speed, while the clip keeps fps. Time stays a whole number of steps, so that nothing drifts. The step stays
/// as it is where steps_per_frame * speed is a whole number (the motion is then the same to the last bit), else it
/// becomes the next smaller one that divides the frame. Throws InputError where that makes too many frames.
void apply_speed(SceneDescription& scene, double speed);

/// Makes each frame of the scene so many (for the moments of a shutter); the step follows the same rule.
void divide_frames(SceneDescription& scene, int parts);

}  // namespace tumble
