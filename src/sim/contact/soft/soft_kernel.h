// The inner loops of the soft contact solver (soft_solver.h) over plain arrays of floats, many manifolds side by side,
// one lane each. Compiled for several instruction sets and selected at run time. Lanes never mix, every operation is
// one of the four basic ones or a square root, and nothing is fused: each lane gets the same bits at any width.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumble::soft {

template <class Real>
struct Vector3 {
    Real x, y, z;
};
template <class Real>
struct Symmetric3 {
    Real xx, xy, xz, yy, yz, zz;
};

/// Sum of the impulses of all substeps on B, and of their moments about A's center.
template <class Real>
struct TotalImpulse {
    Vector3<Real> linear, angular;
};

/// Data of a manifold's point: rows of a group, each as wide as the kernel's lanes (Real: a vector of all lanes; float:
/// the layout of one lane). World frame, SI units; impulses in N s of one substep. Members of a union belong to
/// successive phases: the first until prepare(), the second from then on.
template <class Real>
struct PointRows {
    union {
        Vector3<Real> arm;         // m, from A's center
        Vector3<Real> moment_arm;  // m, arm x normal
    };
    union {
        Real present;         // 1 in lanes that have this point, 0 in others
        Real effective_mass;  // kg
    };
    Real separation;  // m, at the start of the step
    Real gap;         // m, at present; set by prepare()
    union {
        Real load_share;  // Manifold::share
        Real lever;       // m, distance from the point where friction acts, times the spread
    };
    /// Change of the slips and of the spin per normal impulse, and of the normal speed per friction impulse; set by
    /// prepare().
    Vector3<Real> to_friction;
    Real impulse, impulse_sum;  // along the normal; the sum over the substeps
};

/// Data of a manifold, in the same way. A is the body whose center is nearer to the contact, or the one that moves:
/// arms start there, and the other's differ by `between`. Of friction vectors, x and y are along the two tangents, z
/// (N m s) is torsional, about the normal.
template <class Real>
struct ManifoldRows {
    Vector3<Real> normal;  // unit, away from A
    /// That of the last step, or zero, until prepare(); then unit, across the normal. The second is normal x tangent.
    Vector3<Real> tangent;
    Vector3<Real> between;       // m, from B's center to A's
    Vector3<Real> friction_arm;  // m, from A's center to the point where friction acts; set by prepare()
    union {
        Symmetric3<Real> inverse_inertia_a;  // from prepare() to sum()
        TotalImpulse<Real> total_impulse;    // set by sum()
    };
    Symmetric3<Real> inverse_inertia_b;  // set by prepare(), like the following masses
    struct {
        Real xx, xy, yy;
    } sticking_mass;      // kg, inverse of the compliance along the two tangents
    Real sliding_mass;    // kg, of the direction with the largest compliance
    Real torsional_mass;  // kg m^2
    Real friction_coefficient;
    Real size;                             // m, the smaller body's radius
    Vector3<Real> friction, friction_sum;  // impulses, and their sums over the substeps
    Real spread;                           // Manifold::spread
    Real coupling[6];  // 1/kg, change of speed at one point per normal impulse at another: 01, 02, 12, 03, 13, 23
    PointRows<Real> point[4];
};

/// Numbers of rows; a group has its manifolds' rows first, then the rows of their points, one point after the other.
inline constexpr std::size_t point_rows = sizeof(PointRows<float>) / sizeof(float),
                             group_rows = sizeof(ManifoldRows<float>) / sizeof(float),
                             manifold_rows = group_rows - 4 * point_rows;

/// One lane of a group by the names of its fields.
template <class Rows>
class LaneOf {
public:
    using Field = float Rows::*;
    using VectorField = Vector3<float> Rows::*;

    /// `first`: the lane's index in the first row; `stride`: number of lanes.
    LaneOf(float* first, std::size_t stride) : first_(first), stride_(stride) {}

    float& operator[](Field field) const { return first_[row(field) * stride_]; }
    template <class V>
    void set(VectorField field, const V& v) const {
        for (std::size_t k = 0; k < 3; ++k) first_[(row(field) + k) * stride_] = float(v[int(k)]);
    }
    Vector3<float> vector(VectorField field) const { return vector(row(field)); }

protected:
    Vector3<float> vector(std::size_t row) const {
        const float* r = first_ + row * stride_;
        return {r[0], r[stride_], r[2 * stride_]};
    }
    template <class T>
    static std::size_t row(T Rows::*field) {
        static constexpr Rows layout{};  // only its addresses are used
        return std::size_t(reinterpret_cast<const float*>(&(layout.*field)) - reinterpret_cast<const float*>(&layout));
    }

