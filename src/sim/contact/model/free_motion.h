// Motion of bodies in a step as if neither contacts nor joints acted on them: by forces, by their own rotation, and on
// the paths of kinematic bodies. It tells whether a contact presses, and how hard.
#pragma once

#include "sim/contact/model/contact.h"
#include "sim/dynamics/forces.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// The forces of a span of time, and the velocities of the bodies at the start of its step: only those of kinematic
/// bodies are read.
struct FreeMotion {
    const ForceField& forces;
    std::span<const BodyVelocity> at_start;  // by body
    double from, to;                         // s
    double h;                                // s, length of the step

    /// m/s^2, world, of the center of a dynamic body.
    Vec3 by_forces(std::uint32_t body, const Body& state) const;
    /// m/s^2, world, of the body's point at `arm` from its center.
    Vec3 acceleration(std::uint32_t body, const Body& state, const Vec3& arm) const;
};

/// Gap of a contact as its acceleration depends on it. Arms (m, world) from the bodies' centers: to the points of a
/// CurvedGap, to the center of a BallOverFace, otherwise to the contact.
struct Gap {
    Vec3 normal;  // away from A
    Corners corners;
    PointGeometry geometry;
    Vec3 arm_a, arm_b;
};
Gap gap_of(const Manifold& manifold, int point, const Body& a, const Body& b);
/// The gaps of make_contacts(manifolds, bodies, contacts), in their order.
void make_gaps(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies, std::vector<Gap>& gaps);

/// Acceleration of the gap (m/s^2) from the accelerations of the points at its arms: negative if the contact presses.
/// Zero where the terms cancel up to rounding.
double gap_acceleration(const Gap& gap, const Body& a, const Body& b, const Vec3& of_a, const Vec3& of_b);

/// Speed (m/s) that the manifold's impulses of the last step took from the approach at one of its points.
double last_load(const Manifold& manifold, int point, const Body& a, const Body& b);

/// Speed (m/s) with which the bodies approach within a step at a point of their manifold because they are pressed
/// together, if nothing stops them. A contact that rests on a support approaches at this speed in each step; an impact
/// is faster. The larger one of two estimates:
/// - tuning::load_left of the speed that the manifold's impulses of the last step took from the approach: the load of
///   other bodies, joints and motors is in them;
/// - the acceleration of the gap by forces and by the motion of a kinematic body: for the first step of a load.
double load_speed(const Manifold& manifold, int point, const Body& a, const Body& b, const FreeMotion& free);

}  // namespace tumble
