// The drawn motion of a panel as bytes: the snapshots of its frames, each as the bodies that differ from the snapshot
// before it. A part of a clip is drawn from them without simulating its frames again.
#pragma once

#include "sim/checkpoint/archive.h"
#include "sim/snapshot/contact_records.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

/// poses: all that pictures need; states: velocities, momenta, sleep and records of contacts too, for overlays.
enum class MotionDetail : std::uint8_t { poses, states };

struct RecordedFrame {
    std::vector<Snapshot> samples;  // while the shutter is open
    std::optional<ContactRecords> records;
};

class FrameRecorder {
public:
    explicit FrameRecorder(MotionDetail detail) : detail_(detail) {}

    /// `records`: of the frame, or null.
    void add(const std::vector<Snapshot>& samples, const ContactRecords* records);
    /// Bytes of the frames since the last take().
    std::size_t size() const { return writer_.bytes().size(); }
    /// The frames since the last call, complete in themselves.
    std::vector<std::byte> take();

private:
    void add(const Snapshot& snapshot);
    bool differs(const BodyState& a, const BodyState& b) const;

    MotionDetail detail_;
    CheckpointWriter writer_;
    bool begun_ = false;
    std::vector<BodyState> last_;
};

/// Throws InputError where the bytes are not of a recorder of so many bodies.
class FrameReader {
public:
    FrameReader(std::vector<std::byte> bytes, std::size_t bodies);

    bool at_end() const { return reader_.at_end(); }
    RecordedFrame next();

private:
    Snapshot next_snapshot();

    std::vector<std::byte> bytes_;
    CheckpointReader reader_;
    MotionDetail detail_ = MotionDetail::poses;
    bool begun_ = false;  // the first snapshot holds all bodies
    std::vector<BodyState> last_;
};

}  // namespace tumble
