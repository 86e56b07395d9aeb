// The simulation as a sequence of frames, each with its samples while the shutter is open.
#pragma once

#include "sim/frames/clip_timing.h"
#include "sim/world.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

class FrameSequence {
public:
    /// `steps`: of each interval of the shutter, by frame (clip_speed.h); empty: the world's frames are the intervals
    /// (see divided()). It must outlive the sequence. Precondition: the world is at time 0.
    FrameSequence(World& world, Shutter shutter, std::span<const int> steps = {})
        : world_(world), shutter_(shutter), steps_(steps) {}

    /// The moments of the next frame in order; the first call: of frame 0. First its own, when the shutter opens; with
    /// motion blur the samples follow, each at the middle of its interval. The frame is simulated only as far as its
    /// shutter is open.
    std::vector<Snapshot> next();

    /// The first moment of the next frame.
    Snapshot next_start();

    /// Brings the world to the start of the next frame, without taking it: the time of a checkpoint.
    void reach_next();

    /// Records of the world at the start of the last frame, if it records contacts, otherwise null: the impacts since
    /// the frame before, and the contacts of the last interval of the shutter.
    const ContactRecords* records() const { return world_.records_contacts() ? &records_ : nullptr; }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [world, shutter, steps, frames, intervals_to_start, records, impacts, struck] = self;
        archive.rebuilt(world, shutter, steps);
        archive.count(frames);
        archive.between(0, intervals_to_start, shutter.intervals);
        archive.keep(records, impacts, struck);
        archive.require([&] { return names_struck(self.impacts_, self.struck_.size()); });
    }

private:
    void keep_impacts();
    std::optional<int> steps() const;

    World& world_;
    Shutter shutter_;
    std::span<const int> steps_;
    std::int64_t frames_ = 0;     // given
    int intervals_to_start_ = 0;  // from the world's time to the start of the next frame
    ContactRecords records_;
    std::vector<ImpactRecord> impacts_;  // since the start of the last frame
    std::vector<StruckBody> struck_;     // of these
};

}  // namespace tumble
