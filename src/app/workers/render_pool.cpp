#include "app/workers/render_pool.h"

#include "app/workers/reorder_buffer.h"
#include "core/error.h"
#include "core/start_thread.h"
#include "render/gl/shader_compile_schedule.h"
#include "render/render_switches.h"

#include <sys/mman.h>

#include <algorithm>
#include <condition_variable>
#include <new>
#include <optional>
#include <thread>
#include <utility>

namespace tumble {
namespace {

// One is filled, one waits for its turn, one is read; slots held by later queues make the worker wait.
constexpr int slots_of_worker = 4;

/// In memory shared by all processes. Null with a single process.
std::shared_ptr<ShaderCompileSchedule> make_compile_schedule(int workers) {
    if (workers < 2) return nullptr;
    void* const memory =
        mmap(nullptr, sizeof(ShaderCompileSchedule), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) return nullptr;  // each process then compiles everything
    return {new (memory) ShaderCompileSchedule, [](ShaderCompileSchedule* turns) { munmap(turns, sizeof *turns); }};
}

}  // namespace

/// The free slots of a worker. A slot returns when the last output has released it.
class RenderPool::Slots : public std::enable_shared_from_this<Slots> {
public:
    explicit Slots(std::shared_ptr<SharedFrames> memory) : memory_(std::move(memory)) {
        for (int i = 0; i < slots_of_worker; ++i) free_.push_back(i);
    }

    /// Waits for a slot; null: it was stopped. The slot is free again when the last copy of the pointer is gone.
    std::shared_ptr<const int> take() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return stopped_ || !free_.empty(); });
        if (stopped_) return nullptr;
        const int* const slot = new int(free_.back());
        free_.pop_back();
        return {slot, [self = shared_from_this()](const int* back) { self->put_back(back); }};
    }

    void stop() {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
        changed_.notify_all();
    }

    const SharedFrames& memory() const { return *memory_; }

private:
    void put_back(const int* slot) {
        const std::lock_guard lock(mutex_);
        free_.push_back(*slot);
        delete slot;
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<int> free_;
    bool stopped_ = false;
    std::shared_ptr<SharedFrames> memory_;  // lives as long as one of its slots is read
};

RenderPool::RenderPool(const Composition& composition, const RenderOptions& options, const FrameOutputs& outputs,
                       int workers, int max_blur_samples)
    : compile_schedule_(make_compile_schedule(workers)), composition_(composition), filter_(composition, outputs) {
    RenderSwitches with_schedule{options};
    with_schedule.compile_schedule = compile_schedule_.get();
    std::vector<int> sockets;
    for (int i = 0; i < workers; ++i) {
        workers_.push_back(std::make_unique<RenderProcess>(composition_, with_schedule, outputs, slots_of_worker,
                                                           max_blur_samples, sockets));
        sockets.push_back(workers_.back()->socket());
        slots_.push_back(std::make_shared<Slots>(workers_.back()->memory()));
    }
}

RenderPool::~RenderPool() = default;

void RenderPool::run(BoundedQueue<MotionBlurFrame>& poses, const std::function<bool(const Frame&)>& deliver,
                     DrawingTimes& times, const FrameSet& frames) {
    ReorderBuffer order(workers_.size(), frames);
    std::vector<std::thread> threads;
    const auto stop = [&] {
        poses.cancel();
        order.stop();
        for (const auto& slots : slots_) slots->stop();
        for (std::thread& thread : threads) thread.join();
    };
    try {
        for (std::size_t i = 0; i < workers_.size(); ++i)
            threads.push_back(start_thread<std::thread>([&, i] {
                try {
                    serve(i, poses, order, times, frames);
                } catch (...) {
                    order.fail(std::current_exception());
                }
                order.leave();
            }));
        while (const std::optional<Frame> frame = order.next())
            if (!deliver(*frame)) break;
    } catch (...) {
        stop();
        throw;
    }
    stop();
}

/// Main function of the thread that serves one worker.
void RenderPool::serve(std::size_t worker, BoundedQueue<MotionBlurFrame>& poses, ReorderBuffer& order,
                       DrawingTimes& times, const FrameSet& frames) {
    Slots& slots = *slots_[worker];
    const auto next_pose = [&]() -> std::optional<MotionBlurFrame> {
        const std::lock_guard lock(pose_mutex_);
        while (std::optional<MotionBlurFrame> pose = poses.pop()) {
            const bool wanted = filter_.follow(*pose, !frames.contains(pose->frame - 1));
            if (!frames.contains(pose->frame)) continue;
            if (wanted) {
                if (!pose->panels.empty()) ++drawn_;
                return pose;
            }
            if (!order.add_repeated(pose->frame)) break;
        }
        return std::nullopt;
    };
    // The slot is taken first: a thread with a pose can then always finish it, so later frames never wait for a slot.
    while (const std::shared_ptr<const int> slot = slots.take()) {
        const std::optional<MotionBlurFrame> pose = next_pose();
        if (!pose) return;
        const DrawnFrame drawn = workers_[worker]->draw(*pose, *slot);
        times.drawing.add(drawn.drawing, pose->frame);
        times.conversion.add(drawn.conversion, pose->frame);
        times.png.add(drawn.png, pose->frame);
        times.aovs.add(drawn.aovs, pose->frame);
        Frame frame;
        frame.number = pose->frame;
        if (pose->aovs) {
            frame.aov_slot = slot;
            frame.aovs = slots.memory().aovs(*slot).first(drawn.aov_bytes);
        }
        if (pose->panels.empty()) {
            order.add_with_last_image(std::move(frame));
            continue;
        }
        frame.slot = slot;
        frame.video = {slot, slots.memory().video(*slot).data()};
        frame.png = slots.memory().png(*slot).first(drawn.png_bytes);
        order.add(std::move(frame), worker, drawn.unchanged);
    }
}

void RenderPool::restore(std::size_t panel, std::span<const std::byte> poses) { filter_.restore(panel, poses); }

void RenderPool::abandon() {
    for (const auto& worker : workers_) worker->kill();
}

ProcessEnd RenderPool::finish() {
    ProcessEnd sum;
    for (const auto& worker : workers_) {
        const ProcessEnd end = worker->finish();
        sum.cpu_seconds += end.cpu_seconds;
        sum.peak_memory += end.peak_memory;
    }
    return sum;
}

std::vector<pid_t> RenderPool::processes() const {
    std::vector<pid_t> ids;
    for (const auto& worker : workers_) ids.push_back(worker->id());
    return ids;
}

}  // namespace tumble
