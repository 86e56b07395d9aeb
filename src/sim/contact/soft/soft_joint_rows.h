// Joints of nets in the soft kernel: data of a joint, one lane each, beside the manifolds of soft_kernel.h.
//
// A point joint (a ball) keeps two anchors together, a distance joint their distance within [shortest, longest]. Both
// give a force, f on B and -f on A, at B's anchor. The arms turn with the bodies, from substep to substep, as the
// poses will: R(t) with the rotation vector t since the start of the step.
//
// A turning joint is a point joint that also gives a torque: it locks or limits turns about up to three axes, which
// turn with A (AngularRows). A driven joint is one with dampers or friction too.
#pragma once

#include "sim/contact/soft/soft_kernel.h"

#include <cstddef>
#include <cstdint>

namespace tumble::soft {

/// Data of a joint, laid out as ManifoldRows. World frame, SI units; impulses in N s of one substep.
template <class Real>
struct JointRows {
    Vector3<Real> arm_a, arm_b;  // m, from the body's center to its own anchor, at the start of the step
    Vector3<Real> apart;         // m, from A's anchor to B's, at the start of the step
    // At present: from A's and B's center to B's anchor, from A's anchor to B's, and how far A's center has moved
    // farther than B's since the start of the step, m.
    Vector3<Real> now_a, now_b, gap, parted;
    Vector3<Real> direction;  // unit, along the gap: of a distance joint
    Real shortest, longest;   // m, of a distance joint
    Real present;             // 1 in lanes with a joint, 0 in others
    Symmetric3<Real> mass;    // kg, inverse of the compliance at the anchors; of a distance joint xx alone
    Vector3<Real> impulse;    // on B; of a distance joint x alone, along the direction
    Symmetric3<Real> inertia_a, inertia_b;  // 1/(kg m^2), inverse tensors
    // Sums over the substeps, on B: impulses, their moments about A's center, and parted x impulse, by which the moment
    // about B's center exceeds that of bodies that stay where they are.
    Vector3<Real> impulse_sum, moment_sum, carried_sum;
};

inline constexpr std::size_t joint_rows = sizeof(JointRows<float>) / sizeof(float);

/// The turns of a turning joint, in the same lanes. Components of a vector belong to the three axes, unless stated.
/// The coordinates are n . r, with r the rotation vector of B relative to A since the start of the step and n an axis,
/// both in a frame that turns with A; and small terms of second order, see `bend` and `circle`.
template <class Real>
struct AngularRows {
    Vector3<Real> axis_x, axis_y, axis_z;  // unit, world, at the start of the step
    Vector3<Real> now_x, now_y, now_z;     // the same at present
    Vector3<Real> least, most;             // rad, limits of the coordinates; locked ones have two equal limits
    Vector3<Real> locked;                  // 1: locked, 0: within the limits
    Vector3<Real> turned;                  // rad, the coordinates at present
    Vector3<Real> bend;  // coordinate x grows by bend.x y z, and so on: of two turns in sequence, as of a cross
    Real circle, twist;  // coordinate y grows by (circle z + twist x)^2: of a swing along the border of a cone
    // In a round cone the axes follow the swing: x halfway between the twist axes of A and B, y the axis of the swing.
    // Coordinate y is the sine of the angle beyond the cone.
    Real round;  // 1: of a round cone, otherwise 0
    Real limit_sine, limit_cosine;
    Vector3<Real> twist_a, twist_b;        // unit, world, at the start of the step
    Vector3<Real> pull_x, pull_y, pull_z;  // 1/kg m, speed at the anchors by an impulse about each axis
    // 1/(kg m^2), compliance about the axes where the anchors stay together: less what the force gives back.
    Symmetric3<Real> gives;
    Vector3<Real> single;      // kg m^2, inverse of its diagonal
    Symmetric3<Real> mass;     // kg m^2, inverse of the compliance of the locked axes
    Vector3<Real> impulse;     // N m s, on B
    Vector3<Real> torque_sum;  // N m s, world, of all substeps
    // Driven joints. Dampers: the compliance 1/(d C) of a substep d, 1/(kg m^2), 0 without one; and the inverse of all
    // compliance. Friction about the axes that have `rubs` 1: its largest impulse, N m s, and the increase of that with
    // the impulse of the force, m.
    Vector3<Real> softness, damps, damping, rubs, friction;
    Real rough, bearing;
    Vector3<Real> damping_sum, friction_sum;  // N m s, world
};

inline constexpr std::size_t angular_rows = sizeof(AngularRows<float>) / sizeof(float);

/// A group has joints of one kind.
enum class JointKind : std::uint8_t { point, distance, turning, driven };
inline constexpr std::size_t joint_kinds = 4;
inline constexpr bool turns(JointKind kind) { return kind >= JointKind::turning; }

/// Groups of one kernel's width, as Groups.
struct JointGroups {
    float* rows = nullptr;
    const std::uint32_t* bodies = nullptr;
    const std::uint16_t* moved = nullptr;
    const JointKind* kinds = nullptr;
    float* turns = nullptr;                          // of the groups that turn
    const std::uint32_t* angular_indices = nullptr;  // by group: its index among groups that turn
};

using JointLane = LaneOf<JointRows<float>>;
using AngularLane = LaneOf<AngularRows<float>>;

}  // namespace tumble::soft
