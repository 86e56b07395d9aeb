// Resting contact of all islands: each goes to the solver that suits it, by rules that see only the scene.
//
// Directly (direct_solver.h): single bodies, all islands of a small scene, those that touch nothing fixed, and those where
// much rests on little, as long as factoring them is cheap and the step's budget of such work lasts, the worst first. All
// others, those in which something turns fast, and those for which the direct solver finds no solution, by soft substeps
// (soft_solver.h); after a failure it is not tried again for a while.
#pragma once

#include "sim/contact/model/contact_islands.h"
#include "sim/contact/direct/direct_solver.h"
#include "sim/contact/model/load_estimate.h"
#include "sim/contact/soft/soft_solver.h"

#include <memory>
#include <vector>

namespace tumble {

class ContactSolver {
public:
    using Choice = ContactSolverChoice;

    /// precisely: directly wherever that finds a solution, whatever it costs, for scenes that ask for exact impacts.
    enum class Effort { balanced, precisely };

    explicit ContactSolver(std::size_t bodies, Choice choice = Choice::by_island, Effort effort = Effort::balanced);

    void solve(const ContactProblem& problem, const ContactIslands& islands, ThreadPool& pool);

private:
    struct Memory {   // of an island, kept with its lowest body
        std::unique_ptr<DirectSolver> solver;
        int wait = 0, failures = 0;   // steps until the next trial; failures in a row
        int factorisations = 2;       // of the last solve: what the next may take
        std::size_t work = 0;         // of one of them
        bool direct = false;          // solved so in the last step
        LoadEstimate load;                // as of the last look
        int looked = 0;               // steps for which that holds
    };
    struct Candidate {
        std::size_t island;
        double load_ratio;
        std::size_t work;
    };
    void look_at_bodies(const ContactProblem& problem, const ContactIslands& islands, ThreadPool& pool);
    bool turns_fast(std::span<const std::uint32_t> bodies) const;
    void choose(const ContactProblem& problem, const ContactIslands& islands);
    bool rolls(const ContactProblem& problem, std::span<const std::uint32_t> manifolds) const;
    LoadEstimate load(const ContactProblem& problem, const ContactIslands& islands, std::size_t island, int holds, double enough);
    int finer(const ContactProblem& problem, const ContactIslands& islands, std::size_t island);
    bool deal(const ContactIslands& islands, const ContactProblem& problem);

    Choice choice_;
    Effort effort_;
    std::vector<Memory> memory_;          // by body
    // Of each body in contact, what is asked of islands: looked at by the thread it belongs to, and kept close together, for bodies
    // that one thread writes to and another reads are slow for both.
    std::vector<double> gains_;           // 1/s^2, the square of the speed that the step's forces add, in radii a second
    std::vector<char> turns_fast_;
    LoadEstimates loads_;
    SoftSolver soft_;
    std::vector<Candidate> candidates_;
    bool few_ = false;                    // pairs in all: every island may be solved directly
    std::vector<std::size_t> direct_, softly_;   // islands
    std::vector<char> failed_;            // of direct_
    std::vector<int> fineness_;           // of softly_
    struct Deal {
        std::uint64_t islands = 0;        // their changes
        std::vector<std::size_t> softly;
        std::vector<int> fineness;
        bool operator==(const Deal&) const = default;
    };
    Deal dealt_;                          // what the parts were made of
    std::vector<SoftSolver::Part> parts_;
    std::size_t parts_used_ = 0;
};

}  // namespace tumble
