#include "sim/contact/contact_solver.h"

#include "sim/contact/model/rigid_mode.h"
#include "sim/threads/thread_pool.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Levels of a pile from which on the substeps of its island are divided by two, and by four: high piles of soft
/// contacts buckle (bench_stability "stack"). Related test: Towers.AStackOfAHundredStands.
constexpr int soft_high_pile = 32;
constexpr int soft_very_high_pile = 64;

/// Substeps are divided too where a body would sink by more than this share of its radius under its weight: g d^2
/// in a substep d. Related test: ContactHardInput.SmallBodiesDoNotSinkIntoEachOther.
constexpr double soft_sag = 3e-3;

/// Steps for which a load estimate of an island holds. Limits the cost.
constexpr int soft_load_age = 8;

/// Manifolds of small islands that are solved together through all substeps: their rows (360 bytes each) stay in
/// the second-level cache of a core. Not fitted: follows from the size of the cache.
constexpr std::size_t soft_batch_manifolds = 256;

/// The same of nets, manifolds and joints: each color of a batch should fill some vectors of the kernel's lanes.
constexpr std::size_t soft_batch_of_nets = 512;

/// Islands with a body that turns by more than this in a step, rad, are solved softly, in substeps. Free islands
/// are excluded: the direct solver keeps their angular momentum. Related tests:
/// Rolling.WheelsOfCornersStayOnTheGround and ContactEnergy.FastTumblingPlanksGainNothing.
constexpr double direct_turn = 0.03;

/// Pairs of bodies in contact in the whole scene, and their points, up to which all islands are solved directly: a rack
/// of 15 balls on a table has 47 of both, 32 boxes on boxes have 128 points. Limit the cost. Related test:
/// Rack.RollsApartAsItsMirrorImageWithoutRestitution.
constexpr std::size_t direct_few_pairs = 48;
constexpr std::size_t direct_few_points = 128;

/// Larger islands are solved directly if a body carries this many times its own mass,
constexpr double direct_load_ratio = 16.0;

/// and remain so down to this share of that ratio. Not fitted: a hysteresis; without it a heap may change the
/// solver in each step and rock.
constexpr double direct_stay = 0.8;

/// In scenes of more manifolds than the first number, the ratio is the second: hundreds of columns of 20 stand in
/// the soft solver as well, in half the time (bench_contact "towers").
constexpr std::size_t direct_many_manifolds = 4096;
constexpr double direct_load_ratio_of_many = 64.0;

/// Largest number of bodies of an island that is solved directly. Not fitted: a bound of the cost.
constexpr std::size_t direct_most_bodies = 512;

/// Block operations (6 x 6, about 0.1 microseconds) of one factorization that an island may take: per manifold, in
/// any case, and all islands together in a step (a millisecond). Limits the cost. Related: bench_contact "towers".
constexpr std::size_t direct_work_each = 30;
constexpr std::size_t direct_work_free = 50;
constexpr std::size_t direct_budget = 8000;

/// Islands per unit of parallel work of the direct solver. No result depends on it.
constexpr std::size_t direct_parallel_grain = 4;

/// Factor of the number of substeps of nets: gaps are as its inverse square, and the sweeps are a small part of the
/// cost. 1, 2 or 4.
constexpr int net_substeps = 2;

/// Steps for which a net stays with the direct solver after it has touched joined bodies that sweeps do not know. Not
/// fitted: a hysteresis, against a change of the solver in each bounce.
constexpr int net_wait = 30;

// Clears the results of the last solve.
void forget(Joint& joint) {
    joint.impulse = {};
    joint.curving = {};
    joint.force.setZero();
    joint.torque.setZero();
    joint.account.step = {};
}

}  // namespace

ContactSolver::ContactSolver(std::size_t bodies, Choice choice, Effort effort)
    : choice_(choice),
      effort_(effort),
      memory_(bodies),
      gains_(bodies),
      turns_fast_(bodies),
      loads_(bodies),
      soft_(bodies) {}

