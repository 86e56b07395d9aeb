#include "app/survey/survey.h"

#include "core/error.h"

#include <algorithm>

namespace tumble {

void survey(World& world, const SurveyFrames& frames, std::span<SurveyObserver* const> observers,
            Interrupt& interrupt) {
    const bool measures =
        std::ranges::any_of(observers, [](const SurveyObserver* observer) { return observer->needs_measurement(); });
    for (std::int64_t n = 0; n < frames.count; ++n) {
        if (n > 0)
            for (int i = 0; i < frames.intervals; ++i) world.advance_frame();
        const Snapshot snapshot = world.snapshot();
        const Measurement measurement = measures ? world.measure() : Measurement{};
        const ContactRecords* const records = world.records_contacts() ? &world.contact_records() : nullptr;
        for (SurveyObserver* observer : observers) observer->see(snapshot, measurement, records);
        if (interrupt.pending()) throw RunError("interrupted");
    }
}

}  // namespace tumble
