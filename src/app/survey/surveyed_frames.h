// The frames of a survey, kept in memory for the drawing: the motion is simulated once.
#pragma once

#include "app/survey/simulated_frames.h"
#include "app/survey/survey.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace tumble {

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
