// Candidate axes of separation of two point sets. Only proposals: separation_bound.h computes the certain bound along a
// proposed axis.
#pragma once

#include "sim/ccd/support_points.h"

#include <optional>

namespace tumble {

/// The vector from the nearest point of A's hull to that of B's (Gilbert, Johnson, Keerthi 1988), up to rounding; none
/// when the hulls overlap or touch. `guess`: any direction; the last result is best.
std::optional<Vec3> closest_vector(const SupportPoints& a, const SupportPoints& b, const Vec3& guess);

/// The axis with that normal, rotating with the features that meet along it: with a face, with a pair of edges, or with
/// the line between two points. `tolerance` (m): points within it of the farthest belong to the feature.
Axis tracking_axis(const SupportPoints& a, const SupportPoints& b, const Vec3& normal, double tolerance);

}  // namespace tumble
