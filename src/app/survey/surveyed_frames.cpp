#include "app/survey/surveyed_frames.h"

#include "core/check.h"

#include <utility>

namespace tumble {
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
