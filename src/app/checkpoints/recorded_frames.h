// The frames of a panel from the motion in a folder of checkpoints, instead of a simulation.
#pragma once

#include "app/checkpoints/checkpoint_folder.h"
#include "app/checkpoints/frame_record.h"
#include "app/survey/survey.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

class RecordedFrames : public SimulatedFrames {
public:
    /// From this frame on. The folder must outlive it. Throws InputError for a file that is damaged; the other members
    /// throw RunError.
    RecordedFrames(const CheckpointReading& folder, std::size_t panel, std::size_t bodies, std::int64_t frame);

    std::vector<Snapshot> next() override;
    Snapshot next_start() override { return take().samples.front(); }
    const ContactRecords* records() const override { return records_ ? &*records_ : nullptr; }

private:
    RecordedFrame take();

    const CheckpointReading& folder_;
    std::size_t panel_, bodies_;
    std::int64_t interval_;  // its first frame
    FrameReader reader_;
    std::optional<ContactRecords> records_;
};

}  // namespace tumble
