// Separation of two convex shapes in motion: candidate axes, and along an axis a lower bound of the time for which the
// bodies stay apart.
//
// The bound is that of second-order conservative advancement (after Mirtich 1996,
// "Impulse-based dynamic simulation of rigid body systems", section 2.3, with a bound on accelerations instead of
// speeds).
//
// Along an axis n(s) that rotates uniformly, the gap is f(s) = min over points b of B and a of A of n(s).(b(s) - a(s)),
// less the rounding. While f > 0 the axis separates the bodies: certainty needs no search for the true distance. Each
// pair's f_ab is known with its rate at s = 0 and f_ab'' >= -Q, so that f(s) >= min (f_ab + f_ab' s) - Q s^2 / 2, whose
// first root is found exactly. Near the impact the step's error is of second order: the search converges quadratically,
// and never passes over a first contact.
#pragma once

#include "sim/ccd/trajectory.h"
#include "sim/geometry/shapes/curved.h"

#include <optional>
#include <vector>

namespace tumble {

/// A convex shape at one time for the search for impacts: points about a center, rounded by a radius, with bounds of
/// their further motion. A ball is one point with a radius, a polyhedron its vertices, a half-space the point of its
/// plane below the other body. A curved body has no points but its support function.
struct SupportPoints {
    Vec3 center = Vec3::Zero();            // m, world
    Vec3 velocity = Vec3::Zero();          // m/s, of the center
    Vec3 acceleration = Vec3::Zero();      // m/s^2, of the center
    double acceleration_change = 0.0;      // m/s^2: bound of the deviation of the acceleration from the present one
    Vec3 angular_velocity = Vec3::Zero();  // rad/s
    double spin_bound = 0.0;               // rad/s, Trajectory::spin_bound()
    double turning_bound = 0.0;            // rad/s^2, Trajectory::turning_bound()
    double radius = 0.0;                   // m, of the rounding
    double reach = 0.0;                    // m, length of the longest arm
    std::vector<Vec3> arms;                // m, from the center, world axes
    const CurvedBody* curved = nullptr;
    Vec3 place = Vec3::Zero();         // m, of the curved body's origin from the center, world axes
    Mat3 rotation = Mat3::Identity();  // of the curved body
};

/// An axis from A to B that rotates with the features that it separates.
struct TrackedAxis {
    Vec3 normal = Vec3::UnitY();  // unit
    Vec3 rate = Vec3::Zero();     // 1/s, perpendicular to the normal
};

// Candidate axes are only proposals: bound_separation() computes the certain bound along a proposed axis.

/// The vector from the nearest point of A's hull to that of B's (Gilbert, Johnson, Keerthi 1988), up to rounding; none
/// when the hulls overlap or touch. `guess`: any direction; the last result is best.
std::optional<Vec3> closest_vector(const SupportPoints& a, const SupportPoints& b, const Vec3& guess);

/// The axis with that normal, rotating with the features that meet along it: with a face, with a pair of edges, or with
/// the line between two points. `tolerance` (m): points within it of the farthest belong to the feature.
TrackedAxis tracking_axis(const SupportPoints& a, const SupportPoints& b, const Vec3& normal, double tolerance);

struct SeparationBound {
    double gap = 0.0;        // m, f(0)
    double rate = 0.0;       // m/s, least rate of the nearest points
    double curvature = 0.0;  // m/s^2, Q
    double safe_time = 0.0;  // s; gaps below zero count as zero
};

/// Valid up to `horizon` s: safe_time is limited to it. `nearest` (m): points within it of the nearest pair count as
/// nearest.
SeparationBound bound_separation(const SupportPoints& a, const SupportPoints& b, const TrackedAxis& axis,
                                 double horizon, double nearest);

}  // namespace tumble
