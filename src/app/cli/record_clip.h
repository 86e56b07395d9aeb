// Simulates a clip as `render` does, without drawing it, and writes checkpoints from which its parts can be drawn.
#pragma once

#include "app/checkpoints/checkpoint_folder.h"
#include "app/clip/render_scenes.h"
#include "sim/frames/clip_timing.h"

#include <cstdint>
#include <functional>

namespace tumble {

struct ClipRecording {
    Shutter shutter;
    std::int64_t every = 1;  // frames between two checkpoints
    int threads = 1;
    bool records = false;  // of contacts, whether or not the clip shows them
    bool motion = true;    // is written too: parts need no simulation
    /// Called with each frame of the first panel and its world at the frame's first moment.
    std::function<void(std::int64_t frame, const World& world)> each;
};

/// Surveys the scenes on the way. Throws what `each` throws, and RunError if a file cannot be written.
void record_clip(RenderScenes& scenes, const ClipRecording& recording, CheckpointWriting& checkpoints);

}  // namespace tumble
