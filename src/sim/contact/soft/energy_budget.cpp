#include "sim/contact/soft/energy_budget.h"

#include "sim/contact/soft/settings.h"
#include "sim/contact/soft/soft_solver.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// The impulse P = F h of the forces along the displacement h (v + push): work P . (v + push); likewise for the
// rotation.
double work_on(const ForceAccount& forces, const Body& solved) {
    return forces.impulse.dot(solved.velocity + solved.push_velocity) +
           forces.turn.dot(solved.angular_velocity + solved.push_angular_velocity);
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

double EnergyBudget::excess(bool lifted_free) const {
    const double fastest = std::max(start, with_forces),
                 most = lifted_free ? fastest : std::max(0.0, std::min(fastest, start + work));
    return now > most && gains > 0.0 ? std::min(1.0, (now - most) / gains) : 0.0;
}

double EnergyBudget::affordable_way() const { return start + work < 0.0 ? start / -work : 1.0; }

void take_back(const ForceAccount& forces, double share, double way, Body& body) {
    const double taken = share * forces.gain;
    if (taken == 0.0 && way == 1.0) return;
    const Vec3 velocity = way * (body.velocity + body.push_velocity);
    const Vec3 angular_velocity = way * (body.angular_velocity + body.push_angular_velocity);
    if (taken > 0.0) {
        const double scale = std::sqrt(1.0 - taken / body.kinetic_energy());
        body.momentum *= scale;
        body.angular_momentum *= scale;
        body.derive_velocities();
    }
    body.push_velocity = velocity - body.velocity;
    body.push_angular_velocity = angular_velocity - body.angular_velocity;
}

bool may_spin_up(std::span<const std::uint32_t> island, const std::vector<Body>& bodies,
                 const std::vector<BodyVelocity>& before, double h) {
    if (island.size() > tuning::soft_energy_bodies) return false;
    const double fast = tuning::soft_energy_turn * substeps_of(h) / h;
    return std::any_of(island.begin(), island.end(), [&](std::uint32_t i) {
        const Vec3 moments = bodies[i].inertia_body.diagonal();
        return before[i].angular_velocity.squaredNorm() > fast * fast ||
               moments.maxCoeff() > tuning::soft_energy_slender * moments.minCoeff();
    });
}

}  // namespace tumble
