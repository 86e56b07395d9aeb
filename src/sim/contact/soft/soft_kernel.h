// The inner loops of the soft contact solver (soft_solver.h) over plain arrays of floats, many manifolds side by side,
// one lane each. Compiled for several instruction sets and selected at run time. Lanes never mix, every operation is
// one of the four basic ones or a square root, and nothing is fused: each lane gets the same bits at any width.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumble::soft {

/// Rows of a group, each as wide as the kernel's lanes. World frame, SI units; impulses in N s of one substep. A is the
/// body whose center is nearer to the contact, or the one that moves: arms start there, and the other's differ by
/// `between`.
enum Head : int {
    normal = 0,  // 3: away from A
    // 3: on entry that of the last step, or zero; then unit, across the normal. The second is normal x tangent_1
    tangent_1 = 3,
    between = 6,       // 3: m, from B's center to A's
    friction_arm = 9,  // 3: m, from A's center to the point where friction acts
    inertia_a = 12,    // 6: inverse inertia tensor of A
    force = 12,        // 3: on return, the sum of all impulses on B
    moment = 15,       // 3: on return, the sum of their moments about A's center
    inertia_b = 18,
    stick_mass = 24,  // 3: inverse of the two-by-two compliance: 11, 12, 22
    slide_mass = 27,  // of the direction with the largest compliance
    twist_mass = 28,
    friction_coefficient = 29,
    size = 30,        // m, the smaller body's radius
    friction_1 = 31,  // these three side by side,
    friction_2 = 32,
    twist = 33,
    friction_1_sum = 34,  // sums of the three over the substeps
    friction_2_sum = 35,
    twist_sum = 36,
    spread = 37,    // Manifold::spread
    coupling = 38,  // 6: change of speed at one point per normal impulse at another, 1/kg: 01, 02, 12, 03, 13, 23
    head_rows = 44
};
enum Point : int {
    turn = 0,         // 3: m, arm from A's center; prepare() replaces it by arm x normal
    normal_mass = 3,  // on entry 1 in lanes that have this point, 0 in others; then the effective mass, kg
    separation = 4,   // m, at the start of the step
    gap = 5,          // m, at present; unset on entry
    lever = 6,        // on entry Manifold::share; then m: distance from the point where friction acts, times the spread
    // 3: change of the slips and of the spin per normal impulse, and of the normal speed per friction impulse
    to_friction = 7,
    impulse = 10,
    impulse_sum = 11,
    point_rows = 12
};
inline constexpr int group_rows = head_rows + 4 * point_rows;

/// Floats of a body: velocity and angular velocity (6), inverse mass, 1 unused; displacement and rotation (6) since the
/// start of the step, 2 unused.
inline constexpr int body_floats = 16, inverse_mass = 6;
/// Floats of its inverse inertia tensor (xx, xy, xz, yy, yz, zz), 2 unused.
inline constexpr int inertia_floats = 8;

/// Groups of one kernel's width.
struct Groups {
    float* rows = nullptr;                  // aligned to 64 bytes
    const std::uint32_t* bodies = nullptr;  // per group: offsets of the states of all lanes' A, then those of B
    const std::uint16_t* moved = nullptr;   // per group: bit mask of lanes whose A impulses move, then of those whose B
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

/// Of a soft constraint (soft_solver.h): overlap to velocity, 1/s; factors of the mass and of the last impulse.
struct Softness {
    float bias_rate, mass_scale, impulse_scale;
};
struct Substep {
    float per_second;
    // for pairs that impulses move, of like or unlike masses; for pairs with a body that impulses do not move
    Softness alike, unlike, fixed;
};

struct Kernel {
    int lanes;
    /// Computes the rows that follow from arms, directions and masses (contact_constraint.h in double precision).
    void (*prepare)(const Groups&, std::size_t first, std::size_t last, const Bodies&);
    /// Applies the impulses kept from the last step to the bodies.
    void (*warm_start)(const Groups&, std::size_t first, std::size_t last, const Bodies&);
    /// Adds a substep's change by the forces to the velocities of the slots first to last. `again`: and the change by
    /// contact in the last substep. This equals a start from its impulses, at a cost per body in place of per contact.
    void (*accelerate)(std::size_t first, std::size_t last, const Bodies&, bool again);
    void (*move)(std::size_t first, std::size_t last, const Bodies&, float substep);
    /// push: one sweep that removes overlaps softly. relax: after the bodies have moved, a sweep that removes the push
    /// from the velocities and sums the impulses.
    void (*push)(const Groups&, std::size_t first, std::size_t last, const Bodies&, const Substep&);
    void (*relax)(const Groups&, std::size_t first, std::size_t last, const Bodies&, const Substep&);
    /// Adds the step's impulses into `force` and `moment`.
    void (*sum)(const Groups&, std::size_t first, std::size_t last);
};

extern const Kernel sse2_kernel, avx2_kernel, avx512_kernel;

/// The widest kernel that this processor runs; narrower with the environment variable TUMBLE_LANES = 4, 8 or 16 (for
/// tests and measurements).
const Kernel& best_kernel();

}  // namespace tumble::soft
