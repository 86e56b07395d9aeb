// Makes the outputs of a clip's frames from poses in shared memory, and leaves them there: in a render process
// (render_process.h), or in the process that has the poses.
#pragma once

#include "app/composition/composition.h"
#include "app/composition/frame_composer.h"
#include "app/files/aov_file.h"
#include "app/threads/stage_timer.h"
#include "app/workers/panel_drawing.h"
#include "app/workers/shared_frames.h"
#include "output/png_writer.h"
#include "output/video_pixels.h"
#include "render/render_switches.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

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
    std::vector<std::unique_ptr<PanelDrawing>> panels_;
    std::optional<FrameComposer> composer_;  // absent where the image of the only panel is the frame
    std::optional<VideoPixels> video_;
    std::optional<PngEncoder> png_;
    std::span<const std::byte> file_;
    std::optional<AovFile> aovs_;
    AovPoses aov_poses_;
};

}  // namespace tumble
