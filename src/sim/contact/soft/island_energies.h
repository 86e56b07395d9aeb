// The energies of islands that are solved softly: what they have before and after, and the end of what has become too much
// (energy_limit.h; common_motion.h for those that float, whose momentum must stay).
//
// Bodies go by their places in the blocks' order (body_blocks.h). A large island has an account for each of its blocks: where sums
// begin and end must not depend on the threads, which keep to blocks of their own.
#pragma once

#include "sim/contact/model/rigid_mode.h"
#include "sim/contact/soft/energy_budget.h"
#include "sim/contact/soft/soft_layout.h"

#include <cstdint>
#include <vector>

namespace tumble {

class IslandEnergies {
public:
    /// Of the layout's islands.
    void open(const SoftLayout& layout, const std::vector<Body>& bodies);

    /// The island of the body at a place has bodies that lie deep in each other (by any thread).
    void lies_deep(std::size_t place);

    /// Before the solve, and after it, if contacts have reached the body; each place by one thread.
    void begin(std::size_t place, const Body& body, const BodyVelocity& before) { open_account(forces_[place], body, before); }
    void end(std::size_t place, const Body& body);

    /// Once all have ended: takes back what is too much from the bodies at the places first to last, which begin and end with
    /// blocks. The other arguments as in ContactProblem; h: the step, s.
    void hold(const BodyBlocks& blocks, std::size_t first, std::size_t last, std::vector<Body>& bodies,
              const std::vector<BodyVelocity>& before, double h) const;

private:
    struct Account {
        std::size_t first, end;   // places
        std::uint32_t island;
        EnergyBudget energy;
        RigidMode motion;      // of islands that float
    };
    struct Island {
        std::size_t first_account, end_account;
        Vec3 origin;              // m, one of its bodies
        bool leans, driven;       // by what may give it energy
        std::uint8_t deep = 0;
    };
    Island& island(std::size_t place) { return islands_[accounts_[account_of_[place]].island]; }
    void hold_floating(const Account& account, const EnergyBudget& energy, const BodyBlocks& blocks, std::vector<Body>& bodies) const;

    std::vector<Island> islands_;
    std::vector<Account> accounts_;           // ascending by place
    std::vector<std::uint32_t> account_of_;   // by place
    std::vector<ForceAccount> forces_;        // by place
    std::vector<std::uint8_t> reached_;       // by place
};

}  // namespace tumble
