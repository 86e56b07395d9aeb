// The inner loops of the soft contact solver (soft_solver.h) over plain arrays of floats, many manifolds side by side: one
// lane each. Compiled for several instruction sets and chosen at run time. Lanes never mix, every operation is the four
// basic ones or a square root, and nothing is fused: each lane gets the same bits whatever the width.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumble::soft {

/// Rows of a group, each as wide as the kernel's lanes. World frame, SI units; impulses in N s of one substep. A is the body
/// whose centre is nearer to the contact, or the one that moves: arms go from there, and the other's differ by `between`.
enum Head : int {
    normal = 0,            // 3: away from A
    tangent_1 = 3,         // 3: of the last step, or nothing; then across the normal. The second is normal x tangent_1
    between = 6,           // 3: from B's centre to A's
    friction_arm = 9,      // 3: from A's centre to where friction acts
    inertia_a = 12,        // 6: inverse tensor
    force = 12,            // 3: in the end, the sum of all impulses on B
    moment = 15,           // 3: and of their moments about A's centre
    inertia_b = 18,
    stick_mass = 24,       // 3: inverse of the two-by-two compliance: 11, 12, 22
    slide_mass = 27,       // of the direction that gives way most
    twist_mass = 28,
    friction_coefficient = 29,
    size = 30,             // m, the smaller body's radius
    friction_1 = 31,       // these three side by side,
    friction_2 = 32,
    twist = 33,
    friction_1_sum = 34,   // and their sums over the substeps
    friction_2_sum = 35,
    twist_sum = 36,
    spread = 37,           // Manifold::spread
    coupling = 38,         // 6: what a normal impulse at one point adds to the speed at another, 1/kg: 01, 02, 12, 03, 13, 23
    head_rows = 44
};
enum Point : int {
    turn = 0,              // 3: arm from A's centre; then replaced by arm x normal
    normal_mass = 3,       // 1 in lanes that have this point, 0 in others; then the effective mass, kg
    separation = 4,        // m, when the step began
    gap = 5,               // m, now; nothing on entry
    lever = 6,             // Manifold::share; then m: the distance from where friction acts, times the spread
    to_friction = 7,       // 3: what its normal impulse adds to the slips and to the twist's speed, and they to its
    impulse = 10,
    impulse_sum = 11,
    point_rows = 12
};
inline constexpr int group_rows = head_rows + 4 * point_rows;

/// A body's floats: velocity and angular velocity (6), inverse mass, 1 unused; displacement and turn (6) since the step
/// began, 2 unused.
inline constexpr int body_floats = 16, inverse_mass = 6;
/// Its inverse inertia tensor (xx, xy, xz, yy, yz, zz), 2 unused.
inline constexpr int inertia_floats = 8;

/// Groups of one kernel's width.
struct Groups {
    float* rows = nullptr;                     // aligned to 64 bytes
    const std::uint32_t* bodies = nullptr;     // of each group: where the states of all lanes' A begin, then those of B
    const std::uint16_t* moved = nullptr;      // of each group: bits of the lanes whose A impulses move, then of those whose B
    const std::uint8_t* points = nullptr;      // most of any lane
};
/// What impulses do not move is read and never written. Slot 0 stands still.
struct Bodies {
    float* state = nullptr;                    // body_floats each, aligned to 64 bytes
    const float* inertia = nullptr;            // inertia_floats each
    // 8 each, like the velocities: what a substep's forces add, and the velocities it began with, forces included.
    const float* forces = nullptr;
    float* start = nullptr;
};

/// Of a soft constraint (soft_solver.h): overlap to velocity, 1/s; factors of the mass and of the impulse before.
struct Softness {
    float bias_rate, mass_scale, impulse_scale;
};
struct Substep {
    float per_second;
    Softness alike, unlike, fixed;   // of pairs that both move, of like masses or not, and of those with a body that impulses do not move
};

struct Kernel {
    int lanes;
    /// Fills what follows from arms, directions and masses (as contact_patch.h does it in double precision).
    void (*prepare)(const Groups&, std::size_t first, std::size_t last, const Bodies&);
    /// Gives the bodies the impulses kept from the last step.
    void (*warm_start)(const Groups&, std::size_t first, std::size_t last, const Bodies&);
    /// Velocities take their share of the forces, slots first to last. `again`: and what contact did in the substep before,
    /// which is the same as starting from its impulses, in the time of a body in place of that of its contacts.
    void (*accelerate)(std::size_t first, std::size_t last, const Bodies&, bool again);
    void (*move)(std::size_t first, std::size_t last, const Bodies&, float substep);
    /// One sweep with overlaps pushed out softly; then, after the bodies have moved, one that takes the push back out of
    /// the velocities and adds up the impulses.
    void (*push)(const Groups&, std::size_t first, std::size_t last, const Bodies&, const Substep&);
    void (*relax)(const Groups&, std::size_t first, std::size_t last, const Bodies&, const Substep&);
    /// Sums the step's impulses up into `force` and `moment`.
    void (*sum)(const Groups&, std::size_t first, std::size_t last);
};

extern const Kernel sse2_kernel, avx2_kernel, avx512_kernel;

/// The widest this processor runs; narrower with the environment's TUMBLE_LANES = 4, 8 or 16 (for tests and measurements).
const Kernel& best_kernel();

}  // namespace tumble::soft
