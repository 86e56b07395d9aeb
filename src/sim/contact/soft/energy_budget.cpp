#include "sim/contact/soft/energy_budget.h"

#include "sim/contact/soft/soft_solver.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace tumble {

namespace {

/// An excess of energy of a free island below this share of its energy is rounding. Not fitted: far above double
/// precision.
constexpr double soft_energy_rounding = 1e-9;

/// Largest share of its energy that a net may have lost and regain. Not fitted: an energy lost in a landing must not
/// return as a jump. Related test: Nets.ASwingingNetGainsNoEnergy.
constexpr double soft_energy_lent = 0.01;

/// Islands of at most this number of bodies have an energy budget if soft contacts may spin up a body. Related
/// test: ContactEnergy.FastTumblingPlanksGainNothing.
constexpr std::size_t soft_energy_bodies = 32;

/// Such a body turns by more than this in a substep, rad, or
constexpr double soft_energy_turn = 0.1;

/// has moments of inertia of a larger ratio than this: a needle of 1 : 45. Related tests:
/// ContactEnergy.NeedlesFallOverAndLie and Needle.ComesToLieOnTheFloor.
constexpr double soft_energy_slender = 1e3;

// The impulse P = F h of the forces along the displacement h (v + correction): work P . (v + correction); likewise for
// the rotation.
double work_on(const ForceAccount& forces, const Body& solved) {
    return forces.impulse.dot(solved.velocity + solved.correction_velocity) +
           forces.turn.dot(solved.angular_velocity + solved.correction_angular_velocity);
}

}  // namespace

void open_account(ForceAccount& account, const Body& body, const BodyVelocity& before) {
    const Vec3 spun_up = body.angular_velocity - before.angular_velocity;
    account.impulse = body.mass * (body.velocity - before.velocity);
    account.turn = Vec3::Zero();
    if (!spun_up.isZero(0.0))
        account.turn = body.rotation * (body.inertia_body * (body.rotation.transpose() * spun_up));
    account.with_forces = body.kinetic_energy();
    account.start = 0.5 * ((body.momentum - account.impulse).dot(before.velocity) +
                           (body.angular_momentum - account.turn).dot(before.angular_velocity));
    account.gain = 0.0;
}

void EnergyBudget::add(ForceAccount& forces, const Body& solved) {
    const double energy = solved.kinetic_energy(), forces_work = work_on(forces, solved);
    forces.gain =
        std::clamp(energy - forces.start - forces_work, 0.0, energy);  // a lifted body without motion has none
    start += forces.start;
    with_forces += forces.with_forces;
    now += energy;
    work += forces_work;
    gains += forces.gain;
}

void EnergyBudget::add(const EnergyBudget& other) {
    start += other.start;
    with_forces += other.with_forces;
    now += other.now;
    work += other.work;
    gains += other.gains;
}

double EnergyBudget::most(bool lifted_free) const {
    const double fastest = std::max(start, with_forces);
    return lifted_free ? fastest : std::max(0.0, std::min(fastest, start + work));
}

double EnergyBudget::excess(bool lifted_free, double lost) const {
    const double limit = most(lifted_free) + lost;
    return now > limit && gains > 0.0 ? std::min(1.0, (now - limit) / gains) : 0.0;
}

double EnergyBudget::affordable_displacement() const { return start + work < 0.0 ? start / -work : 1.0; }

void take_back(const ForceAccount& forces, double share, double displacement, Body& body) {
    const double taken = share * forces.gain;
    if (taken == 0.0 && displacement == 1.0) return;
    const Vec3 velocity = displacement * (body.velocity + body.correction_velocity);
    const Vec3 angular_velocity = displacement * (body.angular_velocity + body.correction_angular_velocity);
    if (taken > 0.0) {
        const double scale = std::sqrt(1.0 - taken / body.kinetic_energy());
        body.momentum *= scale;
        body.angular_momentum *= scale;
        body.derive_velocities();
    }
    body.correction_velocity = velocity - body.velocity;
    body.correction_angular_velocity = angular_velocity - body.angular_velocity;
}

bool may_spin_up(std::span<const std::uint32_t> island, const std::vector<Body>& bodies,
                 const std::vector<BodyVelocity>& before, double h) {
    if (island.size() > soft_energy_bodies) return false;
    const double fast = soft_energy_turn * substeps_of(h) / h;
    return std::any_of(island.begin(), island.end(), [&](std::uint32_t i) {
        const Vec3 moments = bodies[i].inertia_body.diagonal();
        return before[i].angular_velocity.squaredNorm() > fast * fast ||
               moments.maxCoeff() > soft_energy_slender * moments.minCoeff();
    });
}

