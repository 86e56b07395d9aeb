// The image of one panel: drawn, and averaged over the samples of its frame.
#pragma once

#include "app/workers/shared_frames.h"
#include "core/image_mean.h"
#include "render/renderer.h"

#include <cstdint>
#include <vector>

namespace tumble {

class PanelDrawing {
public:
    /// Opens an OpenGL context.
    PanelDrawing(const SceneDescription& scene, const RenderSwitches& options) : renderer_(scene, options) {}

    /// Draws the samples of the panel in the shared memory.
    void draw(const SharedFrames& memory, std::size_t panel, std::int64_t frame);

    /// Of the last draw().
    const Image& image() const { return blurred_last_ ? blurred_ : *drawn_; }
    /// The regions that may differ from the image of the previous draw().
    const std::vector<Rectangle>& changed() const { return changed_; }

private:
    Renderer renderer_;
    Snapshot snapshot_;
    const Image* drawn_ = nullptr;  // the last sample that was drawn; the renderer owns it
    ImageMean mean_;
    Image blurred_;
    bool blurred_last_ = false;
    std::vector<Rectangle> changed_;
};

}  // namespace tumble
