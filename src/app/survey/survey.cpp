#include "app/survey/survey.h"

#include "core/error.h"
#include "sim/frames/frame_sequence.h"

#include <algorithm>

namespace tumble {

void survey(World& world, const SurveyFrames& frames, std::span<SurveyObserver* const> observers,
            Interrupt& interrupt) {
    const bool measures =
        std::ranges::any_of(observers, [](const SurveyObserver* observer) { return observer->needs_measurement(); });
    FrameSequence sequence(world, {frames.intervals, 1});
    for (std::int64_t n = 0; n < frames.count; ++n) {
        const Snapshot snapshot = sequence.next_start();
        const Measurement measurement = measures ? world.measure() : Measurement{};
        for (SurveyObserver* observer : observers) observer->see(snapshot, measurement, sequence.records());
        if (interrupt.pending()) throw Interrupted();
    }
}

}  // namespace tumble
