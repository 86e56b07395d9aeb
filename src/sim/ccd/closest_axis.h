// Axes along which two clouds may be apart. Only proposals: whatever is proposed here, separation_bound.h decides what
// is certain.
#pragma once

#include "sim/ccd/support_points.h"

#include <optional>

namespace tumble {

/// The vector from the nearest point of A's hull to that of B's (Gilbert, Johnson, Keerthi 1988), roundings left out;
/// none when the hulls overlap or touch. `guess`: any direction, last time's is best.
std::optional<Vec3> closest_vector(const SupportPoints& a, const SupportPoints& b, const Vec3& guess);

/// The axis with that normal, turning as the features do that meet along it: with a face, with a pair of edges, or with
/// the line between two points. `tolerance` (m): points within it of the farthest belong to the feature.
Axis tracking_axis(const SupportPoints& a, const SupportPoints& b, const Vec3& normal, double tolerance);

}  // namespace tumble
