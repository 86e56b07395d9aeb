#include "app/workers/panel_drawing.h"

#include "render/render_switches.h"

#include <utility>

namespace tumble {

void PanelDrawing::draw(const SharedFrames& memory, std::size_t panel, std::int64_t frame) {
    const std::size_t samples = memory.samples(panel);
    snapshot_.frame = frame;
    for (std::size_t i = 0; i < samples; ++i) {
        memory.read_poses(panel, i, snapshot_);
        drawn_ = &renderer_.render(snapshot_);
        if (samples > 1) mean_.add(*drawn_);
    }
    if (samples > 1) mean_.take(blurred_);
    const bool blurred_before = std::exchange(blurred_last_, samples > 1);
    // Between a sharp and a blurred image, the renderer does not know the changed regions.
    if (blurred_before || blurred_last_)
        changed_.assign(1, {0, 0, drawn_->width, drawn_->height});
    else
        changed_ = renderer_.changed();
}

}  // namespace tumble
