#include "app/workers/render_process.h"

#include "app/workers/frame_maker.h"
#include "app/workers/worker_process.h"
#include "core/error.h"
#include "core/memory_limit.h"

#include <fmt/format.h>

#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <memory>
#include <new>
#include <system_error>
#include <utility>

namespace tumble {
namespace {

// A worker without a job ends within milliseconds.
constexpr auto longest_end = std::chrono::seconds(1);

[[noreturn]] void work(const Composition& composition, const RenderSwitches& options, const FrameOutputs& outputs,
                       SharedFrames& memory, int socket) {
    FrameJob job;
    bool asked = false;
    try {
        FrameMaker maker(composition, options, outputs, memory);
        while ((asked = receive_message(socket, job)))
            if (!send_message(socket, maker.make(job))) break;
        ::_exit(
            0);  // skips destructors of OpenGL, which would take milliseconds to free memory that ends with the process
    } catch (const std::exception& error) {
        const bool out_of_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
        memory.write_error(out_of_memory ? "out of memory" : reason_of(error));
        DrawnFrame failure;
        failure.failed = true;
        // If OpenGL could not be opened, no frame may have been requested yet.
        if (asked || receive_message(socket, job)) send_message(socket, failure);
    }
    ::_exit(0);  // no destructors of the parent's objects, no second flush of its streams
}

}  // namespace

RenderProcess::RenderProcess(const Composition& composition, const RenderSwitches& options, const FrameOutputs& outputs,
                             int slots, int max_blur_samples, std::span<const int> other_sockets)
    : memory_(std::make_shared<SharedFrames>(composition, outputs, slots, max_blur_samples)) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        throw RunError("cannot make a socket: " + std::generic_category().message(errno));
    std::fflush(nullptr);
    const pid_t program = ::getpid();
    id_ = ::fork();
    if (id_ == 0) {
        become_worker(program);
        // A copy of the program's end of a socket in this process would keep the other worker from noticing the
        // program's end.
        ::close(ends[0]);
        for (const int socket : other_sockets) ::close(socket);
        work(composition, options, outputs, *memory_, ends[1]);
    }
    const int error = errno;
    ::close(ends[1]);
    socket_ = ends[0];
    if (id_ < 0) {
        ::close(socket_);
        throw RunError("cannot start a process for drawing: " + std::generic_category().message(error));
    }
}

RenderProcess::~RenderProcess() {
    kill();
    finish();
}

DrawnFrame RenderProcess::draw(const MotionBlurFrame& frame_poses, int slot) {
    memory_->write_frame(frame_poses);
    DrawnFrame drawn;
    const FrameJob job{frame_poses.frame, frame_poses.time, slot, !frame_poses.panels.empty(),
                       frame_poses.aovs.has_value()};
    if (!send_message(socket_, job) || !receive_message(socket_, drawn)) died(frame_poses.frame);
    if (drawn.failed) throw RunError(fmt::format("cannot draw frame {}: {}", frame_poses.frame, memory_->error_text()));
    return drawn;
}

void RenderProcess::died(std::int64_t frame) {
    throw RunError(
        fmt::format("cannot draw frame {}: its process {}{}", frame, finish().describe(), memory_limit_note()));
}

void RenderProcess::kill() {
    const std::lock_guard lock(id_mutex_);
    if (id_ >= 0) ::kill(id_, SIGKILL);
}

ProcessEnd RenderProcess::finish() {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));  // the worker takes the closed socket as the end of its jobs
    if (id_ < 0) return {};
    if (!ends_within(id_, longest_end)) kill();
    const std::lock_guard lock(id_mutex_);
    return wait_for_process(std::exchange(id_, -1));
}

}  // namespace tumble
