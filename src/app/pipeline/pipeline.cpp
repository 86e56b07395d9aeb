#include "app/pipeline/pipeline.h"

#include "app/threads/interrupt.h"
#include "app/threads/task_group.h"
#include "core/check.h"
#include "core/error.h"
#include "output/temporary_file.h"
#include "sim/checkpoint/archive.h"

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
constexpr std::size_t queued_frames = 2;
constexpr auto supervision_period = std::chrono::milliseconds(50);

std::size_t poses_that_may_wait(std::span<const PanelSource> panels, const Shutter& shutter) {
    std::size_t bodies = 0;
    for (const PanelSource& panel : panels) bodies += panel.bodies;
    const std::size_t bytes = std::max<std::size_t>(bodies, 1) * sizeof(BodyState) * std::size_t(shutter.blur_samples);
    return std::clamp<std::size_t>(waiting_pose_bytes / bytes, 1, waiting_poses);
}

template <class Work>
auto timed(StageTime& time, std::int64_t frame, const Work& work) {
    const StageTimer timer(time, frame);
    return work();
}

}  // namespace

void PipelineTimes::record(Trace& trace) {
    for (StageTime* stage :
         {&simulation, &drawing.drawing, &drawing.conversion, &drawing.png, &drawing.aovs, &files, &aov_files, &video})
        stage->trace = &trace;
}

void supervise(TaskGroup& stages, Interrupt& interrupt, const std::function<void()>& report) {
    while (!stages.wait(supervision_period)) {
        report();
        if (interrupt.pending()) stages.stop(std::make_exception_ptr(Interrupted()));
    }
    stages.finish();
}

Pipeline::Pipeline(std::span<const PanelSource> panels, const PipelineFrames& frames, RenderPool& render_pool,
                   const PipelineOutputs& outputs, Shutter shutter)
    : frames_(frames),
      render_pool_(render_pool),
      outputs_(outputs),
      poses_(poses_that_may_wait(panels, shutter)),
      for_png_(queued_frames),
      for_aovs_(queued_frames),
      for_video_(queued_frames) {
    for (const PanelSource& panel : panels) panels_.emplace_back(panel, shutter);
}

void Pipeline::go_on_from(const ClipState& state) {
    TUMBLE_CHECK_LE(state.frame, frames_.drawn.first());
    if (state.panels.size() != panels_.size()) CheckpointReader::fail("has another number of panels");
    for (std::size_t i = 0; i < panels_.size(); ++i) {
        panels_[i].restore(state.panels[i], state.frame);
        render_pool_.restore(i, state.panels[i].poses);
    }
    begin_ = state.frame;
}

void Pipeline::run(Interrupt& interrupt, const std::function<void(std::int64_t)>& report) {
    TaskGroup stages;
    stages.on_stop([this] {
        poses_.cancel();
        for_png_.cancel();
        for_aovs_.cancel();
        for_video_.cancel();
        frame_files_.cancel();
        aov_files_.cancel();
        render_pool_.abandon();
        if (outputs_.video != nullptr) outputs_.video->abandon();
    });
    stages.start([this] { simulate(); });
    stages.start([this] {
        render_pool_.run(
            poses_, [this](const Frame& frame) { return deliver(frame); }, times_.drawing, frames_.drawn);
        for_png_.close();
        for_aovs_.close();
        for_video_.close();
    });
    const auto publish = [&](PublishQueue& files, StageTime& time) {
        for (int i = 0; i < PublishQueue::threads; ++i) stages.start([&] { files.run(time); });
    };
    if (outputs_.folder != nullptr) {
        stages.start([this] { write_frames(); });
        publish(frame_files_, times_.files);
    }
    if (outputs_.aovs != nullptr) {
        stages.start([this] { write_aovs(); });
        publish(aov_files_, times_.aov_files);
    }
    if (outputs_.video != nullptr) stages.start([this] { write_video(); });
    supervise(stages, interrupt, [&] { report(finished()); });
    if (outputs_.folder != nullptr) bring_to_disk(outputs_.folder->path());
    if (outputs_.aovs != nullptr) bring_to_disk(outputs_.aovs->path());
}

