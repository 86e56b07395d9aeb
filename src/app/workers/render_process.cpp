#include "app/workers/render_process.h"

#include "app/workers/frame_maker.h"
#include "app/workers/worker_process.h"
#include "core/available_memory.h"
#include "core/error.h"

#include <fmt/format.h>

#include <unistd.h>

#include <exception>
#include <new>

namespace tumble {
namespace {

/// In the worker.
int draw_jobs(const Composition& composition, const RenderSwitches& options, const FrameOutputs& outputs,
              SharedFrames& memory, int socket) {
    FrameJob job;
    bool asked = false;
    try {
        FrameMaker maker(composition, options, outputs, memory);
        while ((asked = receive_message(socket, job)))
            if (!send_message(socket, maker.make(job))) break;
        // Skips destructors of OpenGL, which would take milliseconds to free memory that ends with the process.
        ::_exit(0);
    } catch (const std::exception& error) {
        const bool out_of_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
        memory.write_error(out_of_memory ? "out of memory" : reason_of(error.what()));
        DrawnFrame failure;
        failure.failed = true;
        // If OpenGL could not be opened, no frame may have been requested yet.
        if (asked || receive_message(socket, job)) send_message(socket, failure);
    }
    return 0;
}

}  // namespace

RenderProcess::RenderProcess(const Composition& composition, const RenderSwitches& options, const FrameOutputs& outputs,
                             int slots, int max_blur_samples, std::span<const int> other_sockets)
    : memory_(std::make_shared<SharedFrames>(composition, outputs, slots, max_blur_samples)),
      process_("drawing", other_sockets,
               [&](int socket) { return draw_jobs(composition, options, outputs, *memory_, socket); }) {}

DrawnFrame RenderProcess::draw(const MotionBlurFrame& frame_poses, int slot) {
    memory_->write_frame(frame_poses);
    DrawnFrame drawn;
    const FrameJob job{frame_poses.frame, frame_poses.time, slot, !frame_poses.panels.empty(),
                       frame_poses.aovs.has_value()};
    if (!send_message(process_.socket(), job) || !receive_message(process_.socket(), drawn)) died(frame_poses.frame);
    if (drawn.failed) throw RunError(fmt::format("cannot draw frame {}: {}", frame_poses.frame, memory_->error_text()));
    return drawn;
}

void RenderProcess::died(std::int64_t frame) {
    throw RunError(fmt::format("cannot draw frame {}: its process {}{}", frame, process_.finish().describe(),
                               memory_limit_note()));
}

}  // namespace tumble