void IslandEnergies::open(const SoftLayout& layout, const std::vector<Body>& bodies) {
    islands_.clear();
    accounts_.clear();
    account_of_.clear();
    const BodyBlocks& blocks = layout.blocks();
    for (const SoftLayout::Island& island : layout.islands()) {
        const auto number = std::uint32_t(islands_.size());
        const std::size_t first_account = accounts_.size();
        if (island.end_block <= island.first_block + 1)
            accounts_.push_back({island.first, island.end, number, {}, {}});
        else
            for (std::size_t b = island.first_block; b < island.end_block; ++b)
                accounts_.push_back({blocks.first(b), blocks.first(b + 1), number, {}, {}});
        islands_.push_back({.first_account = first_account,
                            .end_account = accounts_.size(),
                            .origin = bodies[blocks.order()[island.first]].position,
                            .touches_static = island.touches_static != 0,
                            .driven = island.driven != 0});
        for (std::size_t k = first_account; k < accounts_.size(); ++k)
            account_of_.resize(accounts_[k].end, std::uint32_t(k));
    }
    forces_.resize(blocks.order().size());
    reached_.assign(blocks.order().size(), 0);
}

// Written only where it changes: all threads read its neighborhood.
void IslandEnergies::mark_deep(std::size_t place) {
    const std::atomic_ref deep(island(place).deep);
    if (deep.load(std::memory_order_relaxed) == 0) deep.store(1, std::memory_order_relaxed);
}

void IslandEnergies::end(std::size_t place, const Body& body) {
    Account& account = accounts_[account_of_[place]];
    reached_[place] = 1;
    account.energy.add(forces_[place], body);
    if (!islands_[account.island].touches_static) account.motion.add(body, islands_[account.island].origin);
}

void IslandEnergies::hold(const BodyBlocks& blocks, std::size_t first, std::size_t last, std::vector<Body>& bodies,
                          const std::vector<BodyVelocity>& before, double h,
                          const std::vector<double>& all_lost) const {
    const auto begins_before = [](const Account& a, std::size_t place) { return a.first < place; };
    auto account = std::lower_bound(accounts_.begin(), accounts_.end(), first, begins_before);
    for (; account != accounts_.end() && account->first < last; ++account) {
        const Island& island = islands_[account->island];
        if (island.driven) continue;
        const double lost = all_lost.empty() ? 0.0 : all_lost[account->island];
        EnergyBudget sum;
        for (std::size_t k = island.first_account; k < island.end_account; ++k) sum.add(accounts_[k].energy);
        const double excess = sum.excess(island.deep || !island.touches_static, lost);
        if (excess == 0.0) continue;
        if (!island.touches_static) {
            limit_free_island(*account, sum, blocks, bodies, lost);
            continue;
        }
        const std::size_t begin = accounts_[island.first_account].first, end = accounts_[island.end_account - 1].end;
        const bool pays =
            !island.deep && may_spin_up(std::span(blocks.order()).subspan(begin, end - begin), bodies, before, h);
        const double displacement = pays ? sum.affordable_displacement() : 1.0;
        for (std::size_t k = account->first; k < account->end; ++k)
            if (reached_[k]) take_back(forces_[k], excess, displacement, bodies[blocks.order()[k]]);
    }
}

void IslandEnergies::find_lost(std::vector<double>& lost) const {
    for (std::size_t i = 0; i < lost.size(); ++i) {
        const Island& island = islands_[i];
        EnergyBudget sum;
        for (std::size_t k = island.first_account; k < island.end_account; ++k) sum.add(accounts_[k].energy);
        const double most = sum.most(island.deep || !island.touches_static);
        lost[i] =
            island.driven ? 0.0 : std::clamp(lost[i] + most - sum.now, 0.0, soft_energy_lent * std::min(most, sum.now));
    }
}

// A free island keeps its momentum: only motion outside its rigid-body mode can exceed the budget.
void IslandEnergies::limit_free_island(const Account& account, const EnergyBudget& energy, const BodyBlocks& blocks,
                                       std::vector<Body>& bodies, double lost) const {
    const Island& island = islands_[account.island];
    RigidMode motion;
    for (std::size_t k = island.first_account; k < island.end_account; ++k) motion.add(accounts_[k].motion);
    motion.finish();
    const double common = motion.energy(), most = std::max({energy.start, energy.with_forces, common}) + lost;
    if (!(energy.now > most * (1.0 + soft_energy_rounding))) return;
    const double scale = std::sqrt((most - common) / (energy.now - common));
    for (std::size_t k = account.first; k < account.end; ++k)
        if (reached_[k]) motion.scale_rest(scale, island.origin, bodies[blocks.order()[k]]);
}

}  // namespace tumble
