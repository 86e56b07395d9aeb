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

void FrameSequence::reach_next() {
    for (; intervals_to_start_ > 0; --intervals_to_start_) {
        world_.advance_frame();
        keep_impacts();
    }
}

Snapshot FrameSequence::next_start() {
    reach_next();
    intervals_to_start_ = shutter_.intervals;
    if (world_.records_contacts()) {
        records_ = world_.contact_records();
        records_.impacts = std::exchange(impacts_, {});
        records_.struck = std::exchange(struck_, {});
    }
    return world_.snapshot();
}

std::vector<Snapshot> FrameSequence::next() {
    std::vector<Snapshot> moments{next_start()};
    if (shutter_.blur_samples == 1) return moments;
    for (int i = 0; i < shutter_.blur_samples; ++i, --intervals_to_start_) {
        moments.push_back(world_.advance_frame_by_middle());
        keep_impacts();
    }
    return moments;
}

}  // namespace tumble
