// Takes poses and delivers finished frames in order; the pipeline's only interface to drawing. It has one render
// process per core (render_process.h); the next free one takes the next pose. Pixels do not depend on the number of
// processes: every frame equals a full redraw of its poses, and poses are filtered (pose_filter.h) before distribution.
//
// A frame in which nothing drawn has moved and no text has changed is not drawn: it repeats the previous one. AOVs
// (aov_renderer.h) use the true poses: if only those have moved, the image is repeated, but not the AOVs.
#pragma once

#include "app/composition/composition.h"
#include "app/files/frame_set.h"
#include "app/threads/bounded_queue.h"
#include "app/threads/stage_timer.h"
#include "app/workers/frame_filter.h"
#include "app/workers/motion_blur_frame.h"
#include "app/workers/render_process.h"
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

/// One finished frame of the clip with all its outputs, shared by their writers.
struct Frame {
    std::int64_t number = 0;
    bool repeated = false;                   // the same image as the previous frame
    std::shared_ptr<const std::byte> video;  // in the form of VideoPixels; null if not requested
    std::span<const std::byte> png;          // the file; valid as long as `slot`
    std::shared_ptr<const void> slot;
    std::span<const std::byte> aovs;       // the file (aov_file.h); valid as long as `aov_slot`
    std::shared_ptr<const void> aov_slot;  // null if no AOVs are requested
};

struct DrawingTimes {
    StageTime drawing{"drawing"}, conversion{"conversion"}, png{"PNG"}, aovs{"AOVs"};
};

class ReorderBuffer;

class RenderPool {
public:
    /// Starts the processes. Precondition: the program has no other thread. `blur_samples`: largest number per frame.
    /// Throws RunError.
    RenderPool(const Composition& composition, const RenderOptions& options, const FrameOutputs& outputs, int workers,
               int max_blur_samples = 1);
    ~RenderPool();

    /// Takes poses until their queue ends, and delivers each finished frame in the order of the poses. Stops early if
    /// `deliver` returns false. For frames that are not in `frames`, poses are filtered but not drawn, so that resting
    /// bodies look as if all frames had been drawn. Throws RunError naming the frame if drawing fails or a process
    /// dies.
    void run(BoundedQueue<MotionBlurFrame>& poses, const std::function<bool(const Frame&)>& deliver,
             DrawingTimes& times, const FrameSet& frames);

    /// Goes on with the poses of a panel that another run has filtered (PoseFilter). Precondition: run() has not been
    /// called.
    void restore(std::size_t panel, std::span<const std::byte> poses);

    /// Ends the processes at once, from any thread; run() then returns.
    void abandon();

    /// Waits for the processes to end; returns the sum of their usage.
    ProcessEnd finish();

    std::vector<pid_t> processes() const;
    std::int64_t drawn() const { return drawn_; }  // frames that were not repeated

private:
    class Slots;
    void serve(std::size_t worker, BoundedQueue<MotionBlurFrame>& poses, ReorderBuffer& order, DrawingTimes& times,
               const FrameSet& frames);

    std::shared_ptr<ShaderCompileSchedule> compile_schedule_;
    std::vector<std::unique_ptr<RenderProcess>> workers_;
    std::vector<std::shared_ptr<Slots>> slots_;  // of each worker
    std::mutex pose_mutex_;                      // serializes taking the next pose
    Composition composition_;
    FrameFilter filter_;
    std::int64_t drawn_ = 0;
};

}  // namespace tumble
