#include "app/workers/panel_drawing.h"

#include <utility>

namespace tumble {
namespace {

RenderSwitches switches_for(const ClipPanel& panel, RenderSwitches options) {
    options.keep_depths = panel.overlay.has_value();
    return options;
}

}  // namespace

PanelDrawing::PanelDrawing(const ClipPanel& panel, const RenderSwitches& options)
    : renderer_(*panel.scene, switches_for(panel, options)),
      mean_(options.transparent),
      whole_{{0, 0, panel.scene->output.width, panel.scene->output.height}} {
    if (panel.overlay) painter_.emplace(*panel.scene, *panel.overlay);
}

void PanelDrawing::draw_samples(const SharedFrames& memory, std::size_t panel, std::int64_t frame) {
    const std::size_t moments = memory.moments(panel);
    const bool blurred = moments > 1;
    snapshot_.frame = frame;
    if (blurred && painter_) {
        memory.read_poses(panel, 0, snapshot_);
        renderer_.render(snapshot_);
        opening_depths_ = renderer_.depths();
        opening_camera_ = renderer_.camera();
    }
    for (std::size_t i = blurred ? 1 : 0; i < moments; ++i) {
        memory.read_poses(panel, i, snapshot_);
        image_ = &renderer_.render(snapshot_);
        if (blurred) mean_.add(*image_);
    }
    if (blurred) {
        mean_.take(blurred_);
        image_ = &blurred_;
    }
    // Between a sharp and a blurred image, the renderer does not know the changed regions.
    const bool blurred_before = std::exchange(blurred_last_, blurred);
    changed_ = blurred_before || blurred_last_ ? &whole_ : &renderer_.changed();
}

void PanelDrawing::draw(const SharedFrames& memory, std::size_t panel, std::int64_t frame) {
    draw_samples(memory, panel, frame);
    if (!painter_) return;
    read_bytes(memory.overlay(panel), shapes_);
    const DepthImage& depths = blurred_last_ ? opening_depths_ : renderer_.depths();
    const Camera& camera = blurred_last_ ? *opening_camera_ : renderer_.camera();
    image_ = &painter_->draw({*image_, *changed_, depths, camera}, shapes_);
    changed_ = &painter_->changed();
}

}  // namespace tumble
