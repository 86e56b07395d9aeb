// A run of the simulation before the drawing, for plots of the whole clip and for scales that hold for all frames.
#pragma once

#include "app/threads/interrupt.h"
#include "quantities/survey_frame.h"

#include <cstdint>
#include <span>

namespace tumble {

/// Frames of the clip, each as many frames of the world as the shutter has intervals.
struct SurveyFrames {
    std::int64_t count = 1;
    int intervals = 1;
    std::span<const int> steps = {};  // of each interval, by frame, where the speed changes (frame_sequence.h)
};

/// Runs the world from its start and shows each frame to all observers. Throws RunError after an interrupt.
void survey(World& world, const SurveyFrames& frames, std::span<SurveyObserver* const> observers, Interrupt& interrupt);

}  // namespace tumble
