#include "app/pipeline.h"

#include "app/interrupt.h"
#include "app/stage_group.h"
#include "core/error.h"
#include "output/temporary_file.h"

#include <algorithm>
#include <optional>

namespace tumble {
namespace {

// Enough to even out frames of different cost, few enough to be nothing beside one frame's pixels.
constexpr std::size_t waiting_poses = 8;
constexpr std::size_t waiting_pose_bytes = 16 << 20;   // or fewer, where there are very many bodies
// Each holds a slot of the process that drew it: more waiting here than there are slots would not make it go on.
constexpr std::size_t waiting_frames = 2;
constexpr auto supervision_period = std::chrono::milliseconds(50);

std::size_t poses_that_may_wait(std::size_t bodies, const Shutter& shutter) {
    const std::size_t bytes = std::max<std::size_t>(bodies, 1) * sizeof(BodyState) * std::size_t(shutter.moments);
    return std::clamp<std::size_t>(waiting_pose_bytes / bytes, 1, waiting_poses);
}

}  // namespace

void supervise(StageGroup& stages, Interrupt& interrupt, const std::function<void()>& report) {
    while (!stages.wait(supervision_period)) {
        report();
        if (interrupt.pending()) stages.stop(std::make_exception_ptr(RunError("interrupted")));
    }
    stages.finish();
}

Pipeline::Pipeline(World& world, const FrameRange& frames, Drawer& drawer, const FrameFolder* folder, VideoWriter* video,
                   AovFolder* aovs, Shutter shutter)
    : world_(world),
      frames_(frames),
      drawer_(drawer),
      folder_(folder),
      video_(video),
      aovs_(aovs),
      shutter_(shutter),
      poses_(poses_that_may_wait(world.snapshot().bodies.size(), shutter)),
      for_png_(waiting_frames),
      for_aovs_(waiting_frames),
      for_video_(waiting_frames) {}

void Pipeline::run(Interrupt& interrupt, const std::function<void(std::int64_t)>& report) {
    StageGroup stages;
    stages.on_stop([this] {
        poses_.cancel();
        for_png_.cancel();
        for_aovs_.cancel();
        for_video_.cancel();
        drawer_.abandon();
        if (video_ != nullptr) video_->abandon();
    });
    stages.start([this] { simulate(); });
    stages.start([this] {
        drawer_.run(poses_, [this](const Frame& frame) { return hand_on(frame); }, times_.drawing,
                    frames_.first);
        for_png_.close();
        for_aovs_.close();
        for_video_.close();
    });
    if (folder_ != nullptr) stages.start([this] { write_frames(); });
    if (aovs_ != nullptr) stages.start([this] { write_aovs(); });
    if (video_ != nullptr) stages.start([this] { write_video(); });
    supervise(stages, interrupt, [&] { report(finished()); });
}

void Pipeline::simulate() {
    const bool ahead = aovs_ != nullptr && aovs_->aovs().has(Aov::motion);
    std::optional<Exposure> waiting;   // where motion is wanted: for the poses of the next frame
    for (std::int64_t n = 0; n < frames_.end; ++n) {
        Exposure exposure = expose(n);
        if (waiting) waiting->aovs->next = exposure.aovs->now;
        if (waiting && !poses_.push(std::move(*waiting))) return;
        waiting.reset();
        if (ahead) waiting = std::move(exposure);
        else if (!poses_.push(std::move(exposure))) return;
    }
    if (waiting) {
        waiting->aovs->next = after_the_last();
        if (!poses_.push(std::move(*waiting))) return;
    }
    poses_.close();
}

Exposure Pipeline::expose(std::int64_t frame) {
    const StageTimer timer(times_.simulation);
    Exposure exposure;
    exposure.frame = frame;
    // What the shutter of the last frame does not see needs not be simulated.
    const int parts = frame + 1 < frames_.end ? shutter_.parts : shutter_.moments;
    for (int part = 0; part < parts; ++part) {
        if (frame > 0 || part > 0) world_.advance_frame();
        if (part < shutter_.moments) exposure.moments.push_back(world_.snapshot());
    }
    if (aovs_ != nullptr) exposure.aovs = AovPoses{exposure.moments.front(), std::nullopt};
    return exposure;
}

/// The poses of the frame that would follow the last one.
Snapshot Pipeline::after_the_last() {
    const StageTimer timer(times_.simulation);
    for (int part = shutter_.moments - 1; part < shutter_.parts; ++part) world_.advance_frame();
    return world_.snapshot();
}

bool Pipeline::hand_on(const Frame& frame) {
    if (folder_ != nullptr && !for_png_.push(frame)) return false;
    if (aovs_ != nullptr && !for_aovs_.push(frame)) return false;
    return video_ == nullptr || for_video_.push(frame);
}

void Pipeline::write_frames() {
    while (const std::optional<Frame> frame = for_png_.pop()) {
        const StageTimer timer(times_.files);
        write_file(frame_path(folder_->path(), frame->number), frame->png);
        ++written_;
    }
}

void Pipeline::write_aovs() {
    while (const std::optional<Frame> frame = for_aovs_.pop()) {
        const StageTimer timer(times_.aov_files);
        aovs_->write(frame->number, frame->aovs);
        ++aovs_written_;
    }
}

void Pipeline::write_video() {
    while (const std::optional<Frame> frame = for_video_.pop()) {
        const StageTimer timer(times_.video);
        if (frame->repeated) video_->repeat();
        else video_->write(frame->video);
        ++filmed_;
    }
    // After a stop the queue ends too, but the clip is not whole.
    if (filmed_ != frames_.count()) return;
    const StageTimer timer(times_.video);
    video_->finish();
}

std::int64_t Pipeline::finished() const {
    std::int64_t done = frames_.count();
    if (folder_ != nullptr) done = std::min(done, written_.load());
    if (aovs_ != nullptr) done = std::min(done, aovs_written_.load());
    if (video_ != nullptr) done = std::min(done, filmed_.load());
    return done;
}

}  // namespace tumble
