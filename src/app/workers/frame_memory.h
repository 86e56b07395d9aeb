// The memory that pictures surely take, known before anything is drawn: a run that cannot fit is refused, in place of a
// machine that swaps or a process that the system ends. What depends on the pictures (how well they compress) and on the
// bodies is not in it.
#pragma once

#include "app/workers/shared_frames.h"
#include "core/available_memory.h"
#include "output/video_format.h"
#include "scene/description/description.h"

#include <cstdint>
#include <optional>

namespace tumble {

/// What is made of how many pictures.
struct PictureWork {
    FrameOutputs forms;
    std::optional<VideoKind> clip;   // what the encoder makes
    std::int64_t frames = 1;
    int moments = 1;                 // of a frame: more with motion blur
};

struct PictureMemory {
    std::uint64_t worker = 0, encoder = 0;   // bytes: of each drawing process, of the ffmpeg program
    std::uint64_t total(int workers) const { return std::uint64_t(workers) * worker + encoder; }
};

PictureMemory picture_memory(const SceneDescription& scene, const PictureWork& work);

/// Bytes that the ffmpeg program takes for pictures of this size.
std::uint64_t encoder_memory(VideoKind kind, int width, int height);

/// Of so many workers, as many as there is memory for: pictures do not depend on their number. `own` bounds each process,
/// `shared` all together. Throws RunError where there is none for one.
int workers_that_fit(const SceneDescription& scene, const PictureWork& work, int workers,
                     const AvailableMemory& own = available_memory(), const AvailableMemory& shared = shared_memory());

}  // namespace tumble
