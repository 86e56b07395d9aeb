// Constants of body motion: integrators, gyroscopic correction and kinematic bodies.
#pragma once

namespace tumble::tuning {

/// A kinematic body changes its velocity evenly over a step if the mean velocity equals the mean of both ends
/// within this share of the change. A smooth path is off by a share of h^2; most corners of a path are off by more.
/// Related test: Kinematic.NothingCreepsOnARockingPlatform.
inline constexpr double kinematic_bend = 0.1;

/// Phase, rad, of one step of the tenth-order extrapolation: the error of the step is about 1e-14 (bench_accuracy).
/// Related test: AdvanceExactly.ForcesAtPointsAgainstTheReference.
inline constexpr double extrapolation_phase = 0.2;

/// The drag force |u| u is not smooth where a body comes to rest relative to the air. The time until then counts as
/// this phase (rad), until the drag is below `extrapolation_no_drag` of the change of velocity. Related test:
/// AdvanceExactly.ThrownUpThroughAir.
inline constexpr double extrapolation_rest_in_air = 2.0;
inline constexpr double extrapolation_no_drag = 1e-14;

/// Largest number of substeps in a span: half a second of computing. Only bodies far lighter than the air that they
/// push need more. Not fitted: a bound of the cost. Related test: AdvanceExactly.LightBodiesInThickAir.
inline constexpr int most_substeps = 200000;

/// Growth of a body's rotational energy in one step's turn above which the change of omega within the step is
/// computed. Below it, 1e5 steps show no change; bodies in heaps stay below it. Tests: those of
/// tests/sim/gyroscopic_correction_test.cpp.
inline constexpr double spin_steady = 1e-9;

/// The same limit for bodies in contact. Related test: ContactEnergy.FastTumblingPlanksGainNothing.
inline constexpr double spin_growth = 0.01;

/// Turn of a step, rad, up to which the mean of omega follows from a series (error: 1e-5 of the turn). Not fitted:
/// the error follows from the series.
inline constexpr double spin_series_turn = 0.1;

/// Turn of a step, rad, above which no mean of omega is computed: the tangent that gives it diverges. Tests: those
/// of tests/sim/gyroscopic_correction_test.cpp.
inline constexpr double spin_largest_turn = 0.7;

}  // namespace tumble::tuning
