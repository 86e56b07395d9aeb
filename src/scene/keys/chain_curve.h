// Where the links of a chain lie at the start.
#pragma once

#include "core/vector.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace tumble {

/// Corners of a chain of equal links, and its plane.
struct ChainCurve {
    std::vector<Vec3> corners;  // one more than links; of a loop, the last is the first
    Vec3 normal;                // of the plane: unit, horizontal unless the chain is a loop with another one
};

/// Along the straight line.
ChainCurve straight_chain(const Vec3& from, const Vec3& to, std::size_t links);

/// At rest under its weight: equal links, with tangents of their slopes that differ by the same amount from link to
/// link (the forces at both ends of a link have the same horizontal part, and differ by its weight). y is up. Empty if
/// there is none: the ends are above each other, or nearly so for so few links.
std::optional<ChainCurve> hanging_chain_of_length(const Vec3& from, const Vec3& to, std::size_t links, double length);

/// The same by the depth of its middle below the middle of its ends, m.
std::optional<ChainCurve> hanging_chain_of_sag(const Vec3& from, const Vec3& to, std::size_t links, double sag);

/// A regular polygon through `from`, about the middle between the two points.
ChainCurve closed_chain(const Vec3& from, const Vec3& to, std::size_t links, const std::optional<Vec3>& normal);

}  // namespace tumble
