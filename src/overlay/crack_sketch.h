// The faces between the cells of bodies with `fracture`, for overlays. Made once for a scene.
#pragma once

#include "core/vector.h"
#include "scene/description/description.h"

#include <cstddef>
#include <vector>

namespace tumble {

struct CrackSketch {
    std::size_t whole = 0;      // index into bodies: the body that is cut
    std::size_t a = 0, b = 0;   // indices into bodies: the pieces on both sides
    std::vector<Vec3> outline;  // m, closed, in the frame that the whole and its pieces share
};

/// The faces that have bonds, of all bodies whose cracks overlays show.
std::vector<CrackSketch> sketch_cracks(const SceneDescription& scene);

}  // namespace tumble
