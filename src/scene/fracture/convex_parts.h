// The convex polyhedra of which a body consists.
#pragma once

#include "scene/description/description.h"
#include "scene/fracture/convex_cell.h"

#include <optional>
#include <vector>

namespace tumble {

struct ConvexPart {
    ConvexCell cell;     // m, the body's frame
    ConvexCell drawn;    // with the surface that is drawn; empty: the same
    const Shape* shape;  // of the part, in its own frame
    Vec3 position;       // of that frame, m
    Quat rotation;
    double density;  // kg/m^3
    std::optional<Color> color;
    bool visible;
};

/// Curved shapes as polyhedra with corners on their surface, and finer ones to be drawn. Throws InputError, with the
/// remedy, for shapes that are no union of convex parts beside each other.
std::vector<ConvexPart> convex_parts(const BodyDescription& body);

}  // namespace tumble
