// Joints of nets in the soft kernel: data of a joint, one lane each, beside the manifolds of soft_kernel.h.
//
// A point joint (a ball) keeps two anchors together, a distance joint their distance within [shortest, longest]. Both
// give a force alone, f on B and -f on A, at B's anchor. The arms turn with the bodies, from substep to substep, as the
// poses will: R(t) with the rotation vector t since the start of the step.
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
    // about B's center exceeds that of bodies that stay at their places.
    Vector3<Real> impulse_sum, moment_sum, carried_sum;
};

inline constexpr std::size_t joint_rows = sizeof(JointRows<float>) / sizeof(float);

/// A group has joints of one kind.
enum class JointKind : std::uint8_t { point, distance };

/// Groups of one kernel's width, as Groups.
struct JointGroups {
    float* rows = nullptr;
    const std::uint32_t* bodies = nullptr;
    const std::uint16_t* moved = nullptr;
    const JointKind* kinds = nullptr;
};

using JointLane = LaneOf<JointRows<float>>;

}  // namespace tumble::soft
