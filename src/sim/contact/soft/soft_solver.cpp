#include "sim/contact/soft/soft_solver.h"

#include "sim/contact/model/settings.h"
#include "sim/contact/soft/soft_batch.h"
#include "sim/joints/joint_set.h"
#include "sim/threads/thread_pool.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace tumble {

const soft::Kernel& soft::best_kernel() {
    const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    const bool avx2 = __builtin_cpu_supports("avx2");
    const char* asked = std::getenv("TUMBLE_LANES");
    if (avx512 && !(asked && std::strcmp(asked, "16") != 0)) return avx512_kernel;
    if (avx2 && !(asked && std::strcmp(asked, "4") == 0)) return avx2_kernel;
    return sse2_kernel;
}

namespace {

/// Least and largest number of substeps in a step. Not fitted: bounds of the cost.
constexpr int soft_least_substeps = 4;
constexpr int soft_most_substeps = 64;

/// Masses, kg, between which the solver computes in kilograms. Outside, it uses a unit of the scene's own. Not
/// fitted: squares of impulses stay in the range of single precision. Related test: ContactHardInput.DustAndMoons.
constexpr double soft_least_mass = 1e-9;
constexpr double soft_most_mass = 1e9;

/// Manifolds of an island from which on several threads share it: below, two barriers per sweep cost more
/// (bench_contact). No result depends on it.
constexpr std::size_t soft_team_manifolds = 500;

// Unit of mass (kg) for single precision: squares of impulses must neither overflow nor vanish. 1 for everyday objects;
// for dust and moons the power of two in the middle of the scene's masses, which changes numbers without rounding.
double mass_unit(const std::vector<Body>& bodies) {
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    for (const Body& body : bodies) {
        if (!body.dynamic()) continue;
        least = std::min(least, body.mass);
        most = std::max(most, body.mass);
    }
    if (!(most > 0.0) || (least >= soft_least_mass && most <= soft_most_mass)) return 1.0;
    return std::ldexp(1.0, (std::ilogb(least) + std::ilogb(most)) / 2);
}

}  // namespace

int substeps_of(double h) {
    // Rounding must not add a substep to a step of exactly so many.
    const double n = std::ceil(h / tuning::soft_substep - 1e-6);
    return int(std::clamp(n, double(soft_least_substeps), double(soft_most_substeps)));
}

SoftSolver::SoftSolver(std::size_t bodies, const soft::Kernel& kernel) : kernel_(kernel), slot_(bodies, 0) {}
SoftSolver::~SoftSolver() = default;

void SoftSolver::solve(const ContactProblem& problem, std::span<Batch> batches, bool same, ThreadPool& pool) {
    if (mass_unit_ == 0.0) {
        mass_unit_ = mass_unit(problem.bodies);
        resists_ = std::any_of(problem.bodies.begin(), problem.bodies.end(), has_rotational_friction);
    }
    const auto threads = std::size_t(pool.size());
    const auto lanes = std::size_t(kernel_.lanes);
    while (workers_.size() < threads) workers_.push_back(std::make_unique<SoftBatch>(kernel_));
    if (layouts_.size() < batches.size()) layouts_.resize(batches.size());
    if (problem.joints && kinds_.empty())
        for (const Joint& joint : problem.joints->joints()) kinds_.push_back(kind_in_sweeps(joint));
    carried_.resize(kinds_.size());
    small_.clear();
    std::size_t all_small = 0;
    const auto size_of = [](const Batch& batch) { return batch.manifolds.size() + batch.joints.size(); };
    const auto close = [&](SoftLayout& layout, const Batch& batch) {
        if (!batch.joints.empty())
            layout.add_joints(batch, {problem.joints->joints(), kinds_}, problem.bodies, slot_, lanes);
        layout.close(batch, slot_, lanes);
    };
    for (std::size_t k = 0; k < batches.size(); ++k) {
        Batch& batch = batches[k];
        const bool one_large = batch.island_ends.size() == 1 && size_of(batch) >= soft_team_manifolds;
        if (threads == 1 || !one_large) {
            small_.push_back(k);
            all_small += size_of(batch);
            continue;
        }
        SoftLayout& layout = layouts_[k];
        layout.open(batch, problem.bodies, slot_, threads);
        for (std::size_t thread = 0; thread < threads; ++thread)
            for (const std::uint32_t i : layout.bodies_of(thread, threads)) pool.give(i, thread);
        SpinBarrier barrier(threads);
        pool.together([&](std::size_t thread) {
            layout.color(batch, problem.bodies, problem.manifolds, slot_, thread, threads);
            barrier.wait();
            if (thread == 0) {
                close(layout, batch);
                workers_[0]->prepare(problem, batch, layout, slot_, mass_unit_, same, resists_);
            }
            barrier.wait();
            workers_[0]->run(problem, batch, slot_, carried_, thread, threads, barrier);
        });
    }
    // Neighbors in the list, and the same ones from step to step.
    const auto each_of = [&](std::size_t thread, std::size_t team, auto&& visit) {
        for (std::size_t s = small_.size() * thread / team; s < small_.size() * (thread + 1) / team; ++s)
            visit(small_[s]);
    };
    const auto run = [&](std::size_t thread, std::size_t team) {
        each_of(thread, team, [&](std::size_t k) {
            SoftLayout& layout = layouts_[k];
            if (!same || !layout.lasts()) {
                layout.open(batches[k], problem.bodies, slot_, 1);
                layout.color(batches[k], problem.bodies, problem.manifolds, slot_, 0, 1);
                close(layout, batches[k]);
            }
            SpinBarrier alone(1);
            workers_[thread]->prepare(problem, batches[k], layout, slot_, mass_unit_, same, resists_);
            workers_[thread]->run(problem, batches[k], slot_, carried_, 0, 1, alone);
        });
    };
    if (threads == 1 || small_.size() < 2 || all_small < tuning::parallel_grain) return run(0, 1);
    for (std::size_t thread = 0; thread < threads; ++thread)
        each_of(thread, threads, [&](std::size_t k) {
            for (const std::uint32_t i : batches[k].bodies) pool.give(i, thread);
        });
    pool.together([&](std::size_t thread) { run(thread, threads); });
}

}  // namespace tumble
