// The legend of the overlays: the meaning of each mark, and the scale of each arrow.
#pragma once

#include "core/image.h"
#include "overlay/overlay_scales.h"
#include "scene/description/description.h"

#include <optional>

namespace tumble {

/// The scales and the legend of the shapes over a scene. They are found before the first frame.
struct PanelOverlay {
    OverlayScales scales{};
    OverlayMarks marks{};
    bool legend = false;
    double frame_step = 1.0 / 60.0;  // s of the scene's motion from frame to frame
    int frame_height = 720;          // pixels, of the whole frame: the legend has a size that suits it
    int legend_top = 0;              // pixels, from the upper edge of the panel
};

/// A picture with straight alpha; empty if no overlay needs an explanation.
std::optional<Image> draw_legend(const SceneDescription& scene, const PanelOverlay& overlay);

}  // namespace tumble
