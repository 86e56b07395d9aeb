// A run of the simulation before the drawing, for plots of the whole clip and for scales that hold for all frames.
#pragma once

#include "app/threads/interrupt.h"
#include "quantities/survey_frame.h"
#include "sim/snapshot/contact_records.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// Frames of the clip, each as many frames of the world as the shutter has intervals.
struct SurveyFrames {
    std::int64_t count = 1;
    int intervals = 1;
    std::span<const int> steps = {};  // of each interval, by frame, where the speed changes (frame_sequence.h)
};

/// Runs the world from its start and shows each frame to all observers. Throws RunError after an interrupt.
void survey(World& world, const SurveyFrames& frames, std::span<SurveyObserver* const> observers, Interrupt& interrupt);

// -- Frames of a panel that are simulated already.

class SimulatedFrames {
public:
    virtual ~SimulatedFrames() = default;
    // As of FrameSequence.
    virtual std::vector<Snapshot> next() = 0;
    virtual Snapshot next_start() = 0;
    virtual const ContactRecords* records() const = 0;
};

// -- The frames of a survey, kept in memory for the drawing: the motion is simulated once.

class SurveyedFrames : public SimulatedFrames, public SurveyObserver {
public:
    /// `limit`: bytes; frames that need more are not kept.
    explicit SurveyedFrames(std::size_t limit) : limit_(limit) {}

    void see(const Snapshot& snapshot, const Survey& survey, const ContactRecords* records) override;
    /// True if all frames are there.
    bool whole() const { return bytes_ <= limit_ && !frames_.empty(); }

    /// Takes the frames, in order. Precondition: whole(), and a frame that is left.
    std::vector<Snapshot> next() override;
    Snapshot next_start() override { return next().front(); }
    const ContactRecords* records() const override { return records_ ? &*records_ : nullptr; }

private:
    struct Kept {
        Snapshot snapshot;
        std::optional<ContactRecords> records;
    };
    std::size_t limit_, bytes_ = 0;
    std::deque<Kept> frames_;
    std::optional<ContactRecords> records_;  // of the last frame taken
};

}  // namespace tumble
