#include "sim/frames/frame_sequence.h"

namespace tumble {

Snapshot FrameSequence::next_start() {
    for (; parts_to_start_ > 0; --parts_to_start_) world_.advance_frame();
    parts_to_start_ = shutter_.parts;
    return world_.snapshot();
}

std::vector<Snapshot> FrameSequence::next() {
    std::vector<Snapshot> moments{next_start()};
    while (int(moments.size()) < shutter_.moments) {
        world_.advance_frame();
        --parts_to_start_;
        moments.push_back(world_.snapshot());
    }
    return moments;
}

}  // namespace tumble
