// The legend of the overlays: the meaning of each mark, and the scale of each arrow.
#pragma once

#include "core/image.h"
#include "overlay/overlay_scales.h"
#include "scene/description/description.h"

#include <optional>

namespace tumble {

/// A picture with straight alpha; empty if no overlay needs an explanation. `height`: of the frame, pixels.
std::optional<Image> draw_legend(const SceneDescription& scene, const OverlayScales& scales, const OverlayMarks& marks,
                                 int height);

}  // namespace tumble
