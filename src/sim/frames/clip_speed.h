// Clips whose speed changes ([[speed]]): the times of their frames, in whole steps of the simulation.
#pragma once

#include "scene/description/description.h"
#include "sim/frames/clip_timing.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tumble {

struct ClipSpeed {
    std::vector<SpeedKeyframe> keys;  // with times, in their order: no impacts
    std::vector<std::string>
        missing;  // the bodies of impacts that do not happen, as "A and B"; their keys are left out
};

/// The timing of a simulation that has the frames of such a clip on its steps: its frames are the intervals of the
/// shutter at the speed before the first keyframe. The step is the scene's, or divided so that the slowest frames have
/// several steps. Throws InputError for too many steps.
FrameTiming timing_at_speeds(const SceneDescription& scene, double speed, const Shutter& shutter);

/// Finds the times of impacts in a run of that timing, as far as the last one. Precondition: the scene has keyframes.
ClipSpeed clip_speed(const SceneDescription& scene, const FrameTiming& timing);

/// The steps of each interval of the shutter, by frame; a frame of no steps stands still. The first entry belongs to
/// frame 0, at time 0; the last frame is at or before the scene's duration. Throws InputError for too many frames.
std::vector<int> steps_of_frames(const SceneDescription& scene, const std::vector<SpeedKeyframe>& keys, double speed,
                                 const FrameTiming& timing, const Shutter& shutter);

/// The times of the frames of such a clip at the scene's own rate, s: those of steps_of_frames(), without a shutter.
std::vector<double> frame_times(const SceneDescription& scene);

}  // namespace tumble
