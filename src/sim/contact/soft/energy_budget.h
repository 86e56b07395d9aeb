// Energy budget of an island. Contact must not add energy, but the sweeps of the soft solver stop short of the solution
// and may: without a budget, furniture landing at 60 steps per second gains half a percent of the scene's energy in a
// step, and a needle that spins by radians per substep is thrown up.
// The budget is the lesser of two energies: the greater of those before and after the step's forces, and the initial
// energy plus the forces' work along the coming displacement, so that lifted bodies pay for their lift. Where bodies
// overlap deeply, lifting is free and only the first applies: pushing such heaps apart would slow them otherwise.
// The excess is taken in proportion from the bodies that gained energy, so that a body sliding past a settling heap
// keeps its own.
#pragma once

#include "sim/dynamics/body.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Effect of the step's forces on a body, before its contacts are solved.
struct ForceAccount {
    Vec3 impulse, turn;         // N s, N m s
    double start, with_forces;  // J, kinetic: before and after the forces
    double gain = 0.0;          // J, added by the contacts; at most the body's energy
};
void open_account(ForceAccount& account, const Body& body, const BodyVelocity& before);

/// Sums over bodies that contacts have reached, J.
struct EnergyBudget {
    double start = 0.0, with_forces = 0.0, now = 0.0;  // kinetic: before and after the forces, and after the solve
    double work = 0.0;                                 // by the forces along the coming displacement of the solved body
    double gains = 0.0;                                // sum over the bodies that gained

    /// Adds a body and sets its own gain.
    void add(ForceAccount& forces, const Body& solved);
    void add(const EnergyBudget& other);
    /// Fraction of each body's gain above the budget. `lifted_free`: lifting costs nothing.
    double excess(bool lifted_free) const;
    /// Fraction of the displacement that the island's budget allows.
    double affordable_way() const;
};

/// Takes a fraction of its gain from a body that has gained. Its displacement in the step is scaled by `way`.
void take_back(const ForceAccount& forces, double share, double way, Body& body);

/// Whether soft contacts may spin up a body of this island; its displacement is then limited by the budget. In other
/// islands, resting bodies may be pushed out of an overlap at no cost.
bool may_spin_up(std::span<const std::uint32_t> island, const std::vector<Body>& bodies,
                 const std::vector<BodyVelocity>& before, double h);

}  // namespace tumble
