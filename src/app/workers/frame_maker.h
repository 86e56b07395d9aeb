// Makes the outputs of a clip's frames from poses in shared memory, and leaves them there: in a render process
// (render_process.h), or in the process that has the poses.
#pragma once

#include "app/composition/composition.h"
#include "app/composition/frame_composer.h"
#include "app/files/aov_file.h"
#include "app/threads/stage_timer.h"
#include "app/workers/shared_frames.h"
#include "core/image_mean.h"
#include "output/png_writer.h"
#include "output/video_pixels.h"
#include "overlay/overlay_painter.h"
#include "render/render_switches.h"
#include "render/renderer.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

// The image of one panel: drawn, averaged over the samples of its frame, and with the shapes of its overlay.

class PanelDrawing {
public:
    /// Opens an OpenGL context.
    PanelDrawing(const ClipPanel& panel, const RenderSwitches& options);

    /// Draws the moments of the panel in the shared memory.
    void draw(const SharedFrames& memory, std::size_t panel, std::int64_t frame);

    /// The image of the last draw().
    const Image& image() const { return *image_; }
    /// The regions that may differ from the image of the previous draw().
    const std::vector<Rectangle>& changed() const { return *changed_; }

private:
    void draw_samples(const SharedFrames& memory, std::size_t panel, std::int64_t frame);

    Renderer renderer_;
    Snapshot snapshot_;
    ImageMean mean_;
    Image blurred_;
    bool blurred_last_ = false;
    std::vector<Rectangle> whole_;  // the rectangle of the whole image
    std::optional<OverlayPainter> painter_;
    OverlayFrame shapes_;
    std::optional<Camera> opening_camera_;
    DepthImage opening_depths_;  // of a blurred image: when the shutter opens, the time of the overlay
    const Image* image_ = nullptr;
    const std::vector<Rectangle>* changed_ = nullptr;
};

/// A frame to make from the poses in the shared memory.
struct FrameJob {
    std::int64_t frame = 0;
    double time = 0.0;  // s
    int slot = 0;
    bool image = true, aovs = false;
};

/// Report about a frame that was made.
struct DrawnFrame {
    std::int64_t frame = 0;
    bool failed = false;                       // the reason is in the shared memory
    bool unchanged = false;                    // the same image as the frame made before
    std::size_t png_bytes = 0, aov_bytes = 0;  // of the files in the slot
    WorkTime drawing, conversion, png, aovs;
};

class FrameMaker {
public:
    /// Opens an OpenGL context for each panel. The composition and the memory must outlive it.
    FrameMaker(const Composition& composition, const RenderSwitches& options, const FrameOutputs& outputs,
               SharedFrames& memory);

    DrawnFrame make(const FrameJob& job);

private:
    void open_panels(const Composition& composition, RenderSwitches options);
    void make_image(const FrameJob& job, DrawnFrame& drawn);
    void draw(const FrameJob& job);

    SharedFrames& memory_;
    std::vector<std::unique_ptr<PanelDrawing>> panels_, insets_;
    std::vector<ClipInset> inset_places_;
    std::optional<FrameComposer> composer_;  // absent where the image of the only panel is the frame
    std::optional<VideoPixels> video_;
    std::optional<PngEncoder> png_;
    std::span<const std::byte> file_;
    std::optional<AovFile> aovs_;
    AovPoses aov_poses_;
};

}  // namespace tumble
