#include "sim/frames/frame_sequence.h"

#include <utility>

namespace tumble {

void FrameSequence::advance() {
    world_.advance_frame();
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
    for (; intervals_to_start_ > 0; --intervals_to_start_) advance();
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
    std::vector<Snapshot> samples{next_start()};
    while (int(samples.size()) < shutter_.blur_samples) {
        advance();
        --intervals_to_start_;
        samples.push_back(world_.snapshot());
    }
    return samples;
}

}  // namespace tumble
