// The inner loops of the soft contact solver (soft_solver.h) over plain arrays of floats, many manifolds side by side: one
// lane each. Compiled for several instruction sets and chosen at run time. Lanes never mix, every operation is the four
// basic ones or a square root, and nothing is fused: each lane gets the same bits whatever the width.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumble::soft {

/// Rows of a group, each as wide as the kernel's lanes. World frame, SI units; impulses in N s of one substep.
enum Head : int {
    normal = 0,            // 3: away from A
    tangent_1 = 3,         // 3: of the last step, or nothing; then across the normal
    tangent_2 = 6,         // 3: normal x tangent_1
    turn_1_a = 9,          // 3: arm x tangent_1, from A's centre to where friction acts
    turn_1_b = 12,         // 3
    turn_2_a = 15,
    turn_2_b = 18,
    spin_1_a = 21,         // 3: I^-1 (arm x tangent_1)
    force = 21,            // 3: in the end, the sum of all impulses on B
    spin_1_b = 24,
    moment = 24,           // 3: and of their moments about A's centre
    spin_2_a = 27,
    spin_2_b = 30,
    spin_n_a = 33,         // 3: I^-1 n, of the twist
    spin_n_b = 36,
    stick_mass = 39,       // 3: inverse of the two-by-two compliance: 11, 12, 22
    slide_mass = 42,       // of the direction that gives way most
    twist_mass = 43,
    inverse_mass_a = 44,
    inverse_mass_b = 45,
    friction_coefficient = 46,
    bias_rate = 47,        // 1/s: overlap to velocity
    mass_scale = 48,       // of the soft constraint
    impulse_scale = 49,
    size = 50,             // m, the smaller body's radius
    friction_1 = 51,
    friction_2 = 52,
    twist = 53,
    friction_1_sum = 54,   // over the substeps
    friction_2_sum = 55,
    twist_sum = 56,
    head_rows = 57
};
enum Point : int {
    arm_a = 0,             // 3; then replaced by arm x normal
    arm_b = 3,
    spin_a = 6,            // 3: I^-1 (arm x normal)
    spin_b = 9,
    normal_mass = 12,      // 1 in lanes that have this point, 0 in others; then the effective mass, kg
    separation = 13,       // m, when the step began
    lever = 14,            // m, from where friction acts; nothing on entry
    impulse = 15,
    impulse_sum = 16,
    point_rows = 17
};
inline constexpr int group_rows = head_rows + 4 * point_rows;

/// A body's floats: velocity and angular velocity (6), 2 unused; displacement and turn (6) since the step began, 2 unused.
inline constexpr int body_floats = 16;
/// Its inverse mass and inverse inertia tensor (xx, xy, xz, yy, yz, zz), 1 unused.
inline constexpr int mass_floats = 8;

/// Groups of one kernel's width. `bodies` has for each group the slots of all lanes' A, then those of B; bit 31 marks a body
/// that impulses do not move: it is read and never written. Slot 0 stands still.
inline constexpr std::uint32_t unmoved = 1u << 31;
struct Groups {
    float* rows = nullptr;                     // aligned to 64 bytes
    const std::uint32_t* bodies = nullptr;
    const std::uint8_t* points = nullptr;      // most of any lane
};
struct Bodies {
    float* state = nullptr;                    // body_floats each, aligned to 64 bytes
    const float* mass = nullptr;               // mass_floats each
    // 8 each, like the velocities: what a substep's forces add, and the velocities it began with, forces included.
    const float* forces = nullptr;
    float* start = nullptr;
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
    void (*push)(const Groups&, std::size_t first, std::size_t last, const Bodies&, float substeps_per_second);
    void (*relax)(const Groups&, std::size_t first, std::size_t last, const Bodies&, float substeps_per_second);
    /// Sums the step's impulses up into `force` and `moment`.
    void (*sum)(const Groups&, std::size_t first, std::size_t last);
};

extern const Kernel sse2_kernel, avx2_kernel, avx512_kernel;

/// The widest this processor runs; narrower with the environment's TUMBLE_LANES = 4, 8 or 16 (for tests and measurements).
const Kernel& best_kernel();

}  // namespace tumble::soft
