// A process that draws: forked before the first OpenGL call and before any thread, with an OpenGL of its own that uses
// one core. (Two contexts in one process wait for each other in llvmpipe.) It makes of each frame what the outputs want
// and leaves it in shared memory. It writes no files, so that it can be stopped at any time.
#pragma once

#include "app/timing/motion_blur.h"
#include "app/workers/shared_frames.h"
#include "output/process.h"
#include "render/renderer.h"
#include "scene/description/description.h"

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>

namespace tumble {

/// Seconds of work, by the clock and of the processor.
struct WorkTime {
    double wall = 0.0, cpu = 0.0;
};

/// What a worker tells of a frame that it has drawn.
struct DrawnFrame {
    std::int64_t frame = 0;
    bool failed = false;           // the reason is in the memory's words
    bool unchanged = false;        // the same picture as this worker's frame before
    std::size_t png_bytes = 0, aov_bytes = 0;   // of the files in the slot
    WorkTime drawing, conversion, png, aovs;
};

class RenderProcess {
public:
    /// Forks; the child opens OpenGL at once, and closes the sockets of the workers that were started before it. The calling
    /// program must have no other thread. Throws RunError when there are no more processes or no memory to be had.
    RenderProcess(const SceneDescription& scene, const RenderOptions& options, const FrameOutputs& forms, int slots,
               int most_moments, std::span<const int> other_sockets = {});
    /// Ends it, whatever it does.
    ~RenderProcess();
    RenderProcess(const RenderProcess&) = delete;
    RenderProcess& operator=(const RenderProcess&) = delete;

    /// Draws one frame into the slot and waits for it: the picture where it has moments, the AOVs where it has their poses.
    /// Throws RunError naming the frame where drawing fails, or the process has died.
    DrawnFrame draw(const MotionBlurFrame& exposure, int slot);

    /// Asks it to end at once; from any thread. A draw() that waits then fails.
    void kill();

    /// Ends it and tells what it used. One that does not end within a second is killed.
    ProcessEnd finish();

    const std::shared_ptr<SharedFrames>& memory() const { return memory_; }
    pid_t id() const { return id_; }
    int socket() const { return socket_; }

private:
    [[noreturn]] void died(std::int64_t frame);

    std::shared_ptr<SharedFrames> memory_;
    pid_t id_ = -1;
    std::mutex id_mutex_;   // kill() against the end of finish(), after which another process may have that number
    int socket_ = -1;
};

}  // namespace tumble
