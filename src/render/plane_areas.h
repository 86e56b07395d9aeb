// Which shader a plane needs where: a dear one where shadows or the bodies' darkening may touch it, a cheap one that
// looks for neither (to the same result) elsewhere, and none where boxes cover it. Decided for the cells of ScreenCover
// and joined into rectangles.
#pragma once

#include "core/rectangle.h"
#include "render/plane_patch.h"
#include "render/shadow_fit.h"
#include "render/tile_marks.h"
#include "render/visibility.h"

#include <vector>

namespace tumble {

struct PlaneAreas {
    std::vector<Rectangle> touched, open;
};

/// Within the marked tiles.
PlaneAreas find_plane_areas(const PlanePatch& plane, const SceneDescription& scene, const SceneLooks& looks,
                            const Snapshot& snapshot, const CameraView& view, const ShadowFit& shadows,
                            const ScreenCover& cover, const TileMarks& marks);

}  // namespace tumble
