// The simulation of one panel of a clip, frame by frame: the poses to draw, and the shapes over them.
#pragma once

#include "app/checkpoints/clip_state.h"
#include "app/survey/survey.h"
#include "app/workers/motion_blur_frame.h"
#include "overlay/overlay_builder.h"
#include "sim/frames/frame_sequence.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// The motion of a panel: simulated, or recorded.
struct PanelSource {
    World* world = nullptr;                       // its frames are the intervals of the shutter
    std::int64_t end = 0;                         // one after its last frame; later frames of the clip repeat that
    OverlayBuilder* overlay = nullptr;            // of the shapes over it, or null
    SimulatedFrames* recorded = nullptr;          // instead of a world
    std::size_t bodies = 0;                       // of the scene
    std::vector<SurveyObserver*> observers = {};  // see every simulated frame
    std::span<const int> steps = {};              // of the world's intervals, by frame (frame_sequence.h)
};

class PanelRun {
public:
    PanelRun(const PanelSource& source, Shutter shutter);

    /// The poses of a frame. Frames are given in order; frames from the end on repeat the last one, with a single
    /// sample.
    PanelPoses next(std::int64_t frame);
    bool runs(std::int64_t frame) const { return frame < source_.end; }
    /// The overlay of that frame as bytes; none without one.
    const std::vector<std::byte>& shapes() const { return shapes_; }
    /// The first moment of the frame after the last one given.
    Snapshot next_start();
    /// Records of the first moment of the last frame given; null unless they are recorded.
    const ContactRecords* records() const;

    /// Brings the world to the start of the frame that next() gives next.
    void reach_next() { sequence_->reach_next(); }

    /// The state before the next frame is given, without the poses of drawing. Preconditions: a world, reach_next().
    PanelState save() const;
    /// Goes on from the state before `frame`; for a frame at or after the end, from that before the last one. Recorded
    /// frames must begin there. Precondition: no frame has been given. Throws InputError where the bytes are not of
    /// such a state.
    void restore(const PanelState& state, std::int64_t frame);
    /// The frame from which recorded frames must begin, to go on from the state before `frame`.
    static std::int64_t first_recorded(std::int64_t frame, std::int64_t end) { return std::min(frame, end - 1); }

private:
    PanelSource source_;
    std::optional<FrameSequence> sequence_;  // of a world
    PanelPoses last_;                        // a single sample, once the frames have ended
    std::vector<std::byte> shapes_;          // of the last frame: OverlayFrame as bytes
};

}  // namespace tumble
