// Contact takes energy and gives none. The soft contact solver's sweeps, which stop short of the solution, may: those of a needle
// that spins by radians in a substep have thrown it to the sky. Small islands that lean on what stands are held to what they
// had.
#pragma once

#include "sim/contact/soft_solver.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct EnergyLimit {
    double start = 0.0, with_forces = 0.0;   // J, kinetic: when the step began, and with its forces alone
    std::vector<BodyVelocity> forces;        // what the forces change in the step, by the island's bodies; empty: nothing is asked
};

/// Before the solve: what an island of these bodies is held to. Nothing is asked of large islands, where nothing turns fast or
/// is slender, where nothing fixed is touched and momentum must stay, and where kinematic bodies may add some.
EnergyLimit energy_limit(const ContactProblem& problem, std::span<const std::uint32_t> bodies, std::span<const std::uint32_t> manifolds);

/// After it: slows all bodies of the island alike, so that none approaches what stands, to no more than the greater of the two
/// energies, nor than what it began with and the forces' work on the way it is going to go: what is pushed up pays for it. The
/// ways in the step stay, unless they cost more than there is.
void hold_energy(const ContactProblem& problem, std::span<const std::uint32_t> bodies, const EnergyLimit& limit);

}  // namespace tumble
