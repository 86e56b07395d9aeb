// The frames of a clip: slow motion, speed-up and motion blur.
#pragma once

#include "scene.h"
#include "snapshot.h"

#include <cstdint>
#include <memory>
#include <vector>

TUMBLE_BEGIN

/// The options --speed, --shutter and --blur-samples of `tumble render`.
struct ClipTiming {
    double speed = 1.0;    // of the motion in the clip, 0.001 to 1000: 0.25 is slow motion
    double shutter = 0.0;  // degrees, 0 to 360: open over this part of each frame (360: all of it); 0: no motion blur
    int blur_samples = 8;  // moments of a frame while the shutter is open, 2 to 64
};

/// Simulates the frames of a clip in order. Frame n shows the scene at the time n * speed / fps, and with a shutter
/// also at later moments. The step is that of the scene where it divides the time between two moments; otherwise it is
/// the next shorter one that does. Not for several threads at once.
class FrameSequence {
public:
    /// Makes a World of that many threads. Throws Error (input) with the field of the timing, or where the clip has
    /// more than 10,000,000 frames.
    explicit FrameSequence(const Scene& scene, const ClipTiming& timing = {}, int threads = 1);
    ~FrameSequence();
    FrameSequence(FrameSequence&&) noexcept;
    FrameSequence& operator=(FrameSequence&&) noexcept;

    /// Frames of the clip; the last one shows the scene at or before its duration.
    std::int64_t frame_count() const;

    /// The next frame, from frame 0 on: one snapshot, or `blur_samples` of them in order of time with a shutter, which
    /// is open for as many equal parts: each is the middle of one. Their `frame` is its number. There is no last one:
    /// motion AOVs of a clip's last frame need the frame after it. Throws Error (run) with the step and the body when a
    /// state is not finite; the sequence cannot go on after that.
    std::vector<Snapshot> next();

private:
    struct State;
    std::unique_ptr<State> state_;
};

TUMBLE_END
