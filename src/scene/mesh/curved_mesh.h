// The surfaces of curved shapes as triangles, for drawing.
#pragma once

#include "scene/description/description.h"

#include <memory>

namespace tumble {

/// Smooth, with sharp rims; the largest error is 0.05 % of a radius for round sides, 0.1 % for balls and ellipsoids.
/// `rows`: of triangles along the side of a cone. A texture bends within each. `coarser`: 2 or 4 divides the numbers of
/// sides and rings; all vertices stay on the surface.
std::shared_ptr<const MeshAsset> curved_mesh(const CurvedShape& shape, int rows = 1, int coarser = 1);

}  // namespace tumble
