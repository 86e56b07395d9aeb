#include "app/checkpoints/recorded_frames.h"

#include "core/error.h"
#include "sim/checkpoint/archive.h"

#include <fmt/format.h>

#include <utility>

namespace tumble {

RecordedFrames::RecordedFrames(const CheckpointReading& folder, std::size_t panel, std::size_t bodies,
                               std::int64_t frame)
    : folder_(folder),
      panel_(panel),
      bodies_(bodies),
      interval_(folder.interval_of(frame)),
      reader_(folder.motion(interval_, panel), bodies) {
    for (std::int64_t n = interval_; n < frame; ++n) take();
}

RecordedFrame RecordedFrames::take() {
    if (reader_.at_end()) {
        const std::optional<std::int64_t> next = folder_.interval_after(interval_);
        if (!next) CheckpointReader::fail("ends before the clip does");
        interval_ = *next;
        try {
            reader_ = FrameReader(folder_.motion(interval_, panel_), bodies_);
        } catch (const InputError& error) {
            throw RunError(fmt::format("{}: {}", error.where().file, error.message()));  // frames are written by now
        }
    }
    return reader_.next();
}

std::vector<Snapshot> RecordedFrames::next() {
    RecordedFrame frame = take();
    records_ = std::move(frame.records);
    return std::move(frame.samples);
}

}  // namespace tumble
