// Resting contact of all islands: selects a solver for each island, by rules that depend on the scene alone.
//
// The direct solver (direct_solver.h) takes
// - islands with joints whose way is direct (joint_way.h),
// - single bodies,
// - all islands of a small scene,
// - islands that touch nothing fixed,
// - islands with a high load ratio, the worst first, while factoring them is cheap and the step's budget lasts.
// The soft solver (soft_solver.h) takes all others, islands with fast rotation, and those for which the direct solver
// finds no solution; after a failure it is not tried again for a while.
#pragma once

#include "sim/contact/direct/direct_solver.h"
#include "sim/contact/model/contact_areas.h"
#include "sim/contact/model/contact_islands.h"
#include "sim/contact/model/load_estimate.h"
#include "sim/contact/projection/projection.h"
#include "sim/contact/soft/soft_solver.h"
#include "sim/joints/joint_way.h"

#include <memory>
#include <vector>

namespace tumble::tuning {

/// Steps until the direct solver is tried again after a failure. Each further failure doubles them, this many times
/// at most. Not fitted: a bound of the cost of failures.
inline constexpr int direct_wait = 6;
inline constexpr int direct_most_failures = 8;

}  // namespace tumble::tuning

namespace tumble {

class ContactSolver {
public:
    using Choice = ContactSolverChoice;

    /// precisely: the direct solver wherever it finds a solution, at any cost, for scenes with exact impacts.
    enum class Effort { balanced, precisely };

    explicit ContactSolver(std::size_t bodies, Choice choice = Choice::by_island, Effort effort = Effort::balanced);

    void solve(const ContactProblem& step, const ContactIslands& islands, ThreadPool& pool);

    /// At the end of a step: closes the joints of an island that CCD has stopped, see DirectSolver::close_poses(), and
    /// those of all islands that were solved in sweeps.
    void close_clamped(const ContactProblem& problem, const ContactIslands& islands, std::size_t island);
    void close_swept(const ContactProblem& problem, const ContactIslands& islands, ThreadPool& pool);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [choice, effort, memory, gains, turns_fast, loads, soft, projection, starts, candidates, few, direct,
               softly, swept, failed, substep_multipliers, batched, batches, batches_used, areas] = self;
        archive.rebuilt(choice, effort, soft, projection, batched, batches, batches_used);
        archive.by_body(memory);
        archive.keep(few);
        archive.scratch(starts, swept, gains, turns_fast, loads, candidates, direct, softly, failed,
                        substep_multipliers, areas);
    }

private:
    struct Memory {  // state of an island, kept with its lowest body
        std::unique_ptr<DirectSolver> solver;
        int wait = 0, failures = 0;  // steps until the next trial; consecutive failures
        int factorizations = 2;      // of the last solve: bound for the next one
        std::size_t work = 0;        // block operations of one factorization
        bool direct = false;         // solved directly in the last step
        LoadEstimate load;           // of the last evaluation
        int estimate_steps = 0;      // steps for which the estimate holds
        double lost = 0.0;           // J, of a net: IslandBatch::lost
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [solver, wait, failures, factorizations, work, direct, load, estimate_steps, lost] = self;
            archive.count(wait, factorizations, estimate_steps);
            archive.between(0, failures, tuning::direct_most_failures);
            archive.any(work);
            archive.keep(direct, load, lost);
            archive.scratch(solver);
        }
    };
    struct Candidate {
        std::size_t island;
        double load_ratio;
        std::size_t work;
    };
    void measure_bodies(const ContactProblem& problem, const ContactIslands& islands, ThreadPool& pool);
    bool turns_fast(std::span<const std::uint32_t> bodies) const;
    void choose(const ContactProblem& problem, const ContactIslands& islands);
    bool rolls(const ContactProblem& problem, std::span<const std::uint32_t> manifolds) const;
    LoadEstimate load(const ContactProblem& problem, const ContactIslands& islands, std::size_t island, int holds,
                      double enough);
    int substep_multiplier(const ContactProblem& problem, const ContactIslands& islands, std::size_t island);
    JointWay way_of(const ContactProblem& problem, const ContactIslands& islands, std::size_t island);
    void keep_starts(const ContactProblem& problem, const ContactIslands& islands);
    void leave_sweeps(const ContactProblem& problem, const ContactIslands& islands);
    bool make_batches(const ContactIslands& islands, const ContactProblem& problem);

    Choice choice_;
    Effort effort_;
    std::vector<Memory> memory_;  // by body
    // Properties of each body in contact that islands need, written by the body's thread and kept close together:
    // bodies that one thread writes and another reads are slow for both.
    std::vector<double> gains_;  // 1/s^2, squared speed gained by the step's forces, in radii per second
    std::vector<char> turns_fast_;
    LoadEstimates loads_;
    SoftSolver soft_;
    Projection projection_;
    struct Momenta {
        Vec3 linear, angular;
    };
    std::vector<Momenta> starts_;  // before the sweeps, of the bodies of swept islands in the order of softly_
    std::vector<Candidate> candidates_;
    bool few_ = false;                          // few pairs in all: every island may be solved directly
    std::vector<std::size_t> direct_, softly_;  // indices of islands
    // With its joints; closed: the projection closes all of them.
    enum class Swept : std::uint8_t { no, open, closed };
    std::vector<Swept> swept_;              // by island
    std::vector<char> failed_;              // by entry of direct_
    std::vector<int> substep_multipliers_;  // substep multiplier, by entry of softly_
    struct BatchInput {
        std::uint64_t islands = 0;  // ContactIslands::changes() of the batches
        std::vector<std::size_t> softly;
        std::vector<int> substep_multipliers;
        std::vector<Swept> swept;
        bool operator==(const BatchInput&) const = default;
    };
    BatchInput batched_;  // inputs from which the batches were made
    std::vector<SoftSolver::Batch> batches_;
    std::size_t batches_used_ = 0;
    ContactAreas areas_;  // of this step
};

}  // namespace tumble
