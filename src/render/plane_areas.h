// Which shader a plane needs where: a dear one where shadows or the bodies' darkening may touch it, a cheap one that
// looks for neither (to the same result) elsewhere, and none where boxes cover it. Decided for the cells of ScreenCover
// and joined into rectangles.
#pragma once

#include "render/plane_patch.h"
#include "render/shadow_fit.h"
#include "render/visibility.h"

#include <vector>

namespace tumble {

struct PlaneAreas {
    std::vector<PixelArea> touched, open;
};

PlaneAreas find_plane_areas(const PlanePatch& plane, const SceneDescription& scene, const SceneLooks& looks,
                            const Snapshot& snapshot, const CameraView& view, const ShadowFit& shadows,
                            const ScreenCover& cover);

}  // namespace tumble
