// The simulation of one panel of a clip, frame by frame: the poses to draw, and the shapes over them.
#pragma once

#include "app/workers/motion_blur_frame.h"
#include "overlay/overlay_builder.h"
#include "sim/frames/frame_sequence.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// The simulation of a panel.
struct PanelSource {
    World& world;                       // its frames are the intervals of the shutter
    std::int64_t end = 0;               // one after its last frame; later frames of the clip repeat that
    OverlayBuilder* overlay = nullptr;  // of the shapes over it, or null
};

class PanelRun {
public:
    PanelRun(const PanelSource& source, Shutter shutter);

    /// The poses of a frame. Frames are given in order; those from the end on are its last one, with a single sample.
    PanelPoses next(std::int64_t frame);
    bool runs(std::int64_t frame) const { return frame < end_; }
    /// The overlay of that frame as bytes; none without one.
    const std::vector<std::byte>& shapes() const { return shapes_; }
    /// The first moment of the frame after the last one given.
    Snapshot next_start() { return sequence_.next_start(); }
    /// Of the first moment of the last frame given; null unless the world records them.
    const ContactRecords* records() const { return sequence_.records(); }

    /// Brings the world to the start of the frame that next() gives next.
    void reach_next() { sequence_.reach_next(); }
    World& world() { return world_; }

    /// The state before the next frame is given. Precondition: reach_next().
    std::vector<std::byte> save() const;
    /// Goes on from such a state, which is that before `frame`, or for a frame at or after the end before the last one.
    /// Precondition: no frame has been given. Throws InputError where the bytes are not of such a state.
    void restore(std::span<const std::byte> state, std::int64_t frame);

private:
    World& world_;
    FrameSequence sequence_;
    std::int64_t end_;
    OverlayBuilder* overlay_;
    PanelPoses last_;                // a single sample, once the frames have ended
    std::vector<std::byte> shapes_;  // of the last frame: OverlayFrame as bytes
};

}  // namespace tumble
