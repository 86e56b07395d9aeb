// Energies of the softly solved islands, before and after, and the removal of the excess (energy_budget.h; for free
// islands, whose momentum must stay, rigid_mode.h).
//
// Bodies are addressed by their positions in the blocks' order (body_blocks.h). A large island has one account for each
// of its blocks: the limits of sums must not depend on the threads, each of which has its own blocks.
#pragma once

#include "sim/contact/model/rigid_mode.h"
#include "sim/contact/soft/energy_budget.h"
#include "sim/contact/soft/soft_layout.h"

#include <cstdint>
#include <vector>

namespace tumble {

class IslandEnergies {
public:
    /// Opens accounts for the islands of the layout.
    void open(const SoftLayout& layout, const std::vector<Body>& bodies);

    /// Marks the island of the body at this position as having deep overlaps. May be called by any thread.
    void lies_deep(std::size_t place);

    /// Called before the solve, and after it if contacts have reached the body; each position by one thread.
    void begin(std::size_t place, const Body& body, const BodyVelocity& before) {
        open_account(forces_[place], body, before);
    }
    void end(std::size_t place, const Body& body);

    /// Removes the excess from the bodies at the positions first to last, which begin and end with blocks.
    /// Precondition: all positions have ended. The other arguments as in ContactProblem; h: the step, s.
    void hold(const BodyBlocks& blocks, std::size_t first, std::size_t last, std::vector<Body>& bodies,
              const std::vector<BodyVelocity>& before, double h) const;

private:
    struct Account {
        std::size_t first, end;  // positions in the blocks' order
        std::uint32_t island;
        EnergyBudget energy;
        RigidMode motion;  // of a free island
    };
    struct Island {
        std::size_t first_account, end_account;
        Vec3 origin;         // m, one of its bodies
        bool leans, driven;  // touches a static body; touches a moving kinematic one, which may add energy
        std::uint8_t deep = 0;
    };
    Island& island(std::size_t place) { return islands_[accounts_[account_of_[place]].island]; }
    void hold_floating(const Account& account, const EnergyBudget& energy, const BodyBlocks& blocks,
                       std::vector<Body>& bodies) const;

    std::vector<Island> islands_;
    std::vector<Account> accounts_;          // ascending by position
    std::vector<std::uint32_t> account_of_;  // by position
    std::vector<ForceAccount> forces_;       // by position
    std::vector<std::uint8_t> reached_;      // by position
};

}  // namespace tumble
