// Uniform pressure over the polygon in which two faces meet, represented by the few points of a manifold.
//
// Friction of a uniform pressure on an area acts at the area's centroid and resists a spin about the normal by mu N d,
// with d the mean distance of the area from its centroid: 2/3 R for a disc. Four points on the rim have another mean
// and lie farther out. So each point gets a share of the load such that the mean is the centroid, and the manifold gets
// the factor (Manifold::spread) from the points' mean distance to the area's.
#pragma once

#include "sim/geometry/manifold.h"

#include <span>

namespace tumble {

struct ContactArea {
    Vec3 centroid = Vec3::Zero();  // world frame
    double mean_distance = 0.0;    // m, of the area from its centroid; 0: no area
    double size = 0.0;             // m^2; 0: a line or a point
};

/// `polygon`: convex, its corners in order about `normal`, in either sense, seen along the normal. A polygon without
/// area counts as a line.
ContactArea contact_area(std::span<const Vec3> polygon, const Vec3& normal);
ContactArea contact_area(std::span<const ContactPoint> polygon, const Vec3& normal);

/// The area that the shares, the spread and the area of `m` represent.
ContactArea contact_area(const Manifold& m);

/// Mean distance (m) of the area of `m` from any point of its plane: over the polygon of its points, moved and scaled
/// to the area's centroid and size. Precondition: an area.
double mean_distance(const Manifold& m, const Vec3& from);

/// Sets the shares of the points of `m`, its spread and its area.
void spread_pressure(const ContactArea& area, Manifold& m);

}  // namespace tumble
