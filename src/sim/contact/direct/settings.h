// Constants of the direct contact solver.
#pragma once

namespace tumble::tuning {

/// Compliance of normal contact, over the island's mass: small enough for convergence in few rounds, large enough
/// for mass ratios of 1 : 1e6 in double precision. Related tests: Rest.HeavyOnLight and Towers.HeavyOnLight.
inline constexpr double direct_compliance = 1e-3;

/// Compliance of friction, in units of `direct_compliance`. It starts at `direct_friction_soft`, because Newton's
/// method stalls on the edges of the friction discs otherwise, and is multiplied by `direct_friction_stiffening`
/// each round down to `direct_friction_stiff`. Related tests: Towers.AnArchOfFifteenStonesStands and
/// Towers.AHouseOfCardsStands.
inline constexpr double direct_friction_soft = 1e4;
inline constexpr double direct_friction_stiffening = 0.3;
inline constexpr double direct_friction_stiff = 1.0;

/// Speeds below this share of the largest speed are rounding, which the stiffness of the contacts amplifies. Not
/// fitted: rounding of double precision times the stiffness of contacts.
inline constexpr double direct_rounding = 1e-12;

/// Convergence of the rounds, relative to the impulses. Related tests: ContactRest.StickOrSlipToAThousandth and
/// ContactRest.TheAccelerationOfASlide.
inline constexpr double direct_round_tolerance = 1e-4;

/// Newton steps of each later round, number of rounds, the same while friction exceeds its cones, and steps of a line
/// search. Not fitted: bounds of the cost.
inline constexpr int direct_newton_steps = 12;
inline constexpr int direct_rounds = 12;
inline constexpr int direct_most_rounds = 30;
inline constexpr int direct_line_search = 25;

/// Overlaps below this share of the smaller radius are not corrected: below a micrometer for bodies of a meter. Not
/// fitted: below any visible size. Tests: tests/sim/contact/landing_test.cpp.
inline constexpr double direct_slop = 1e-6;

/// Compliance of position correction, over the island's mass, and the share of that stiffness across the normals.
/// No case is known that guards it.
inline constexpr double direct_correction_compliance = 1e-2;
inline constexpr double direct_correction_across = 0.03;

}  // namespace tumble::tuning
