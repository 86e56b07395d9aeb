// The pipeline; all stages run concurrently:
//
//   simulations ─poses──> render processes ──frames──┬──> PNG files
//                                                    ├──> AOV files
//                                                    └──> video (ffmpeg)
//
// The outputs of a frame (planes for ffmpeg, a PNG file, its AOVs) are made in the render process; here they are only
// written. Each arrow is a bounded queue: a slow stage makes earlier ones wait, so memory does not grow with the length
// of the clip. The first error of any stage stops all of them.
#pragma once

#include "app/checkpoints/clip_state.h"
#include "app/files/aov_folder.h"
#include "app/files/clip_sink.h"
#include "app/files/frame_folder.h"
#include "app/files/frame_set.h"
#include "app/files/publish_queue.h"
#include "app/pipeline/panel_run.h"
#include "app/threads/stage_timer.h"
#include "app/workers/render_pool.h"
#include "overlay/overlay_builder.h"
#include "scene/description/description.h"
#include "sim/frames/frame_sequence.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace tumble {

class Interrupt;
class TaskGroup;

/// Work of the stages; they overlap, so the sum exceeds the time of the run.
struct PipelineTimes {
    StageTime simulation{"simulation"};
    DrawingTimes drawing;
    StageTime files{"PNG files"}, aov_files{"AOV files"}, video{"video"};

    /// Every piece of work from now on goes into the trace, too.
    void record(Trace& trace);
};

/// Destinations of the frames; null: not requested.
struct PipelineOutputs {
    FrameFolder* folder = nullptr;
    ClipSink* video = nullptr;
    AovFolder* aovs = nullptr;
};

/// Frames that are drawn, and those among them that each output takes.
struct PipelineFrames {
    FrameSet drawn, folder, aovs, video;

    /// The same for all outputs.
    static PipelineFrames all(const FrameSet& frames) { return {frames, frames, frames, frames}; }
};

class Pipeline {
public:
    /// Simulates the frames up to the last one that is drawn, and draws those in the set. All arguments must outlive
    /// run(); the render pool must have the same panels and make the outputs that are requested.
    Pipeline(std::span<const PanelSource> panels, const PipelineFrames& frames, RenderPool& render_pool,
             const PipelineOutputs& outputs, Shutter shutter = {});

    /// Simulates from this state on, instead of from the start. Preconditions: its frame is not after the first one of
    /// the range; run() has not been called. Throws InputError where it is not a state of these panels.
    void go_on_from(const ClipState& state);

    /// Runs to the end, calling `report` about twenty times per second with the number of finished frames. Throws the
    /// first error of any stage, or RunError after an interrupt. Frames that are published by then are complete and
    /// stay.
    void run(Interrupt& interrupt, const std::function<void(std::int64_t)>& report);

    const PipelineTimes& times() const { return times_; }
    /// Call it before run(). The trace must outlive that.
    void record(Trace& trace) { times_.record(trace); }

private:
    void simulate();
    MotionBlurFrame simulate_frame(std::int64_t frame);
    void write_frames();
    void write_aovs();
    void write_video();
    bool deliver(const Frame& frame);
    std::int64_t end() const { return frames_.drawn.end(); }
    std::int64_t finished() const;

    std::vector<PanelRun> panels_;
    std::int64_t begin_ = 0;  // first simulated frame
    PipelineFrames frames_;
    RenderPool& render_pool_;
    PipelineOutputs outputs_;
    BoundedQueue<MotionBlurFrame> poses_;
    BoundedQueue<Frame> for_png_, for_aovs_, for_video_;
    PublishQueue frame_files_, aov_files_;
    std::atomic<std::int64_t> encoded_{0};
    PipelineTimes times_;
};

/// Waits for the stages of a run, reports, and stops them after an interrupt. Throws their first error.
void supervise(TaskGroup& stages, Interrupt& interrupt, const std::function<void()>& report);

}  // namespace tumble
