// Contact takes energy and gives none. The soft contact solver's sweeps, which stop short of the solution, may: furniture that
// landed at 60 steps a second gained half a percent of the scene's energy in a step, a needle that spins by radians in a substep
// was thrown to the sky. So an island is held to no more than the greater of what it had before and after the step's forces, nor
// than what it began with and the forces' work on the way it is going to go: what is pushed up pays for it. What is too much is
// taken from the bodies that gained, in proportion: who slides by on a heap that settles keeps what he has. Only where bodies lie
// deep in each other the way up is free: heaps that begin so would be slowed by being pushed apart.
#pragma once

#include "sim/dynamics/body.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// What the forces of a step have done to a body before its contacts are solved.
struct ForceAccount {
    Vec3 impulse, turn;                // N s, N m s
    double start, with_forces;         // J, kinetic: before and after
    double gain = 0.0;                 // J, what the contacts have added since; no more than the body has
};
void open_account(ForceAccount& account, const Body& body, const BodyVelocity& before);

/// Sums over bodies that contacts have reached, J.
struct EnergyBudget {
    double start = 0.0, with_forces = 0.0, now = 0.0;   // kinetic
    double work = 0.0;                                  // of the forces on the way that the solved body will go
    double gains = 0.0;                                 // of the bodies that have gained

    /// Sets the body's own gain too.
    void add(ForceAccount& forces, const Body& solved);
    void add(const EnergyBudget& other);
    /// The share of each body's gain that is too much. `lifted_free`: for the way up nobody pays.
    double excess(bool lifted_free) const;
    /// The share of its way that an island can pay for.
    double affordable_way() const;
};

/// Takes a share of its gain from a body that has gained. Its way in the step becomes `way` of what it was.
void take_back(const ForceAccount& forces, double share, double way, Body& body);

/// Whether soft contacts may spin up something in this island, which is then held to the way that it can pay for. Elsewhere what is
/// at rest may be pushed out of an overlap for nothing.
bool may_spin_up(std::span<const std::uint32_t> island, const std::vector<Body>& bodies, const std::vector<BodyVelocity>& before, double h);

}  // namespace tumble
