#include "sim/contact/soft_solver.h"

#include "sim/contact/soft_batch.h"
#include "sim/tuning.h"

#include <algorithm>
#include <cmath>

namespace tumble {
int substeps_of(double h) {
    // A step of exactly so many substeps must not get one more by rounding.
    const double n = std::ceil(h / tuning::soft_substep - 1e-6);
    return int(std::clamp(n, double(tuning::soft_least_substeps), double(tuning::soft_most_substeps)));
}

SoftSolver::SoftSolver(std::size_t bodies, const soft::Kernel& kernel) : kernel_(kernel), slot_(bodies, 0) {}
SoftSolver::~SoftSolver() = default;

void SoftSolver::solve(const ContactProblem& problem, std::span<const Part> parts, ThreadPool& pool) {
    while (batches_.size() < parts.size()) batches_.push_back(std::make_unique<SoftBatch>(kernel_));
    const auto threads = std::size_t(pool.size());
    if (parts.size() == 1) {   // one island, or too little work to share: the threads share its blocks
        SoftBatch& batch = *batches_[0];
        batch.prepare(problem, parts[0], slot_);
        const bool worth_it = threads > 1 && parts[0].manifolds.size() >= tuning::soft_team_manifolds;
        const std::size_t team = worth_it ? threads : 1;
        SpinBarrier barrier(team);
        if (!worth_it) return batch.run(problem, slot_, 0, 1, barrier);
        batch.give_bodies(pool);
        return pool.together([&](std::size_t thread) { batch.run(problem, slot_, thread, team, barrier); });
    }
    if (threads > 1)
        for (std::size_t k = 0; k < parts.size(); ++k)
            for (const std::uint32_t i : parts[k].bodies) pool.give(i, k % threads);
    pool.together([&](std::size_t thread) {
        for (std::size_t k = thread; k < parts.size(); k += threads) {
            SpinBarrier alone(1);
            batches_[k]->prepare(problem, parts[k], slot_);
            batches_[k]->run(problem, slot_, 0, 1, alone);
        }
    });
}

}  // namespace tumble
