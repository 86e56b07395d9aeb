// The poses of a frame, which is the mean, in linear light, of images at several times while the shutter is open.
#pragma once

#include "render/aov/aov_renderer.h"
#include "sim/snapshot/snapshot.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// The moments of a panel: the frame's own, when the shutter opens; with motion blur its samples follow.
using PanelPoses = std::vector<Snapshot>;

/// The moments whose images are averaged.
inline std::span<Snapshot> drawn_moments(PanelPoses& poses) {
    return std::span(poses).subspan(poses.size() > 1 ? 1 : 0);
}

/// Content of one frame. The poses of the panels are omitted if no image is requested, or if it equals that of the
/// previous frame; the poses for the AOVs likewise.
struct MotionBlurFrame {
    std::int64_t frame = 0;
    double time = 0.0;  // s, when the shutter opens
    std::vector<PanelPoses> panels;
    std::vector<std::vector<std::byte>> overlays;  // by panel: its OverlayFrame as bytes, or none
    std::optional<AovPoses> aovs;                  // the true poses at the frame's own time, when the shutter opens
};

}  // namespace tumble
