#include "app/survey/survey.h"

#include "core/error.h"
#include "sim/frames/frame_sequence.h"

namespace tumble {

void survey(World& world, const SurveyFrames& frames, std::span<SurveyObserver* const> observers,
            Interrupt& interrupt) {
    const SurveyNeeds needs = needs_of(observers);
    FrameSequence sequence(world, {frames.intervals, 1}, frames.steps);
    for (std::int64_t n = 0; n < frames.count; ++n) {
        const Snapshot snapshot = sequence.next_start();
        const Survey seen(world, needs);
        for (SurveyObserver* observer : observers) observer->see(snapshot, seen, sequence.records());
        if (interrupt.pending()) throw Interrupted();
    }
}

}  // namespace tumble
