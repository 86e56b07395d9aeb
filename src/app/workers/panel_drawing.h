// The image of one panel: drawn, averaged over the samples of its frame, and with the shapes of its overlay.
#pragma once

#include "app/workers/shared_frames.h"
#include "core/image_mean.h"
#include "overlay/overlay_painter.h"
#include "render/render_switches.h"
#include "render/renderer.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

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

}  // namespace tumble
