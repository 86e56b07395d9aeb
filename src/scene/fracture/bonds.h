// Bonds between cells that touch; m, the body's frame.
#pragma once

#include "scene/description/fracture.h"
#include "scene/fracture/convex_cell.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// Area, center, principal axes and moments of a convex polygon in a plane, as a bond. Empty if its area is at most
/// `least_area` (m^2).
std::optional<Bond> section_of(std::span<const Vec3> polygon, const Vec3& normal, double least_area);

struct BondRequest {
    std::span<const ConvexCell> cells;
    std::span<const Vec3> centers;  // m, of mass
    double tolerance;               // m, between faces that touch
    double least_area;              // m^2
};

/// Bonds of all pairs of cells, by a, then by b.
std::vector<Bond> find_bonds(const BondRequest& request);

/// Appends bonds to the world of the cells with an outer face in a held side of the bounds.
void hold_to_world(const BondRequest& request, const Bounds& bounds, const std::array<bool, 6>& held,
                   std::vector<Bond>& bonds);

}  // namespace tumble
