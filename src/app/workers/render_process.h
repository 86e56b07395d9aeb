// A render process: forked before the first OpenGL call and before any thread, with an OpenGL context for each panel, all
// in one thread on one core. (Contexts of several threads wait for each other in llvmpipe.) It makes the outputs of each frame and leaves them in
// shared memory. It writes no files, so that it can be stopped at any time.
#pragma once

#include "app/composition/composition.h"
#include "app/workers/frame_maker.h"
#include "app/workers/motion_blur_frame.h"
#include "app/workers/shared_frames.h"
#include "output/process.h"
#include "render/render_switches.h"

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>

namespace tumble {

class RenderProcess {
public:
    /// Forks; the child opens OpenGL at once, and closes the sockets of the workers that were started before it.
    /// Precondition: the program has no other thread. Throws RunError if there are no more processes or no memory.
    RenderProcess(const Composition& composition, const RenderSwitches& options, const FrameOutputs& outputs, int slots,
                  int max_blur_samples, std::span<const int> other_sockets = {});
    /// Ends the process in any state.
    ~RenderProcess();
    RenderProcess(const RenderProcess&) = delete;
    RenderProcess& operator=(const RenderProcess&) = delete;

    /// Draws one frame into the slot and waits for it: the image if it has poses of panels, the AOVs if it has their
    /// poses. Throws RunError naming the frame if drawing fails or the process has died.
    DrawnFrame draw(const MotionBlurFrame& frame_poses, int slot);

    /// Ends the process at once, from any thread. A waiting draw() then fails.
    void kill();

    /// Ends the process and returns its usage. One that does not end within a second is killed.
    ProcessEnd finish();

    const std::shared_ptr<SharedFrames>& memory() const { return memory_; }
    pid_t id() const { return id_; }
    int socket() const { return socket_; }

private:
    [[noreturn]] void died(std::int64_t frame);

    std::shared_ptr<SharedFrames> memory_;
    pid_t id_ = -1;
    std::mutex
        id_mutex_;  // guards kill() against the end of finish(), after which another process may have that number
    int socket_ = -1;
};

}  // namespace tumble
