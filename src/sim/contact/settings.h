// Constants that choose a contact solver for each island.
#pragma once

#include <cstddef>

namespace tumble::tuning {

/// Levels of a pile from which on the substeps of its island are divided by two, and by four: high piles of soft
/// contacts buckle (bench_stability "stack"). Related test: Towers.AStackOfAHundredStands.
inline constexpr int soft_high_pile = 32;
inline constexpr int soft_very_high_pile = 64;

/// Substeps are divided too where a body would sink by more than this share of its radius under its weight: g d^2
/// in a substep d. Related test: ContactHardInput.SmallBodiesDoNotSinkIntoEachOther.
inline constexpr double soft_sag = 3e-3;

/// Steps for which a load estimate of an island holds. Limits the cost.
inline constexpr int soft_load_age = 8;

/// Manifolds of small islands that are solved together through all substeps: their rows (360 bytes each) stay in
/// the second-level cache of a core. Not fitted: follows from the size of the cache.
inline constexpr std::size_t soft_batch_manifolds = 256;

/// The same of nets, manifolds and joints: each color of a batch should fill some vectors of the kernel's lanes.
inline constexpr std::size_t soft_batch_of_nets = 512;

/// Islands with a body that turns by more than this in a step, rad, are solved softly, in substeps. Free islands
/// are excluded: the direct solver keeps their angular momentum. Related tests:
/// Rolling.WheelsOfCornersStayOnTheGround and ContactEnergy.FastTumblingPlanksGainNothing.
inline constexpr double direct_turn = 0.03;

/// Pairs of bodies in contact in the whole scene, and their points, up to which all islands are solved directly: a rack of
/// 15 balls on a table has 47 of both, 32 boxes on boxes have 128 points. Limit the cost. Related test:
/// Rack.RollsApartAsItsMirrorImageWithoutRestitution.
inline constexpr std::size_t direct_few_pairs = 48;
inline constexpr std::size_t direct_few_points = 128;

/// Larger islands are solved directly if a body carries this many times its own mass,
inline constexpr double direct_load_ratio = 16.0;

/// and remain so down to this share of that ratio. Not fitted: a hysteresis; without it a heap may change the
/// solver in each step and rock.
inline constexpr double direct_stay = 0.8;

/// In scenes of more manifolds than the first number, the ratio is the second: hundreds of columns of 20 stand in
/// the soft solver as well, in half the time (bench_contact "towers").
inline constexpr std::size_t direct_many_manifolds = 4096;
inline constexpr double direct_load_ratio_of_many = 64.0;

/// Largest number of bodies of an island that is solved directly. Not fitted: a bound of the cost.
inline constexpr std::size_t direct_most_bodies = 512;

/// Block operations (6 x 6, about 0.1 microseconds) of one factorization that an island may take: per manifold, in
/// any case, and all islands together in a step (a millisecond). Limits the cost. Related: bench_contact "towers".
inline constexpr std::size_t direct_work_each = 30;
inline constexpr std::size_t direct_work_free = 50;
inline constexpr std::size_t direct_budget = 8000;

/// Steps until the direct solver is tried again after a failure. Each further failure doubles them, this many times
/// at most. Not fitted: a bound of the cost of failures.
inline constexpr int direct_wait = 6;
inline constexpr int direct_most_failures = 8;

/// Islands per unit of parallel work of the direct solver. No result depends on it.
inline constexpr std::size_t direct_parallel_grain = 4;

/// Factor of the number of substeps of nets: gaps are as its inverse square, and the sweeps are a small part of the cost.
/// 1, 2 or 4.
inline constexpr int net_substeps = 2;

/// Steps for which a net stays with the direct solver after it has touched joined bodies that sweeps do not know. Not
/// fitted: a hysteresis, against a change of the solver in each bounce.
inline constexpr int net_wait = 30;

}  // namespace tumble::tuning
