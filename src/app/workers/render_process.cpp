#include "app/workers/render_process.h"

#include "app/composition/frame_composer.h"
#include "app/files/aov_file.h"
#include "app/threads/stage_timer.h"
#include "app/workers/panel_drawing.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "output/png_writer.h"
#include "output/video_pixels.h"

#include <fmt/format.h>

#include <malloc.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>

namespace tumble {
namespace {

constexpr int largest_kept_block = 4 << 20, kept_memory = 32 << 20;  // bytes
// A worker without a job ends within milliseconds.
constexpr auto longest_end = std::chrono::seconds(1);

struct Job {
    std::int64_t frame = 0;
    double time = 0.0;  // s
    int slot = 0;
    bool image = true, aovs = false;
};

/// Messages arrive completely or not at all (SOCK_SEQPACKET). False: the other end is closed.
template <typename T>
bool send_message(int socket, const T& message) {
    ssize_t n = 0;
    while ((n = ::send(socket, &message, sizeof message, MSG_NOSIGNAL)) < 0 && errno == EINTR) {
    }
    return n == ssize_t(sizeof message);
}

template <typename T>
bool receive_message(int socket, T& message) {
    ssize_t n = 0;
    while ((n = ::recv(socket, &message, sizeof message, 0)) < 0 && errno == EINTR) {
    }
    return n == ssize_t(sizeof message);
}

template <typename Work>
WorkTime timed(const Work& work) {
    StageTime time;
    {
        const StageTimer timer(time);
        work();
    }
    return {time.wall.load(), time.cpu.load()};
}

/// The child process: its OpenGL contexts, and its previous frame with all outputs.
class FrameMaker {
public:
    FrameMaker(const Composition& composition, const RenderSwitches& options, const FrameOutputs& outputs,
               SharedFrames& memory)
        : memory_(memory) {
        if (outputs.image()) open_panels(composition, options);
        if (outputs.image() && !composition.plain()) composer_.emplace(composition, outputs.transparent);
        if (!outputs.aovs.empty()) aovs_.emplace(*composition.aov_scene, outputs.aovs, outputs.aov_mark);
        if (outputs.video) video_.emplace(*outputs.video, composition.width, composition.height);
        if (outputs.png) png_.emplace(outputs.transparent ? PngAlpha::kept : PngAlpha::dropped, outputs.png_mark);
    }

    DrawnFrame make(const Job& job) {
        DrawnFrame drawn;
        drawn.frame = job.frame;
        if (job.image) make_image(job, drawn);
        if (job.aovs)
            drawn.aovs = timed([&] {
                memory_.read_aov_poses(aov_poses_);
                const std::span<const std::byte> file = aovs_->make(aov_poses_);
                std::ranges::copy(file, memory_.aovs(job.slot).data());
                drawn.aov_bytes = file.size();
            });
        return drawn;
    }

private:
    void open_panels(const Composition& composition, RenderSwitches options) {
        for (const ClipPanel& panel : composition.panels) {
            panels_.push_back(std::make_unique<PanelDrawing>(panel, options));
            options.compile_schedule = nullptr;  // it distributes the shaders of one renderer of each process
        }
    }

    void make_image(const Job& job, DrawnFrame& drawn) {
        drawn.drawing = timed([&] { draw(job); });
        const Image& image = composer_ ? composer_->image() : panels_.front()->image();
        const std::vector<Rectangle>& changed = composer_ ? composer_->changed() : panels_.front()->changed();
        drawn.unchanged = changed.empty();
        if (video_)
            drawn.conversion = timed([&] {
                video_->update(image, changed);
                std::ranges::copy(video_->bytes(), memory_.video(job.slot).data());
            });
        if (png_)
            drawn.png = timed([&] {
                if (!changed.empty()) file_ = png_->encode(image, changed);
                std::ranges::copy(file_, memory_.png(job.slot).data());
            });
        drawn.png_bytes = file_.size();
    }

    void draw(const Job& job) {
        for (std::size_t i = 0; i < panels_.size(); ++i) panels_[i]->draw(memory_, i, job.frame);
        if (!composer_) return;
        std::vector<PanelImage> images;
        for (const auto& panel : panels_) images.push_back({panel->image(), panel->changed()});
        composer_->compose(images, job.time);
    }

    SharedFrames& memory_;
    std::vector<std::unique_ptr<PanelDrawing>> panels_;
    std::optional<FrameComposer> composer_;  // absent where the image of the only panel is the frame
    std::optional<VideoPixels> video_;
    std::optional<PngEncoder> png_;
    std::span<const std::byte> file_;
    std::optional<AovFile> aovs_;
    AovPoses aov_poses_;
};

/// The error text without the prefix "error: ", which the program adds.
std::string reason(const std::exception& error) {
    std::string_view text = error.what();
    constexpr std::string_view prefix = "error: ";
    if (text.starts_with(prefix)) text.remove_prefix(prefix.size());
    return std::string(text);
}

[[noreturn]] void work(const Composition& composition, const RenderSwitches& options, const FrameOutputs& outputs,
                       SharedFrames& memory, int socket) {
    ::setpgid(0, 0);  // Ctrl-C must reach it only through the program
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    // Keeps freed memory for the next frame: returned to the system, it would come back as hundreds of new pages.
    // Larger blocks are returned.
    ::mallopt(M_MMAP_THRESHOLD, largest_kept_block);
    ::mallopt(M_TRIM_THRESHOLD, kept_memory);
    ::setenv("LP_NUM_THREADS", "0", 1);  // llvmpipe draws in this thread: one core per worker

    Job job;
    bool asked = false;
    try {
        FrameMaker maker(composition, options, outputs, memory);
        while ((asked = receive_message(socket, job)))
            if (!send_message(socket, maker.make(job))) break;
        ::_exit(
            0);  // skips destructors of OpenGL, which would take milliseconds to free memory that ends with the process
    } catch (const std::exception& error) {
        const bool out_of_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
        memory.write_error(out_of_memory ? "out of memory" : reason(error));
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
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a worker that hangs or was stopped ends with the program as well
        if (::getppid() != program) ::_exit(0);
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
    for (std::size_t i = 0; i < frame_poses.panels.size(); ++i) memory_->write_poses(i, frame_poses.panels[i]);
    if (!frame_poses.panels.empty())
        for (std::size_t i = 0; i < frame_poses.overlays.size(); ++i)
            if (!frame_poses.overlays[i].empty()) memory_->write_overlay(i, frame_poses.overlays[i]);
    if (frame_poses.aovs) memory_->write_aov_poses(*frame_poses.aovs);
    DrawnFrame drawn;
    const Job job{frame_poses.frame, frame_poses.time, slot, !frame_poses.panels.empty(), frame_poses.aovs.has_value()};
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
