// A render process: a worker with an OpenGL context for each panel, all in one thread on one core. (Contexts of several
// threads wait for each other in llvmpipe.) It makes the outputs of each frame and leaves them in shared memory.
#pragma once

#include "app/composition/composition.h"
#include "app/workers/frame_maker.h"
#include "app/workers/motion_blur_frame.h"
#include "app/workers/shared_frames.h"
#include "app/workers/worker_process.h"
#include "render/render_switches.h"

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <span>

namespace tumble {

class RenderProcess {
public:
    /// Forks as a WorkerProcess does; the child opens OpenGL at once.
    RenderProcess(const Composition& composition, const RenderSwitches& options, const FrameOutputs& outputs, int slots,
                  int max_blur_samples, std::span<const int> other_sockets = {});

    /// Draws one frame into the slot and waits for it: the image if it has poses of panels, the AOVs if it has their
    /// poses. Throws RunError naming the frame if drawing fails or the process has died.
    DrawnFrame draw(const MotionBlurFrame& frame_poses, int slot);

    // As in WorkerProcess. A draw() that waits fails after kill().
    void kill() { process_.kill(); }
    ProcessEnd finish() { return process_.finish(); }
    pid_t id() const { return process_.id(); }
    int socket() const { return process_.socket(); }

    const std::shared_ptr<SharedFrames>& memory() const { return memory_; }

private:
    [[noreturn]] void died(std::int64_t frame);

    std::shared_ptr<SharedFrames> memory_;
    WorkerProcess process_;
};

}  // namespace tumble
