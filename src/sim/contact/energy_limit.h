// Contact takes energy and gives none. The soft contact solver's sweeps, which stop short of the solution, may: those of a needle
// that spins by radians in a substep have thrown it to the sky. Small islands that lean on what stands are held to what they
// had.
#pragma once

#include "sim/contact/soft_solver.h"

#include <cstdint>
#include <span>

namespace tumble {

/// Before the solve: the kinetic energy (J) an island may come to, as much as when the step began or with its forces alone.
/// Infinity where none is asked for: of large islands, where nothing turns fast, where nothing fixed is touched and momentum must
/// stay, and where kinematic bodies may add some.
double energy_limit(const ContactProblem& problem, std::span<const std::uint32_t> bodies, std::span<const std::uint32_t> manifolds);

/// After it: slows all bodies of the island alike, so that none approaches what stands. Their ways in the step stay.
void hold_energy(const ContactProblem& problem, std::span<const std::uint32_t> bodies, double limit);

}  // namespace tumble
