#include "sim/frames/frame_sequence.h"

namespace tumble {

Snapshot FrameSequence::next_start() {
    for (; intervals_to_start_ > 0; --intervals_to_start_) world_.advance_frame();
    intervals_to_start_ = shutter_.intervals;
    return world_.snapshot();
}

std::vector<Snapshot> FrameSequence::next() {
    std::vector<Snapshot> samples{next_start()};
    while (int(samples.size()) < shutter_.blur_samples) {
        world_.advance_frame();
        --intervals_to_start_;
        samples.push_back(world_.snapshot());
    }
    return samples;
}

}  // namespace tumble
