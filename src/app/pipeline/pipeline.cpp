#include "app/pipeline/pipeline.h"

#include "app/threads/interrupt.h"
#include "app/threads/task_group.h"
#include "core/error.h"
#include "output/temporary_file.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace tumble {
namespace {

// Enough to smooth frames of different cost; small relative to one frame's pixels.
constexpr std::size_t waiting_poses = 8;
constexpr std::size_t waiting_pose_bytes = 16 << 20;  // lower limit for scenes of very many bodies
// Each holds a slot of the process that drew it, so a number above that of the slots would have no effect.
constexpr std::size_t waiting_frames = 2;
constexpr auto supervision_period = std::chrono::milliseconds(50);

std::size_t poses_that_may_wait(std::size_t bodies, const Shutter& shutter) {
    const std::size_t bytes = std::max<std::size_t>(bodies, 1) * sizeof(BodyState) * std::size_t(shutter.moments);
    return std::clamp<std::size_t>(waiting_pose_bytes / bytes, 1, waiting_poses);
}

template <class Work>
auto timed(StageTime& time, const Work& work) {
    const StageTimer timer(time);
    return work();
}

}  // namespace

void supervise(TaskGroup& stages, Interrupt& interrupt, const std::function<void()>& report) {
    while (!stages.wait(supervision_period)) {
        report();
        if (interrupt.pending()) stages.stop(std::make_exception_ptr(RunError("interrupted")));
    }
    stages.finish();
}

Pipeline::Pipeline(World& world, const FrameRange& frames, RenderPool& drawer, const FrameFolder* folder,
                   VideoWriter* video, AovFolder* aovs, Shutter shutter)
    : sequence_(world, shutter),
      frames_(frames),
      drawer_(drawer),
      folder_(folder),
      video_(video),
      aovs_(aovs),
      poses_(poses_that_may_wait(world.snapshot().bodies.size(), shutter)),
      for_png_(waiting_frames),
      for_aovs_(waiting_frames),
      for_video_(waiting_frames) {}

void Pipeline::run(Interrupt& interrupt, const std::function<void(std::int64_t)>& report) {
    TaskGroup stages;
    stages.on_stop([this] {
        poses_.cancel();
        for_png_.cancel();
        for_aovs_.cancel();
        for_video_.cancel();
        frame_files_.cancel();
        aov_files_.cancel();
        drawer_.abandon();
        if (video_ != nullptr) video_->abandon();
    });
    stages.start([this] { simulate(); });
    stages.start([this] {
        drawer_.run(
            poses_, [this](const Frame& frame) { return hand_on(frame); }, times_.drawing, frames_.first);
        for_png_.close();
        for_aovs_.close();
        for_video_.close();
    });
    const auto publish = [&](PublishQueue& files, StageTime& time) {
        for (int i = 0; i < PublishQueue::threads; ++i) stages.start([&] { files.run(time); });
    };
    if (folder_ != nullptr) {
        stages.start([this] { write_frames(); });
        publish(frame_files_, times_.files);
    }
    if (aovs_ != nullptr) {
        stages.start([this] { write_aovs(); });
        publish(aov_files_, times_.aov_files);
    }
    if (video_ != nullptr) stages.start([this] { write_video(); });
    supervise(stages, interrupt, [&] { report(finished()); });
    if (folder_ != nullptr) bring_to_disk(folder_->path());
    if (aovs_ != nullptr) bring_to_disk(aovs_->path());
}

void Pipeline::simulate() {
    const bool ahead = aovs_ != nullptr && aovs_->aovs().has(Aov::motion);
    std::optional<MotionBlurFrame> waiting;  // with motion AOVs, a frame waits for the poses of the next one
    for (std::int64_t n = 0; n < frames_.end; ++n) {
        MotionBlurFrame exposure = expose(n);
        if (waiting) waiting->aovs->next = exposure.aovs->now;
        if (waiting && !poses_.push(std::move(*waiting))) return;
        waiting.reset();
        if (ahead)
            waiting = std::move(exposure);
        else if (!poses_.push(std::move(exposure)))
            return;
    }
    if (waiting) {
        waiting->aovs->next = timed(times_.simulation, [&] { return sequence_.next_start(); });
        if (!poses_.push(std::move(*waiting))) return;
    }
    poses_.close();
}

MotionBlurFrame Pipeline::expose(std::int64_t frame) {
    const StageTimer timer(times_.simulation);
    MotionBlurFrame exposure{frame, sequence_.next(), std::nullopt};
    if (aovs_ != nullptr) exposure.aovs = AovPoses{exposure.moments.front(), std::nullopt};
    return exposure;
}

bool Pipeline::hand_on(const Frame& frame) {
    if (folder_ != nullptr && !for_png_.push(frame)) return false;
    if (aovs_ != nullptr && !for_aovs_.push(frame)) return false;
    return video_ == nullptr || for_video_.push(frame);
}

// A frame's slot is free when its file is written; syncing to the disk may take longer than drawing the next frame.
void Pipeline::write_frames() {
    while (std::optional<Frame> frame = for_png_.pop()) {
        auto file = timed(times_.files, [&] {
            auto part = std::make_unique<TemporaryFile>(frame_path(folder_->path(), frame->number), LeftParts::kept);
            part->write(frame->png);
            return part;
        });
        frame.reset();
        if (!frame_files_.put(std::move(file))) return;
    }
    frame_files_.close();
}

void Pipeline::write_aovs() {
    while (std::optional<Frame> frame = for_aovs_.pop()) {
        auto file = timed(times_.aov_files, [&] { return aovs_->write(frame->number, frame->aovs); });
        frame.reset();
        if (!aov_files_.put(std::move(file))) return;
    }
    aov_files_.close();
}

void Pipeline::write_video() {
    while (const std::optional<Frame> frame = for_video_.pop()) {
        const StageTimer timer(times_.video);
        if (frame->repeated)
            video_->repeat();
        else
            video_->write(frame->video);
        ++filmed_;
    }
    // After a stop the queue ends as well, but the clip is not complete.
    if (filmed_ != frames_.count()) return;
    const StageTimer timer(times_.video);
    video_->finish();
}

std::int64_t Pipeline::finished() const {
    std::int64_t done = frames_.count();
    if (folder_ != nullptr) done = std::min(done, frame_files_.published());
    if (aovs_ != nullptr) done = std::min(done, aov_files_.published());
    if (video_ != nullptr) done = std::min(done, filmed_.load());
    return done;
}

}  // namespace tumble
