// Constants of the soft contact solver.
#pragma once

#include <cstddef>

namespace tumble::tuning {

/// Least and largest number of substeps in a step. Not fitted: bounds of the cost.
inline constexpr int soft_least_substeps = 4;
inline constexpr int soft_most_substeps = 64;

/// Bodies with overlaps above this share of the smaller radius started inside each other or landed fast; their
/// position correction has no energy budget. Related tests: ContactEnergy.DeepLandingsThrowNoBody and
/// ContactHardInput.ACrowdDissolves.
inline constexpr double soft_energy_deep = 0.25;

/// An excess of energy of a free island below this share of its energy is rounding. Not fitted: far above double
/// precision.
inline constexpr double soft_energy_rounding = 1e-9;

/// Largest share of its energy that a net may have lost and regain. Not fitted: an energy lost in a landing must not
/// return as a jump. Related test: Nets.ASwingingNetGainsNoEnergy.
inline constexpr double soft_energy_lent = 0.01;

/// Islands of at most this number of bodies have an energy budget if soft contacts may spin up a body. Related
/// test: ContactEnergy.FastTumblingPlanksGainNothing.
inline constexpr std::size_t soft_energy_bodies = 32;

/// Such a body turns by more than this in a substep, rad, or
inline constexpr double soft_energy_turn = 0.1;

/// has moments of inertia of a larger ratio than this: a needle of 1 : 45. Related tests:
/// ContactEnergy.NeedlesFallOverAndLie and Needle.ComesToLieOnTheFloor.
inline constexpr double soft_energy_slender = 1e3;

/// Natural frequency of a contact, cycles per substep: between two bodies; between bodies whose masses differ by
/// more than the factor `soft_unlike_masses`; against a body that does not move. One sweep per substep cannot
/// follow stiffer contacts: of 576 heaps of 27 boxes, 6 are awake after 8 s (0.25 for all: 52); a pyramid of 100
/// rows creeps by 3 mm in 60 s (0.22: by 0.13 m). Overlaps grow with the inverse square (bench_contact,
/// bench_stability "stack").
inline constexpr double soft_frequency = 0.16;
inline constexpr double soft_frequency_of_unlike = 0.14;
inline constexpr double soft_unlike_masses = 2.0;
inline constexpr double soft_frequency_of_fixed = 0.2;

/// Damping ratio of a contact. Related: the cases of the frequencies.
inline constexpr double soft_damping = 2.0;

/// Overlaps of this share of the smaller radius are corrected twice as fast, relative to their depth, except
/// between unlike masses: force chains in a heap end on single corners that carry 90 bodies (bench_contact "pile of
/// 8000"). Test: SoftKernel.AnOverlapIsPushedOutSoftlyAndTheSpeedRemoved.
inline constexpr double soft_twice_as_stiff = 1e-2;

/// Least share of its compliance that a contact keeps when it is deeper than `push_limit` allows: bodies of
/// millimeters still carry many times their weight, and a pressed body still gives way. Related test:
/// ContactHardInput.AMillimeterAndAHundredMeters.
inline constexpr double soft_least_give = 0.25;

/// Overlaps below this share of the smaller radius are not corrected: they keep the contact closed. Not fitted:
/// below any visible size. Test: SoftKernel.AnOverlapIsPushedOutSoftlyAndTheSpeedRemoved.
inline constexpr double soft_slop = 2e-5;

/// Masses, kg, between which the solver computes in kilograms. Outside, it uses a unit of the scene's own. Not
/// fitted: squares of impulses stay in the range of single precision. Related test: ContactHardInput.DustAndMoons.
inline constexpr double soft_least_mass = 1e-9;
inline constexpr double soft_most_mass = 1e9;

/// Manifolds of an island from which on several threads share it: below, two barriers per sweep cost more
/// (bench_contact). No result depends on it.
inline constexpr std::size_t soft_team_manifolds = 500;

/// Bodies in a block that one thread owns: their states (64 bytes each) fill the first-level cache of a core. Not
/// fitted: follows from the size of the cache.
inline constexpr std::size_t soft_block_bodies = 512;

/// Steps for which manifolds keep their places in the batches. No result depends on it.
inline constexpr int soft_layout_steps = 32;

/// Groups of manifolds between blocks from which on threads share them, with a barrier per color. No result depends
/// on it.
inline constexpr std::size_t soft_shared_groups = 24;

/// Share of a joint's gap that is closed in a substep, and share of its impulse that a push gives up. Impulses add up from
/// substep to substep: without the second, slow waves of a net grow by a quarter of the first in a substep; with it, a
/// joint under the tension T is left open by about leak / rate T d^2 / m. Trees, whose gaps are closed at the end of each step,
/// have no leak. Related test: Nets.HangsAsTheDirectSolverDoes.
inline constexpr double soft_joint_rate = 0.05;
inline constexpr double soft_joint_leak = 0.01;

/// Least share of the compliance of a turn that is left where the anchors stay together. Not fitted: above the rounding of
/// single precision.
inline constexpr double soft_least_turn_gives = 1e-5;

/// Largest impulse handed over from the direct solver, in impulses of the step's forces on the lighter body.
/// Related test: Towers.HeavyBetweenLight.
inline constexpr double direct_handover = 20.0;

}  // namespace tumble::tuning
