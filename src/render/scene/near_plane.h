// The distance of the near plane, from the bodies in view.
#pragma once

#include "render/camera/camera.h"
#include "render/scene/render_scene.h"

namespace tumble {

/// Lower bound of the depth of the visible part of a body, m.
double least_depth(const RenderBody& proxy, const RenderScene& scene, const BodyState& state, const BoundingBall& ball,
                   const Camera& view);

/// Near distance: half of the nearest visible body's distance, rounded down to a power of two, so that small movements
/// do not round all depths differently.
double near_distance_for(const RenderScene& scene, const Snapshot& snapshot, const Camera& view);

}  // namespace tumble
