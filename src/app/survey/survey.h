// A run of the simulation before the drawing, for plots of the whole clip and for scales that hold for all frames.
#pragma once

#include "app/threads/interrupt.h"
#include "sim/snapshot/report.h"
#include "sim/snapshot/snapshot.h"
#include "sim/world.h"

#include <cstdint>
#include <span>

namespace tumble {

/// Sees every frame of a run in order.
class SurveyObserver {
public:
    virtual ~SurveyObserver() = default;
    virtual bool needs_measurement() const { return false; }
    /// The measurement is empty unless an observer needs it. `records`: of the frame (frame_sequence.h), if the world records contacts, else null.
    virtual void see(const Snapshot& snapshot, const Measurement& measurement, const ContactRecords* records) = 0;
};

/// Frames of the clip, each as many frames of the world as the shutter has intervals.
struct SurveyFrames {
    std::int64_t count = 1;
    int intervals = 1;
};

/// Runs the world from its start and shows each frame to all observers. Throws RunError after an interrupt.
void survey(World& world, const SurveyFrames& frames, std::span<SurveyObserver* const> observers, Interrupt& interrupt);

}  // namespace tumble
