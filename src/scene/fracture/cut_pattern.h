// Patterns of cuts through a body; m, the body's frame.
#pragma once

#include "core/random.h"
#include "scene/description/fracture.h"
#include "scene/fracture/convex_cell.h"

#include <cstddef>
#include <vector>

namespace tumble {

/// The space between the sides, cut by planes one behind the other.
struct CutStrip {
    std::vector<CutPlane> sides, cuts;
};

/// Points of the body's surface.
struct CutExtent {
    std::vector<Vec3> corners;
    Bounds bounds;
};

/// The strips of slabs, bricks and the radial pattern, which fill the space.
std::vector<CutStrip> cut_strips(const FractureRequest& request, const CutExtent& extent, Random& random);

/// Lengths and volumes that count as nothing.
struct CutTolerance {
    double length;        // m, of rounding
    double least_volume;  // m^3: smaller cells are merged into neighbors
    double no_volume;     // m^3: a strip of less is dropped
};

/// Appends the cells of a convex part.
void cut_by_strips(const ConvexCell& part, const std::vector<CutStrip>& strips, const CutTolerance& tolerance,
                   std::vector<ConvexCell>& cells);

/// Random points in a convex part, apart from each other, or denser near a focus. Throws InputError where they find no
/// room.
std::vector<Vec3> draw_sites(const ConvexCell& part, std::size_t count, const std::optional<Vec3>& focus,
                             Random& random);

/// Appends the Voronoi cells of sites in a convex part.
void cut_by_sites(const ConvexCell& part, std::vector<Vec3> sites, const CutTolerance& tolerance,
                  std::vector<ConvexCell>& cells);

}  // namespace tumble