void ContactSolver::measure_bodies(const ContactProblem& problem, const ContactIslands& islands, ThreadPool& pool) {
    const double most = direct_turn / problem.settings.h;
    pool.for_bodies(islands.bodies(), tuning::parallel_bodies, [&](std::uint32_t i) {
        const Body& body = problem.bodies[i];
        gains_[i] = (body.velocity - problem.before[i].velocity).squaredNorm() / (body.radius * body.radius);
        turns_fast_[i] =
            body.angular_velocity.squaredNorm() > most * most && !std::holds_alternative<Ball>(body.collider);
    });
}

// One solve for a whole step is accurate to first order in the angles: fast rotating corners need substeps.
bool ContactSolver::turns_fast(std::span<const std::uint32_t> bodies) const {
    return std::any_of(bodies.begin(), bodies.end(), [&](std::uint32_t i) { return turns_fast_[i] != 0; });
}

// Balls that roll over faces are carried round exactly (predicted_gap.h), however far the body rotates.
bool ContactSolver::rolls(const ContactProblem& problem, std::span<const std::uint32_t> manifolds) const {
    return !manifolds.empty() && std::all_of(manifolds.begin(), manifolds.end(), [&](std::uint32_t k) {
        const Manifold& m = problem.manifolds[k];
        return m.has_ball_over_face() && pair_friction(problem.bodies[m.a], problem.bodies[m.b]) > 0.0;
    });
}

// The load estimate, at most `holds` steps old; not computed where no body can carry `enough` times its mass.
LoadEstimate ContactSolver::load(const ContactProblem& problem, const ContactIslands& islands, std::size_t island,
                                 int holds, double enough) {
    const auto bodies = islands.bodies(island);
    Memory& memory = memory_[bodies[0]];
    if (memory.estimate_steps-- > 0) return memory.load;
    memory.estimate_steps = holds;
    memory.load = {};
    double mass = 0.0, least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : bodies) {
        mass += problem.bodies[i].mass;
        least = std::min(least, problem.bodies[i].mass);
    }
    if (mass >= enough * least)
        memory.load = loads_.find(problem.bodies, problem.manifolds, bodies, islands.manifolds(island));
    return memory.load;
}

// The way of an island with joints. Where a net touches joined bodies that sweeps do not know, or its sweeps have
// overflowed, it stays with the direct solver for a while.
JointWay ContactSolver::way_of(const ContactProblem& problem, const ContactIslands& islands, std::size_t island) {
    if (problem.ways.empty()) return JointWay::direct;
    const IslandWay& way = problem.ways[island];
    if (way.way == JointWay::free) return way.way;
    int& wait = memory_[islands.bodies(island)[0]].wait;
    if (way.net && way.way == JointWay::direct) wait = net_wait;
    if (way.way != JointWay::sweeps || wait == 0 || --wait == 0) return way.way;
    return JointWay::direct;
}

