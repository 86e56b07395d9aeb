// From loaded scenes to the composition of a clip.
#pragma once

#include "app/composition/composition.h"
#include "app/composition/frame_layout.h"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// A scene of the clip, and the rate at which it is simulated.
struct ClipScene {
    std::shared_ptr<const SceneDescription> scene;
    std::string label;  // above its panel
    FrameTiming timing;
    std::vector<int> steps = {};  // where its speed changes: of each interval of the shutter, by frame (clip_speed.h)
};

struct CompositionOptions {
    PanelArrangement arrangement = PanelArrangement::automatic;
    std::size_t plot_panels = 0;  // axes of the plot; 0: no plot
    PlotPlace plot_place = PlotPlace::inset;
    double last_time = 0.0;  // s, of the clip's last frame
};

/// The frame has the size of the first scene. Title, clock, mode and captions are shown once, those of the first scene
/// that shows them. Figures of plots are left empty but for their style. Throws InputError if the frame is too small.
Composition make_composition(std::span<const ClipScene> scenes, const CompositionOptions& options);

/// Gives a panel's scene that camera and its insets, and that of the AOVs if it is the first one.
void place_camera(Composition& composition, std::size_t panel, const SceneDescription& scene,
                  const CameraDescription& camera);

/// The scene for a panel of that size. Its camera shows at least the view of the scene: where the panel is narrower
/// than the scene's frame, the vertical field of view is wider.
SceneDescription panel_scene(const SceneDescription& scene, int width, int height);

}  // namespace tumble