    float* first_;
    std::size_t stride_;
};

using PointLane = LaneOf<PointRows<float>>;
class ManifoldLane : public LaneOf<ManifoldRows<float>> {
public:
    using LaneOf::LaneOf;
    PointLane point(std::size_t i) const { return {first_ + (manifold_rows + i * point_rows) * stride_, stride_}; }
    auto total_impulse() const {
        const std::size_t first = row(&ManifoldRows<float>::total_impulse);
        return TotalImpulse<float>{vector(first), vector(first + 3)};
    }
};

/// Floats of a body: velocity and angular velocity (6), inverse mass, 1 unused; displacement and rotation (6) since the
/// start of the step, 2 unused.
inline constexpr int body_floats = 16, inverse_mass = 6;
/// Floats of its inverse inertia tensor (xx, xy, xz, yy, yz, zz), 2 unused.
inline constexpr int inertia_floats = 8;

/// Groups of one kernel's width.
struct Groups {
    float* rows = nullptr;                  // aligned to 64 bytes
    const std::uint32_t* bodies = nullptr;  // per group: offsets of the states of all lanes' A, then of all lanes' B
    const std::uint16_t* moved = nullptr;   // per group: bit mask of lanes whose A impulses move, then of lanes whose B
    const std::uint8_t* points = nullptr;   // per group: largest number of points of a lane
};
/// Bodies that impulses do not move are read and never written. Slot 0 stands still.
struct Bodies {
    float* state = nullptr;          // body_floats each, aligned to 64 bytes
    const float* inertia = nullptr;  // inertia_floats each
    // 8 floats per body, like the velocities: change by the forces per substep, and the velocities at the start of the
    // substep, forces included.
    const float* forces = nullptr;
    float* start = nullptr;
};

/// Constants of a soft constraint (soft_solver.h): overlap to velocity, 1/s; factors of mass and of the last impulse.
struct Softness {
    float bias_rate, mass_scale, impulse_scale;
};
struct Substep {
    float per_second;
    // for pairs that impulses move, of like or unlike masses; for pairs with a body that impulses do not move
    Softness alike, unlike, fixed;
    // Joints: share of the gap that is closed, 1/s, and share of the last impulse that a correction gives up.
    float joint_rate = 0.0f, joint_leak = 0.0f;
};

struct JointGroups;  // soft_joint_rows.h

struct Kernel {
    int lanes;
    /// Computes the rows that follow from arms, directions and masses (contact_constraint.h in double precision).
    void (*prepare)(const Groups&, std::size_t first, std::size_t last, const Bodies&);
    /// Applies the impulses kept from the last step to the bodies.
    void (*warm_start)(const Groups&, std::size_t first, std::size_t last, const Bodies&);
    /// Adds a substep's change by the forces to the velocities of the slots first to last. `again`: and the change by
    /// contact in the last substep. This equals a start from its impulses, at a cost per body instead of per contact.
    void (*accelerate)(std::size_t first, std::size_t last, const Bodies&, bool again);
    void (*move)(std::size_t first, std::size_t last, const Bodies&, float substep);
    /// correct: one sweep that removes overlaps softly. relax: after the bodies have moved, a sweep that removes the
    /// correction from the velocities and sums the impulses.
    void (*correct)(const Groups&, std::size_t first, std::size_t last, const Bodies&, const Substep&);
    void (*relax)(const Groups&, std::size_t first, std::size_t last, const Bodies&, const Substep&);
    /// The friction of shared areas alone (soft_areas.h), whose point has the loads of all manifolds. `counts`: adds it
    /// to the sums.
    void (*rub)(const Groups&, std::size_t first, std::size_t last, const Bodies&, bool counts);
    /// Adds the step's impulses into `force` and `moment`.
    void (*sum)(const Groups&, std::size_t first, std::size_t last);
    /// The same for joints; they are corrected and relaxed after the contacts of a sweep, and warm started in each
    /// substep.
    void (*prepare_joints)(const JointGroups&, std::size_t first, std::size_t last, const Bodies&);
    void (*warm_start_joints)(const JointGroups&, std::size_t first, std::size_t last, const Bodies&);
    void (*correct_joints)(const JointGroups&, std::size_t first, std::size_t last, const Bodies&, const Substep&);
    void (*relax_joints)(const JointGroups&, std::size_t first, std::size_t last, const Bodies&, const Substep&);
};

extern const Kernel sse2_kernel, avx2_kernel, avx512_kernel;

/// The widest kernel that this processor runs; narrower with the environment variable TUMBLE_LANES = 4, 8 or 16 (for
/// tests and measurements).
const Kernel& best_kernel();

}  // namespace tumble::soft
