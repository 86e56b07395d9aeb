#include "app/survey/survey.h"

#include "core/check.h"
#include "core/error.h"
#include "sim/frames/frame_sequence.h"

#include <utility>

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

namespace {

template <class Item>
std::size_t bytes_of(const std::vector<Item>& items) {
    return items.size() * sizeof(Item);
}

std::size_t bytes_of(const ContactRecords& records) {
    return sizeof records + bytes_of(records.impacts) + bytes_of(records.struck) + bytes_of(records.contacts) +
           bytes_of(records.loads) + bytes_of(records.joints);
}

}  // namespace

void SurveyedFrames::see(const Snapshot& snapshot, const Survey&, const ContactRecords* records) {
    bytes_ += sizeof(Kept) + bytes_of(snapshot.bodies) + (records != nullptr ? bytes_of(*records) : 0);
    if (bytes_ > limit_) {
        frames_.clear();
        return;
    }
    frames_.push_back({snapshot, records != nullptr ? std::optional(*records) : std::nullopt});
}

std::vector<Snapshot> SurveyedFrames::next() {
    TUMBLE_CHECK_GT(frames_.size(), 0u);
    Kept frame = std::move(frames_.front());
    frames_.pop_front();
    records_ = std::move(frame.records);
    return {std::move(frame.snapshot)};
}

}  // namespace tumble
