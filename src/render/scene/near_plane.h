// The distance of the near plane, from the bodies in view.
#pragma once

#include "render/camera/camera.h"
#include "render/scene/render_scene.h"

namespace tumble {

/// How deep at least what is in view of a body lies, m.
double least_depth(const RenderBody& look, const RenderScene& looks, const BodyState& state, const BoundingBall& ball,
                   const Camera& view);

/// A near plane for what is in view: half the nearest body's distance, rounded down to a power of two, so that small
/// movements do not round all depths anew.
double near_distance_for(const RenderScene& looks, const Snapshot& snapshot, const Camera& view);

}  // namespace tumble
