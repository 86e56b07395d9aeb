#include "sim/contact/contact_solver.h"

#include "sim/tuning.h"

#include <algorithm>

namespace tumble {
namespace {

// What the direct solver holds between masses of 1 : 1e6 would be a blow for soft contacts: of its impulses no more is
// handed over than some weights of the lighter body.
void temper(Manifold& m, const ContactProblem& problem) {
    if (!m.solved_directly) return;
    m.solved_directly = false;
    double mass = std::numeric_limits<double>::infinity(), speed = 0.0;
    for (const std::uint32_t i : {m.a, m.b}) {
        const Body& body = problem.bodies[i];
        if (!body.dynamic()) continue;
        mass = std::min(mass, body.mass);
        speed = std::max(speed, (body.velocity - problem.velocity_before[i]).norm());
    }
    double sum = 0.0;
    for (const ContactPoint& p : m.points) sum += p.impulse;
    const double most = tuning::direct_handover * mass * speed;
    if (sum <= most) return;
    const double share = most / sum;
    for (ContactPoint& p : m.points) p.impulse *= share;
    m.friction[0] *= share;
    m.friction[1] *= share;
    m.twist *= share;
}

}  // namespace

ContactSolver::ContactSolver(std::size_t bodies, int threads, Choice choice)
    : choice_(choice), memory_(bodies), load_ratio_(bodies), soft_(bodies, threads) {}

bool ContactSolver::small(const ContactIslands& islands, std::size_t island) const {
    return islands.bodies(island).size() <= tuning::direct_small_bodies &&
           islands.manifolds(island).size() <= tuning::direct_small_manifolds;
}

void ContactSolver::choose(const ContactProblem& problem, const ContactIslands& islands) {
    direct_.clear();
    softly_.clear();
    candidates_.clear();
    std::size_t all_manifolds = 0;
    for (std::size_t k = 0; k < islands.size(); ++k) {
        const auto bodies = islands.bodies(k);
        const auto manifolds = islands.manifolds(k);
        all_manifolds += manifolds.size();
        Memory& memory = memory_[bodies[0]];
        if (choice_ == Choice::soft) {
            softly_.push_back(k);
            continue;
        }
        if (choice_ == Choice::direct) {
            direct_.push_back(k);
            continue;
        }
        if (memory.wait > 0) {
            --memory.wait;
            softly_.push_back(k);
            continue;
        }
        if (small(islands, k)) {
            direct_.push_back(k);
            continue;
        }
        double mass = 0.0, least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t i : bodies) {
            mass += problem.bodies[i].mass;
            least = std::min(least, problem.bodies[i].mass);
        }
        if (bodies.size() <= tuning::direct_most_bodies && mass >= tuning::direct_load_ratio * least) {
            const double ratio = load_ratio_.find(problem.bodies, problem.manifolds, bodies, manifolds);
            if (ratio >= tuning::direct_load_ratio) {
                if (!memory.solver) memory.solver = std::make_unique<DirectSolver>();
                const std::size_t work = memory.solver->factor_work(problem, bodies, manifolds);
                if (work <= tuning::direct_work_each * manifolds.size() + tuning::direct_work_free) {
                    candidates_.push_back({k, ratio, work * std::size_t(1 + memory.factorisations)});
                    continue;
                }
            }
        }
        softly_.push_back(k);
    }
    // The worst first, while the budget lasts.
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& l, const Candidate& r) {
        return l.load_ratio != r.load_ratio ? l.load_ratio > r.load_ratio : l.island < r.island;
    });
    std::size_t budget = tuning::direct_budget + tuning::direct_budget_each * all_manifolds;
    for (const Candidate& c : candidates_) {
        if (c.work <= budget) {
            budget -= c.work;
            direct_.push_back(c.island);
        } else {
            softly_.push_back(c.island);
        }
    }
    std::sort(direct_.begin(), direct_.end());
}

// Soft islands into parts: as many as threads where no island is a large share, else one.
void ContactSolver::deal(const ContactIslands& islands, const ContactProblem& problem, std::size_t threads) {
    std::sort(softly_.begin(), softly_.end());
    std::size_t all = 0, largest = 0;
    for (const std::size_t k : softly_) {
        all += islands.manifolds(k).size();
        largest = std::max(largest, islands.manifolds(k).size());
    }
    const bool apart = threads > 1 && all >= tuning::parallel_grain && 2 * largest * threads < 3 * all;
    const std::size_t count = apart ? threads : 1;
    parts_.resize(count);
    for (SoftSolver::Part& part : parts_) {
        part.bodies.clear();
        part.manifolds.clear();
    }
    std::size_t dealt = 0;
    for (const std::size_t k : softly_) {
        SoftSolver::Part& part = parts_[std::min(count - 1, dealt * count / std::max<std::size_t>(all, 1))];
        const auto bodies = islands.bodies(k);
        const auto manifolds = islands.manifolds(k);
        part.bodies.insert(part.bodies.end(), bodies.begin(), bodies.end());
        part.manifolds.insert(part.manifolds.end(), manifolds.begin(), manifolds.end());
        dealt += manifolds.size();
        for (const std::uint32_t m : manifolds) temper(problem.manifolds[m], problem);
    }
}

void ContactSolver::solve(const ContactProblem& problem, const ContactIslands& islands, ThreadPool& pool) {
    choose(problem, islands);
    failed_.assign(direct_.size(), 0);
    pool.for_each(direct_.size(), tuning::direct_parallel_grain, [&](std::size_t k, std::size_t) {
        const auto bodies = islands.bodies(direct_[k]);
        Memory& memory = memory_[bodies[0]];
        if (!memory.solver) memory.solver = std::make_unique<DirectSolver>();
        failed_[k] = !memory.solver->solve(problem, bodies, islands.manifolds(direct_[k]));
        memory.factorisations = memory.solver->factorisations();
    });
    for (std::size_t k = 0; k < direct_.size(); ++k) {
        Memory& memory = memory_[islands.bodies(direct_[k])[0]];
        for (const std::uint32_t m : islands.manifolds(direct_[k])) problem.manifolds[m].solved_directly = true;
        if (!failed_[k]) {
            memory.failures = 0;
            continue;
        }
        memory.wait = tuning::direct_wait << memory.failures;
        memory.failures = std::min(memory.failures + 1, tuning::direct_most_failures);
        softly_.push_back(direct_[k]);
    }
    if (softly_.empty()) return;
    deal(islands, problem, std::size_t(pool.size()));
    soft_.solve(problem, parts_, pool);
}

}  // namespace tumble