void Pipeline::simulate() {
    const bool ahead = outputs_.aovs != nullptr && outputs_.aovs->aovs().has(Aov::motion);
    std::optional<MotionBlurFrame> waiting;  // with motion AOVs, a frame waits for the poses of the next one
    for (std::int64_t n = begin_; n < end(); ++n) {
        MotionBlurFrame frame_poses = simulate_frame(n);
        if (waiting) waiting->aovs->next = frame_poses.aovs->now;
        if (waiting && !poses_.push(std::move(*waiting))) return;
        waiting.reset();
        if (ahead)
            waiting = std::move(frame_poses);
        else if (!poses_.push(std::move(frame_poses)))
            return;
    }
    if (waiting) {
        waiting->aovs->next = timed(times_.simulation, end(), [&] { return panels_.front().next_start(); });
        if (!poses_.push(std::move(*waiting))) return;
    }
    poses_.close();
}

MotionBlurFrame Pipeline::simulate_frame(std::int64_t frame) {
    const StageTimer timer(times_.simulation, frame);
    MotionBlurFrame frame_poses;
    frame_poses.frame = frame;
    for (PanelRun& panel : panels_) {
        frame_poses.panels.push_back(panel.next(frame));
        if (panel.runs(frame)) frame_poses.time = frame_poses.panels.back().front().time;
        frame_poses.overlays.push_back(panel.shapes());
    }
    if (outputs_.aovs != nullptr) frame_poses.aovs = AovPoses{frame_poses.panels.front().front(), std::nullopt};
    return frame_poses;
}

bool Pipeline::deliver(const Frame& frame) {
    const auto takes = [&](const void* output, const FrameSet& frames) {
        return output != nullptr && frames.contains(frame.number);
    };
    if (takes(outputs_.folder, frames_.folder) && !for_png_.push(frame)) return false;
    if (takes(outputs_.aovs, frames_.aovs) && !for_aovs_.push(frame)) return false;
    return !takes(outputs_.video, frames_.video) || for_video_.push(frame);
}

// A frame's slot is free when its file is written; syncing to the disk may take longer than drawing the next frame.
void Pipeline::write_frames() {
    while (std::optional<Frame> frame = for_png_.pop()) {
        auto file =
            timed(times_.files, frame->number, [&] { return outputs_.folder->write(frame->number, frame->png); });
        frame.reset();
        if (!frame_files_.put(std::move(file))) return;
    }
    frame_files_.close();
}

void Pipeline::write_aovs() {
    while (std::optional<Frame> frame = for_aovs_.pop()) {
        auto file =
            timed(times_.aov_files, frame->number, [&] { return outputs_.aovs->write(frame->number, frame->aovs); });
        frame.reset();
        if (!aov_files_.put(std::move(file))) return;
    }
    aov_files_.close();
}

void Pipeline::write_video() {
    while (const std::optional<Frame> frame = for_video_.pop()) {
        const StageTimer timer(times_.video, frame->number);
        outputs_.video->write(frame->number, frame->video, frame->repeated);
        ++encoded_;
    }
    // After a stop the queue ends as well, but the clip is not complete.
    if (encoded_ != frames_.video.count()) return;
    const StageTimer timer(times_.video);
    outputs_.video->finish();
}

std::int64_t Pipeline::finished() const {
    std::int64_t missing = 0;
    const auto add = [&](const void* output, const FrameSet& frames, std::int64_t done) {
        if (output != nullptr) missing = std::max(missing, frames.count() - done);
    };
    add(outputs_.folder, frames_.folder, frame_files_.published());
    add(outputs_.aovs, frames_.aovs, aov_files_.published());
    add(outputs_.video, frames_.video, encoded_);
    return frames_.drawn.count() - missing;
}

}  // namespace tumble
