#include "app/sweep/sample_clip.h"

#include "app/clip/drawing_settings.h"
#include "app/files/aov_folder.h"
#include "app/pipeline/panel_run.h"
#include "app/workers/frame_filter.h"
#include "app/workers/frame_maker.h"
#include "output/video_writer.h"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tumble {
namespace {

constexpr const char* frame_pattern = "frames/frame_{:06}.png";
constexpr const char* aov_pattern = "aov/aov_{:06}.npz";
constexpr const char* aov_folder = "aov";

/// The poses of the frames, one after the other.
class Poses {
public:
    Poses(const RenderScenes& scenes, const Shutter& shutter, const FrameOutputs& outputs)
        : outputs_(outputs),
          end_(scenes.frames.end()),
          world_(scenes.world(0, 1)),
          overlay_(outputs.image() ? scenes.overlay(0) : nullptr),
          run_({.world = &world_, .end = end_, .overlay = overlay_.get()}, shutter) {}

    MotionBlurFrame next() {
        MotionBlurFrame frame = waiting_ ? std::move(*waiting_) : simulate();
        waiting_.reset();
        if (!outputs_.aovs.has(Aov::motion)) return frame;
        // The motion leads to the poses of the frame after this one.
        if (simulated_ < end_) {
            waiting_ = simulate();
            frame.aovs->next = waiting_->aovs->now;
        } else {
            frame.aovs->next = run_.next_start();
        }
        return frame;
    }

private:
    MotionBlurFrame simulate() {
        MotionBlurFrame frame;
        frame.frame = simulated_++;
        frame.panels.push_back(run_.next(frame.frame));
        const PanelPoses& poses = frame.panels.front();
        frame.time = poses.front().time;
        frame.overlays.push_back(run_.shapes());
        if (!outputs_.aovs.empty()) frame.aovs = AovPoses{poses.front(), std::nullopt};
        return frame;
    }

    FrameOutputs outputs_;
    std::int64_t end_, simulated_ = 0;
    World world_;
    std::unique_ptr<OverlayBuilder> overlay_;
    PanelRun run_;
    std::optional<MotionBlurFrame> waiting_;
};

/// The files of the frames.
class Files {
public:
    Files(const SweepPlan& plan, const RenderScenes& scenes, const FrameOutputs& outputs, SampleFolder& folder)
        : outputs_(outputs), folder_(folder) {
        const SceneDescription& scene = scenes.first();
        if (outputs.png) folder.add_folder("frames");
        if (!outputs.aovs.empty()) folder.add_folder(aov_folder);
        if (outputs.aovs.has(Aov::segmentation)) {
            const auto aovs = folder.path() / aov_folder;
            AovFolder(aovs, scene, outputs.aovs).write_table();
            folder.add((std::filesystem::path(aov_folder) / segmentation_table_path(aovs).filename()).string());
        }
        if (!outputs.video) return;
        clip_ = plan.outputs.clip;
        ClipOptions options{FrameTimes::constant_rate, plan.drawing.quality, outputs.transparent};
        video_.emplace(folder.path() / clip_, scenes.composition.width, scenes.composition.height, scene.output.fps,
                       options);
    }

    /// Adds a frame; spans without bytes repeat the frame before.
    void add(std::int64_t frame, std::span<const std::byte> png, std::span<const std::byte> pixels,
             std::span<const std::byte> aovs) {
        if (!png.empty()) png_ = png;
        if (!aovs.empty()) aovs_ = aovs;
        if (outputs_.png) folder_.write(frame_pattern, frame, png_);
        if (!outputs_.aovs.empty()) folder_.write(aov_pattern, frame, aovs_);
        if (!video_) return;
        if (pixels.empty()) return video_->repeat();
        // ffmpeg may read the memory later, and the next frame has the place of this one.
        const auto copy = std::make_shared<std::vector<std::byte>>(pixels.begin(), pixels.end());
        video_->write({copy, copy->data()});
    }

    void finish() {
        if (!video_) return;
        video_->finish();
        folder_.add(clip_);
    }

private:
    const FrameOutputs outputs_;
    SampleFolder& folder_;
    std::string clip_;
    std::optional<VideoWriter> video_;
    std::span<const std::byte> png_, aovs_;  // of the last frame that has some
};

}  // namespace

RenderOptions render_options(const SampleDrawing& drawing) {
    RenderOptions options;
    options.backend = drawing.backend;
    options.transparent = drawing.transparent;
    return options;
}

Shutter shutter_of(const SampleDrawing& drawing) { return Shutter::of(drawing.shutter, drawing.blur_samples); }

FrameOutputs frame_outputs(const SweepPlan& plan, const RenderScenes& scenes) {
    const SampleDrawing& drawing = plan.drawing;
    const FrameIdentity pictures = identity_of(
        scenes.scenes,
        drawing_settings(scenes.request, {drawing.shutter, drawing.blur_samples, drawing.transparent, drawing.backend},
                         scenes.composition));
    FrameOutputs outputs;
    outputs.png_mark = pictures.mark();
    outputs.aov_mark = identity_of_aovs(pictures, plan.outputs.aovs).mark();
    outputs.png = plan.outputs.frames;
    outputs.aovs = plan.outputs.aovs;
    outputs.transparent = plan.drawing.transparent;
    if (!plan.outputs.clip.empty())
        outputs.video = video_format(plan.outputs.clip, scenes.first().output.fps, plan.drawing.transparent).pixels;
    return outputs;
}

std::int64_t write_clip(const SweepPlan& plan, const RenderScenes& scenes, GlDevice* device, SampleFolder& folder) {
    constexpr int slot = 0;
    const FrameOutputs outputs = frame_outputs(plan, scenes);
    const Shutter shutter = shutter_of(plan.drawing);
    RenderSwitches switches{render_options(plan.drawing)};
    switches.device = device;
    Files files(plan, scenes, outputs, folder);
    SharedFrames memory(scenes.composition, outputs, 1, shutter.blur_samples);
    FrameMaker maker(scenes.composition, switches, outputs, memory);
    FrameFilter filter(scenes.composition, outputs);
    Poses poses(scenes, shutter, outputs);
    std::int64_t drawn_frames = 0;
    for (std::int64_t n = 0; n < scenes.frames.end(); ++n) {
        MotionBlurFrame frame = poses.next();
        const bool first = n == scenes.frames.first();
        const bool wanted = filter.follow(frame, first);
        if (!scenes.frames.contains(n)) continue;
        DrawnFrame drawn;
        const bool image = !frame.panels.empty(), aovs = frame.aovs.has_value();
        if (wanted) {
            memory.write_frame(frame);
            drawn = maker.make({n, frame.time, slot, image, aovs});
        }
        if (image) ++drawn_frames;
        const bool pixels = image && (first || !drawn.unchanged);
        files.add(n, image ? memory.png(slot).first(drawn.png_bytes) : std::span<std::byte>(),
                  pixels ? memory.video(slot) : std::span<std::byte>(),
                  aovs ? memory.aovs(slot).first(drawn.aov_bytes) : std::span<std::byte>());
    }
    files.finish();
    return drawn_frames;
}

}  // namespace tumble
