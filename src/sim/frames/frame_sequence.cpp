#include "sim/frames/frame_sequence.h"

#include <utility>

namespace tumble {

/// Keeps the impacts of the interval that ends now.
void FrameSequence::keep_impacts() {
    if (!world_.records_contacts()) return;
    const ContactRecords& records = world_.contact_records();
    for (ImpactRecord impact : records.impacts) {
        impact.struck_a += struck_.size();
        impact.struck_b += struck_.size();
        impacts_.push_back(impact);
    }
    struck_.insert(struck_.end(), records.struck.begin(), records.struck.end());
}

/// Steps of each interval of the last frame given, if the world has not the same number for all.
std::optional<int> FrameSequence::steps() const {
    const std::size_t frame = std::size_t(frames_) - 1;
    return frame < steps_.size() ? std::optional(steps_[frame]) : std::nullopt;
}

void FrameSequence::reach_next() {
    if (steps() == 0) intervals_to_start_ = 0;
    for (; intervals_to_start_ > 0; --intervals_to_start_) {
        world_.advance_frame(steps());
        keep_impacts();
    }
}

Snapshot FrameSequence::next_start() {
    reach_next();
    intervals_to_start_ = shutter_.intervals;
    ++frames_;
    if (world_.records_contacts()) {
        records_ = world_.contact_records();
        records_.impacts = std::exchange(impacts_, {});
        records_.struck = std::exchange(struck_, {});
    }
    return world_.snapshot();
}

std::vector<Snapshot> FrameSequence::next() {
    std::vector<Snapshot> moments{next_start()};
    if (shutter_.blur_samples == 1 || steps() == 0) return moments;
    for (int i = 0; i < shutter_.blur_samples; ++i, --intervals_to_start_) {
        moments.push_back(world_.advance_frame_by_middle(steps()));
        keep_impacts();
    }
    return moments;
}

}  // namespace tumble
