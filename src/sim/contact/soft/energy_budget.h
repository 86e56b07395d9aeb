// Energy budget of an island. Contact must not add energy, but the sweeps of the soft solver stop short of the solution
// and may: without a budget, furniture landing at 60 steps per second gains half a percent of the scene's energy in a
// step, and a needle that spins by radians per substep is thrown up.
// The budget is the lesser of two energies: the greater of those before and after the step's forces, and the initial
// energy plus the forces' work along the coming displacement, so that lifted bodies pay for their lift. Where bodies
// overlap deeply, lifting is free and only the first applies: correcting such heaps apart would slow them otherwise.
// The excess is taken in proportion from the bodies that gained energy, so that a body sliding past a settling heap
// keeps its own.
#pragma once

#include "sim/contact/model/rigid_mode.h"
#include "sim/contact/soft/soft_layout.h"
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
    /// Largest energy of the solved bodies, J. `lifted_free`: lifting costs nothing.
    double most(bool lifted_free) const;
    /// Fraction of each body's gain above the budget. `lost` (J): may be given back.
    double excess(bool lifted_free, double lost = 0.0) const;
    /// Fraction of the displacement that the island's budget allows.
    double affordable_displacement() const;
};

/// Takes a fraction of its gain from a body that has gained. Its displacement in the step is scaled by `displacement`.
void take_back(const ForceAccount& forces, double share, double displacement, Body& body);

/// True if soft contacts may spin up a body of this island; its displacement is then limited by the budget. In other
/// islands, resting bodies may be pushed out of an overlap at no cost.
bool may_spin_up(std::span<const std::uint32_t> island, const std::vector<Body>& bodies,
                 const std::vector<BodyVelocity>& before, double h);

// Energies of the softly solved islands, before and after, and the removal of the excess; for free islands,
// whose momentum must stay, relative to the rigid-body mode.
//
// Bodies are addressed by their positions in the blocks' order (BodyBlocks). A large island has one account for each
// of its blocks: the limits of sums must not depend on the threads, each of which has its own blocks.
class IslandEnergies {
public:
    /// Opens accounts for the islands of the layout.
    void open(const SoftLayout& layout, const std::vector<Body>& bodies);

    /// Marks the island of the body at this position as having deep overlaps. May be called by any thread.
    void mark_deep(std::size_t place);

    /// Called before the solve, and after it if contacts have reached the body; each position by one thread.
    void begin(std::size_t place, const Body& body, const BodyVelocity& before) {
        open_account(forces_[place], body, before);
    }
    void end(std::size_t place, const Body& body);

    /// Removes the excess from the bodies at the positions first to last, which begin and end with blocks.
    /// Precondition: all positions have ended. The other arguments as in ContactProblem; h: the step, s.
    /// `lost` (J): by each net in the steps before, empty without nets; sweeps swing about the solution, and would lose
    /// each swing's upper half for good. The budget of all steps together holds.
    void hold(const BodyBlocks& blocks, std::size_t first, std::size_t last, std::vector<Body>& bodies,
              const std::vector<BodyVelocity>& before, double h, const std::vector<double>& lost) const;
    /// Makes `lost` that of the next step.
    void find_lost(std::vector<double>& lost) const;

private:
    struct Account {
        std::size_t first, end;  // positions in the blocks' order
        std::uint32_t island;
        EnergyBudget energy;
        RigidMode motion;  // of a free island
    };
    struct Island {
        std::size_t first_account, end_account;
        Vec3 origin;                  // m, one of its bodies
        bool touches_static, driven;  // touches a static body; touches a moving kinematic one, which may add energy
        std::uint8_t deep = 0;
    };
    Island& island(std::size_t place) { return islands_[accounts_[account_of_[place]].island]; }
    void limit_free_island(const Account& account, const EnergyBudget& energy, const BodyBlocks& blocks,
                           std::vector<Body>& bodies, double lost) const;

    std::vector<Island> islands_;
    std::vector<Account> accounts_;          // ascending by position
    std::vector<std::uint32_t> account_of_;  // by position
    std::vector<ForceAccount> forces_;       // by position
    std::vector<std::uint8_t> reached_;      // by position
};

}  // namespace tumble
