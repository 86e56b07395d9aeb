// Constants of body motion: integrators, gyroscopic correction and kinematic bodies.
#pragma once

namespace tumble::tuning {

/// Growth of a body's rotational energy in one step's turn above which the change of omega within the step is
/// computed. Below it, 1e5 steps show no change; bodies in heaps stay below it. Tests: those of
/// tests/sim/dynamics/gyroscopic_correction_test.cpp.
inline constexpr double spin_steady = 1e-9;

/// Turn of a step, rad, up to which the mean of omega follows from a series (error: 1e-5 of the turn). Not fitted:
/// the error follows from the series.
inline constexpr double spin_series_turn = 0.1;

/// Turn of a step, rad, above which no mean of omega is computed: the tangent that gives it diverges. Tests: those
/// of tests/sim/dynamics/gyroscopic_correction_test.cpp.
inline constexpr double spin_largest_turn = 0.7;

}  // namespace tumble::tuning
