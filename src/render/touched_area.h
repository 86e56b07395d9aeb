// The part of the picture in which a plane can show shadows or be darkened by bodies: a rectangle of pixels. Outside of it
// the plane is drawn by a shader that looks for neither, to the same result.
#pragma once

#include "render/occlusion_atlas.h"
#include "render/plane_patch.h"
#include "render/shadow_fit.h"

namespace tumble {

/// Pixels from x0 to before x1, y0 to before y1, from the top left corner. Empty when x0 >= x1.
struct PixelArea {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool empty() const { return x0 >= x1 || y0 >= y1; }
};

PixelArea touched_area(const PlanePatch& plane, const SceneDescription& scene, const SceneLooks& looks,
                       const Snapshot& snapshot, const CameraView& view, const ShadowFit& shadows);

}  // namespace tumble
