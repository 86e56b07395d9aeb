// Poses in, finished frames out in order: all that the pipeline knows of drawing. Behind it work one process a core
// (draw_worker.h); whichever is free takes the next pose. The pixels do not depend on their number: every frame is what
// a full redraw of its poses would be, and the poses are chosen (drawn_poses.h) before they are handed out.
//
// A frame in which nothing drawn has moved is not drawn: it repeats the one before. AOVs (aov_maker.h) are of the true
// poses: where only those have moved, the picture is repeated, but not the AOVs.
#pragma once

#include "app/threads/bounded_queue.h"
#include "app/workers/render_process.h"
#include "app/timing/motion_blur.h"
#include "app/threads/stage_timer.h"
#include "render/scene/pose_filter.h"
#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace tumble {

/// One finished frame of the clip in all its forms, shared by the outputs that read it.
struct Frame {
    std::int64_t number = 0;
    bool repeated = false;                   // the same picture as the frame before it
    std::shared_ptr<const std::byte> video;  // as a VideoPixels has it; null where it is not asked for
    std::span<const std::byte> png;          // the file; lives as long as `slot`
    std::shared_ptr<const void> slot;
    std::span<const std::byte> aovs;         // the file (aov_file.h); lives as long as `aov_slot`
    std::shared_ptr<const void> aov_slot;    // null where no AOVs are asked for
};

struct DrawingTimes {
    StageTime drawing, conversion, png, aovs;
};

class ReorderBuffer;

class RenderPool {
public:
    /// Starts the processes: call it before the program has any other thread. Frames have so many moments at most.
    /// The scene must outlive it. Throws RunError.
    RenderPool(const SceneDescription& scene, const RenderOptions& options, const FrameOutputs& forms, int workers,
           int most_moments = 1);
    ~RenderPool();

    /// Takes poses until their queue ends, and hands each finished frame on, in the order of the poses. Stops early
    /// when `hand_on` says false. Of the frames before `first` only the poses are followed: what rests by then is drawn as if
    /// all had been. Throws RunError naming the frame where drawing fails or a process dies.
    void run(BoundedQueue<MotionBlurFrame>& poses, const std::function<bool(const Frame&)>& hand_on, DrawingTimes& times,
             std::int64_t first = 0);

    /// Ends the processes at once, from any thread; run() then comes back.
    void abandon();

    /// Waits for the processes to end; the sum of what they used.
    ProcessEnd finish();

    std::vector<pid_t> processes() const;
    std::int64_t drawn() const { return drawn_; }   // frames that were not repeated

private:
    class Slots;
    bool follow(MotionBlurFrame& exposure, bool anew);
    bool follow_picture(MotionBlurFrame& exposure);
    void tend(std::size_t worker, BoundedQueue<MotionBlurFrame>& poses, ReorderBuffer& order, DrawingTimes& times, std::int64_t first);

    std::shared_ptr<ShaderCompileSchedule> turns_;
    std::vector<std::unique_ptr<RenderProcess>> workers_;
    std::vector<std::shared_ptr<Slots>> slots_;   // of each worker
    std::mutex pose_mutex_;                       // the next pose to draw: one taker at a time
    PoseFilter drawn_poses_;
    AovChanges aov_changes_;
    FrameOutputs forms_;
    bool moves_ = false;                          // while the shutter was open for the frame before
    std::int64_t drawn_ = 0;
};

}  // namespace tumble