void ContactSolver::choose(const ContactProblem& problem, const ContactIslands& islands) {
    swept_.assign(islands.size(), Swept::no);
    if (std::any_of(problem.ways.begin(), problem.ways.end(),
                    [](const IslandWay& island) { return island.way == JointWay::sweeps; }))
        projection_.find(*problem.joints, problem.bodies);
    direct_.clear();
    softly_.clear();
    candidates_.clear();
    std::size_t all_manifolds = 0, all_pairs = 0, all_points = 0;
    for (std::size_t k = 0; k < islands.size(); ++k) all_manifolds += islands.manifolds(k).size();
    // Hysteresis: between the solvers the bodies are lifted out of their soft contacts and sink back in, and a heap
    // that alternates would rock without end. So directly solved scenes stay so a little beyond the limit.
    const auto few = [&](std::size_t most) { return few_ ? most * 5 / 4 : most; };
    const std::size_t pairs = few(direct_few_pairs), points = few(direct_few_points);
    for (std::size_t k = 0; k < islands.size() && all_pairs <= pairs; ++k) all_pairs += islands.touching_pairs(k);
    if (all_pairs <= pairs)
        for (const Manifold& m : problem.manifolds) all_points += std::size_t(m.count);
    few_ = all_pairs <= pairs && all_points <= points;
    const double enough = all_manifolds > direct_many_manifolds ? direct_load_ratio_of_many : direct_load_ratio;
    for (std::size_t k = 0; k < islands.size(); ++k) {
        const auto bodies = islands.bodies(k);
        const auto manifolds = islands.manifolds(k);
        if (islands.joints(k).empty() && problem.bodies[bodies[0]].placed) continue;  // it rolls
        const bool precise = effort_ == Effort::precisely && bodies.size() <= direct_most_bodies;
        if (!islands.joints(k).empty()) {
            const JointWay way = way_of(problem, islands, k);
            if (way == JointWay::sweeps) swept_[k] = projection_.closes(bodies) ? Swept::closed : Swept::open;
            if (way != JointWay::free) (way == JointWay::sweeps ? softly_ : direct_).push_back(k);
            continue;
        }
        if (choice_ != Choice::by_island || precise) {
            (choice_ == Choice::soft ? softly_ : direct_).push_back(k);
            continue;
        }
        Memory& memory = memory_[bodies[0]];
        if (memory.wait > 0) {
            --memory.wait;
            softly_.push_back(k);
            continue;
        }
        const bool free = islands.is_free(k);
        const bool alone = bodies.size() == 1;
        if (!free && turns_fast(bodies) && !(alone && rolls(problem, manifolds))) {
            softly_.push_back(k);
            continue;
        }
        if (alone) {
            memory.work = 0;
            direct_.push_back(k);
            continue;
        }
        if (bodies.size() <= direct_most_bodies) {
            const double needed = memory.direct ? direct_stay * enough : enough;
            const double ratio = load(problem, islands, k, 0, needed).ratio;
            if (free || few_ || ratio >= needed) {
                if (!memory.solver) memory.solver = std::make_unique<DirectSolver>();
                memory.work = memory.solver->factor_work(problem, bodies, manifolds);
                if (memory.work <= direct_work_each * manifolds.size() + direct_work_free) {
                    const std::size_t expected = memory.work * std::size_t(1 + memory.factorizations);
                    candidates_.push_back({k, ratio / (needed / enough), memory.direct ? expected / 2 : expected});
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
    std::size_t budget = direct_budget;
    for (const Candidate& c : candidates_) {
        if (c.work <= budget) {
            budget -= c.work;
            direct_.push_back(c.island);
        } else {
            softly_.push_back(c.island);
            // One expensive step must not exclude the island permanently.
            int& expected = memory_[islands.bodies(c.island)[0]].factorizations;
            expected -= expected / 4;
        }
    }
    std::sort(direct_.begin(), direct_.end());
}

// Substep multiplier that an island needs: high piles of soft contacts would buckle, and small bodies would sink in by
// their own weight, because the sag of a spring is the same for any size.
int ContactSolver::substep_multiplier(const ContactProblem& problem, const ContactIslands& islands,
                                      std::size_t island) {
    if (swept_[island] != Swept::no) return problem.ways[island].entangled ? net_substeps : 1;
    const int levels = load(problem, islands, island, soft_load_age, soft_high_pile).levels;
    const double h = problem.settings.h, n = substeps_of(h);
    double square = 0.0;  // of the sag of the smallest body, in its radii, over the step
    for (const std::uint32_t i : islands.bodies(island)) square = std::max(square, gains_[i]);
    const double sag = h / (n * n) * std::sqrt(square);
    if (levels > soft_very_high_pile || sag > 4.0 * soft_sag) return 4;
    return levels > soft_high_pile || sag > soft_sag ? 2 : 1;
}

// Batches soft islands by equal substep multiplier, each batch no larger than a cache, or one large island. Returns
// whether the batches are those of the last step.
bool ContactSolver::make_batches(const ContactIslands& islands, const ContactProblem& problem) {
    std::sort(softly_.begin(), softly_.end());
    substep_multipliers_.clear();
    for (const std::size_t k : softly_) substep_multipliers_.push_back(substep_multiplier(problem, islands, k));
    BatchInput now{islands.changes(), softly_, substep_multipliers_, swept_};
    if (now == batched_) return true;
    batched_ = std::move(now);
    batches_used_ = 0;
    for (const int wanted : {1, 2, 4}) {
        // Batches of islands without joints, of nets, and of trees, whose sweeps differ.
        std::size_t open[] = {SIZE_MAX, SIZE_MAX, SIZE_MAX};
        for (std::size_t s = 0; s < softly_.size(); ++s) {
            if (substep_multipliers_[s] != wanted) continue;
            const auto bodies = islands.bodies(softly_[s]);
            const auto manifolds = islands.manifolds(softly_[s]);
            // The direct solver has failed on islands with other joints.
            const Swept kind = swept_[softly_[s]];
            const bool net = kind != Swept::no;
            const auto joints = net ? islands.joints(softly_[s]) : std::span<const std::uint32_t>{};
            std::size_t& current = open[std::size_t(kind)];
            const std::size_t most = net ? soft_batch_of_nets : soft_batch_manifolds;
            const auto size = [](const SoftSolver::Batch& b) { return b.manifolds.size() + b.joints.size(); };
            if (current == SIZE_MAX || size(batches_[current]) + manifolds.size() + joints.size() > most) {
                if (batches_used_ == batches_.size()) batches_.emplace_back();
                current = batches_used_++;
                SoftSolver::Batch* batch = &batches_[current];
                batch->bodies.clear();
                batch->manifolds.clear();
                batch->pairs.clear();
                batch->island_ends.clear();
                batch->joints.clear();
                batch->substep_multiplier = wanted;
                batch->closes = kind == Swept::closed;
            }
            SoftSolver::Batch* batch = &batches_[current];
            batch->bodies.insert(batch->bodies.end(), bodies.begin(), bodies.end());
            batch->manifolds.insert(batch->manifolds.end(), manifolds.begin(), manifolds.end());
            batch->pairs.insert(batch->pairs.end(), islands.pairs(softly_[s]).begin(), islands.pairs(softly_[s]).end());
            batch->island_ends.push_back(batch->bodies.size());
            for (const std::uint32_t j : joints) batch->joints.push_back(problem.joints->active()[j]);
        }
    }
    return false;
}

void ContactSolver::solve(const ContactProblem& step, const ContactIslands& islands, ThreadPool& pool) {
    areas_.find(islands.repeated(), step.manifolds, step.bodies);
    ContactProblem problem = step;
    if (!areas_.empty()) problem.areas = &areas_;
    measure_bodies(problem, islands, pool);
    choose(problem, islands);
    failed_.assign(direct_.size(), 0);
    pool.for_each(direct_.size(), direct_parallel_grain, [&](std::size_t k, std::size_t) {
        const auto bodies = islands.bodies(direct_[k]);
        Memory& memory = memory_[bodies[0]];
        if (!memory.solver) memory.solver = std::make_unique<DirectSolver>();
        failed_[k] = !memory.solver->solve(problem, bodies, islands.manifolds(direct_[k]), islands.joints(direct_[k]));
        memory.factorizations = memory.solver->factorizations();
    });
    for (const std::size_t k : softly_) memory_[islands.bodies(k)[0]].direct = false;
    for (std::size_t k = 0; k < direct_.size(); ++k) {
        Memory& memory = memory_[islands.bodies(direct_[k])[0]];
        // The first solve after a landing may be expensive. An island that is expensive again, or always, is left to
        // the soft solver.
        const bool hard = memory.work * std::size_t(1 + memory.factorizations) > 2 * direct_budget;
        const bool first = !memory.direct && memory.failures == 0;
        memory.direct = failed_[k] == 0;
        if (hard && first) memory.factorizations = 1;
        if (failed_[k] || (hard && !first)) {
            memory.wait = tuning::direct_wait << memory.failures;
            memory.failures = std::min(memory.failures + 1, tuning::direct_most_failures);
            memory.factorizations = 1;
        } else if (!hard) {
            memory.failures = 0;
        }
        if (failed_[k]) softly_.push_back(direct_[k]);
    }
    if (!softly_.empty()) {
        const bool same = make_batches(islands, problem);
        const std::span<SoftSolver::Batch> batches = std::span(batches_).first(batches_used_);
        const auto each_net = [&](SoftSolver::Batch& batch, auto&& visit) {
            if (batch.joints.empty()) return;
            for (std::size_t i = 0, first = 0; i < batch.island_ends.size(); first = batch.island_ends[i++])
                visit(batch.lost[i], memory_[batch.bodies[first]].lost);
        };
        for (SoftSolver::Batch& batch : batches) {
            batch.lost.assign(batch.joints.empty() ? 0 : batch.island_ends.size(), 0.0);
            each_net(batch, [](double& lost, double kept) { lost = kept; });
        }
        keep_starts(problem, islands);
        soft_.solve(problem, batches, same, pool);
        for (SoftSolver::Batch& batch : batches) each_net(batch, [](double lost, double& kept) { kept = lost; });
        leave_sweeps(problem, islands);
    } else {
        batched_ = {};
    }
    for (std::size_t k = 0; k < islands.size(); ++k)
        if (islands.is_free(k) && islands.bodies(k).size() > 1 && islands.joints(k).empty())
            keep_angular_momentum(islands.bodies(k), problem.bodies, problem.settings.h);
    for (const std::size_t k : softly_) {
        if (swept_[k] == Swept::no || !islands.is_free(k)) continue;
        Vec3 carried = Vec3::Zero();
        for (const std::uint32_t j : islands.joints(k)) carried += soft_.carried(problem.joints->active()[j]);
        keep_angular_momentum(islands.bodies(k), problem.bodies, problem.settings.h, carried);
    }
}

void ContactSolver::keep_starts(const ContactProblem& problem, const ContactIslands& islands) {
    starts_.clear();
    for (const std::size_t k : softly_)
        if (swept_[k] != Swept::no)
            for (const std::uint32_t i : islands.bodies(k))
                starts_.push_back({problem.bodies[i].momentum, problem.bodies[i].angular_momentum});
}

// Islands whose sweeps have overflowed in single precision are solved directly, for a while.
void ContactSolver::leave_sweeps(const ContactProblem& problem, const ContactIslands& islands) {
    const auto finite = [&](std::uint32_t i) {
        const Body& body = problem.bodies[i];
        return body.momentum.allFinite() && body.angular_momentum.allFinite() && body.correction_velocity.allFinite() &&
               body.correction_angular_velocity.allFinite();
    };
    const Momenta* start = starts_.data();
    for (const std::size_t k : softly_) {
        if (swept_[k] == Swept::no) continue;
        const auto bodies = islands.bodies(k);
        const Momenta* first = start;
        start += bodies.size();
        if (std::all_of(bodies.begin(), bodies.end(), finite)) continue;
        for (const std::uint32_t i : bodies) {
            Body& body = problem.bodies[i];
            body.momentum = first->linear;
            body.angular_momentum = first++->angular;
            body.correction_velocity.setZero();
            body.correction_angular_velocity.setZero();
            body.derive_velocities();
        }
        for (const std::uint32_t m : islands.manifolds(k)) {
            release(problem.manifolds[m]);
            problem.manifolds[m].solved_by = SolvedBy::direct;
            if (problem.totals) (*problem.totals)[m] = {};
        }
        for (const std::uint32_t j : islands.joints(k)) forget(problem.joints->joints()[problem.joints->active()[j]]);
        Memory& memory = memory_[bodies[0]];
        memory.lost = 0.0;
        memory.wait = net_wait;
        swept_[k] = Swept::no;
        if (!memory.solver) memory.solver = std::make_unique<DirectSolver>();
        memory.solver->solve(problem, bodies, islands.manifolds(k), islands.joints(k));
    }
}

void ContactSolver::close_clamped(const ContactProblem& problem, const ContactIslands& islands, std::size_t island) {
    if (swept_[island] != Swept::no) return;  // closed as all that are swept
    const auto bodies = islands.bodies(island);
    Memory& memory = memory_[bodies[0]];
    if (!memory.solver) memory.solver = std::make_unique<DirectSolver>();
    memory.solver->close_poses(problem, bodies, islands.joints(island));
}

void ContactSolver::close_swept(const ContactProblem& problem, const ContactIslands& islands, ThreadPool& pool) {
    if (std::all_of(swept_.begin(), swept_.end(), [](Swept swept) { return swept == Swept::no; })) return;
    projection_.prepare(std::size_t(pool.size()));
    pool.for_each(islands.size(), direct_parallel_grain, [&](std::size_t k, std::size_t thread) {
        if (swept_[k] == Swept::no) return;
        const Vec3 gained = projection_.close(islands.bodies(k), problem.bodies, problem.settings.h, thread);
        if (islands.is_free(k)) keep_angular_momentum(islands.bodies(k), problem.bodies, 0.0, gained);
    });
}

}  // namespace tumble
