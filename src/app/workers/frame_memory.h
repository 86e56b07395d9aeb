// Lower bound of the memory of frames, known before drawing. A run that cannot fit is refused, instead of a machine
// that swaps or a process that the system ends. Memory that depends on the content of the frames (compressed sizes) and
// on the bodies is not included.
#pragma once

#include "app/composition/composition.h"
#include "app/workers/shared_frames.h"
#include "core/available_memory.h"
#include "output/video_format.h"

#include <cstdint>
#include <optional>

namespace tumble {

/// The outputs, and the number of images per frame.
struct RenderWork {
    FrameOutputs outputs;
    std::optional<VideoKind> clip;  // kind of the clip, for the encoder
    std::int64_t frames = 1;
    int blur_samples = 1;  // per frame: above 1 with motion blur
    int encoders = 1;      // that run at once: 2 where a clip is written in segments
};

struct RenderMemory {
    std::uint64_t worker = 0, encoder = 0;  // bytes: of each render process, of the ffmpeg program
    std::uint64_t total(int workers) const { return std::uint64_t(workers) * worker + encoder; }
};

RenderMemory render_memory(const Composition& composition, const RenderWork& work);

/// Memory of the ffmpeg program for frames of this size, bytes.
std::uint64_t encoder_memory(VideoKind kind, int width, int height);

/// Largest number of workers, up to the given one, that fit into memory: frames do not depend on their number. `own`
/// bounds each process, `shared` all together. Throws RunError if not even one fits.
int workers_that_fit(const Composition& composition, const RenderWork& work, int workers,
                     const AvailableMemory& own = available_memory(), const AvailableMemory& shared = shared_memory());

}  // namespace tumble
