#include "sim/contact/direct/joint_flight.h"

#include "sim/dynamics/integrator.h"
#include "sim/dynamics/integrators/splitting.h"
#include "sim/joints/flight_way.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tumble {
namespace {

// Symmetric compositions: of order 4 with five stages (Suzuki 1990), of order 6 with nine and of order 8 with seventeen
// (Kahan and Li 1997, Math. Comp. 66). The first half and the middle stage.
constexpr std::array<double, 3> suzuki_4{0.41449077179437573714, 0.41449077179437573714, -0.65796308717750294857};
constexpr std::array<double, 5> kahan_li_6{0.39216144400731413927925056, 0.33259913678935943859974864,
                                           -0.70624617255763935980996482, 0.08221359629355080023149045,
                                           0.79854399093482996339895035};
constexpr std::array<double, 9> kahan_li_8{
    0.13020248308889008087881763, 0.56116298177510838456196441,  -0.38947496264484728640807860,
    0.15884190655515560089621075, -0.39590389413323757733623154, 0.18453964097831570709183254,
    0.25837438768632204729397911, 0.29501172360931029887096624,  -0.60550853383003451169892108};

std::vector<double> stages_of(int order) {
    std::span<const double> half;
    constexpr std::array<double, 1> rattle{1.0};
    if (order == 2) half = rattle;
    if (order == 4) half = suzuki_4;
    if (order == 6) half = kahan_li_6;
    if (order == 8) half = kahan_li_8;
    std::vector<double> stages(half.begin(), half.end());
    for (std::size_t k = half.size() - 1; k-- > 0;) stages.push_back(half[k]);
    return stages;
}

bool is_lock(const JointRows::Row& row) { return row.law == Joint::lock; }

}  // namespace

bool JointFlight::flies(const JointIsland& island) {
    const std::vector<Body>& bodies = island.problem.bodies;
    for (const std::uint32_t i : island.bodies)
        if (bodies[i].integrator == IntegratorKind::explicit_euler) return false;
    for (const std::uint32_t k : island.joints) {
        const Joint& joint = island.problem.joints->joints()[island.problem.joints->active()[k]];
        if (joint.broken || !free_but_for_springs(joint, bodies) || !flies_with_springs(island, joint)) return false;
    }
    return true;
}

int JointFlight::order(const JointIsland& island) {
    int order = 2;
    for (const std::uint32_t i : island.bodies) {
        const IntegratorKind kind = island.problem.bodies[i].integrator;
        if (kind == IntegratorKind::splitting || kind == IntegratorKind::runge_kutta_4) order = std::max(order, 4);
        if (kind == IntegratorKind::exact) order = 8;
    }
    return order;
}

void JointFlight::load(const JointIsland& island) {
    const std::vector<Body>& bodies = island.problem.bodies;
    const double length = island.length;
    rows_.load(island, 1.0);
    pairs_.clear();
    rows_.add_pairs(pairs_);
    matrix_.analyze(island.bodies.size(), pairs_);
    matrix_.set_zero();
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        const Body& body = bodies[island.bodies[k]];
        const Mat3 inertia = body.rotation * body.inertia_body * body.rotation.transpose() / (length * length);
        BlockCholesky::Block& block = matrix_.diagonal(k);
        for (int r = 0; r < 3; ++r) {
            block.row[r][r] = body.mass;
            for (int c = 0; c < 3; ++c) block.row[3 + r][3 + c] = inertia(r, c);
        }
    }
    // In a singular position the gap along the vanishing row is (h w)^2 / 2: without this compliance its correction
    // would be divided by zero.
    double fastest = 0.0;
    const auto spin = [&](std::uint32_t i) -> Vec3 {
        return i == Joint::world ? Vec3(Vec3::Zero()) : bodies[i].angular_velocity;
    };
    for (const JointRows::Block& block : rows_.blocks()) {
        const Joint& joint = island.problem.joints->joints()[block.joint];
        fastest = std::max(fastest, (spin(joint.b) - spin(joint.a)).norm());
    }
    const double turn = island.problem.settings.h * fastest;
    compliance_ = (rows_.tree() ? tuning::joint_flight_compliance : tuning::joint_compliance) /
                  (total_mass_ * double(island.joints.size()));
    compliance_ = std::max(
        compliance_, tuning::joint_singular * turn * turn * turn * turn / total_mass_ * double(island.bodies.size()));
    for (const JointRows::Block& block : rows_.blocks())
        for (const JointRows::Row& row : rows_.rows(block))
            if (is_lock(row)) JointRows::add_square(matrix_, block, row, 1.0 / compliance_);
    asked_.assign(rows_.rows().size(), 0.0);
}

// The least impulses that change J u as asked, but for the compliance: M du = J^T f, f = (asked - J du) / R. Adds them
// to given_.
bool JointFlight::impulses() {
    std::fill(change_.begin(), change_.end(), 0.0);
    for (const JointRows::Block& block : rows_.blocks())
        for (std::size_t k = block.first; k < block.first + block.count; ++k)
            if (asked_[k] != 0.0) JointRows::add(block, rows_.rows()[k], asked_[k] / compliance_, change_);
    matrix_.solve(change_);
    bool finite = true;
    for (const JointRows::Block& block : rows_.blocks())
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const JointRows::Row& row = rows_.rows()[k];
            if (!is_lock(row)) continue;
            given_[k] += (asked_[k] - JointRows::dot(block, row, change_)) / compliance_;
            finite = finite && std::isfinite(given_[k]);
        }
    return finite;
}

// Momenta of the stage's start with the impulses: equal and opposite, about one point.
void JointFlight::apply(const JointIsland& island) {
    std::vector<Body>& bodies = island.problem.bodies;
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        bodies[island.bodies[k]].momentum = starts_[k].momentum;
        bodies[island.bodies[k]].angular_momentum = starts_[k].angular_momentum;
    }
    for (const JointRows::Block& block : rows_.blocks()) {
        const Joint& joint = island.problem.joints->joints()[block.joint];
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const JointRows::Row& row = rows_.rows()[k];
            (row.turns() ? torque : force) += (row.turns() ? rows_.length() : 1.0) * given_[k] * row.direction;
        }
        if (block.a != JointRows::none) {
            const RigidState& start = starts_[std::size_t(block.a)];
            bodies[joint.a].momentum -= force;
            bodies[joint.a].angular_momentum -= (block.point - start.position).cross(force) + torque;
        }
        if (block.b != JointRows::none) {
            const RigidState& start = starts_[std::size_t(block.b)];
            bodies[joint.b].momentum += force;
            bodies[joint.b].angular_momentum += (block.point - start.position).cross(force) + torque;
        }
    }
}

void JointFlight::drift(const JointIsland& island, double h) {
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        Body& body = island.problem.bodies[island.bodies[k]];
        RigidState state = starts_[k];
        state.momentum = body.momentum;
        state.angular_momentum = body.angular_momentum;
        free_drift(state, mass_of(body), h);
        body.position = state.position;
        body.orientation = state.orientation;
    }
}

// Errors of the locks at the present poses, in sizes of the joint, and the changes of speed that would have avoided them.
double JointFlight::errors(const JointIsland& island, double h) {
    double worst = 0.0;
    for (const JointRows::Block& block : rows_.blocks()) {
        const Joint& joint = island.problem.joints->joints()[block.joint];
        const JointGeometry g =
            measure(joint, side_of(island.problem.bodies, joint.a), side_of(island.problem.bodies, joint.b));
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const JointRows::Row& row = rows_.rows()[k];
            if (!is_lock(row)) continue;
            const double error = g.coordinates[row.coordinate].value;
            worst = std::max(worst, std::abs(error) / (row.turns() ? 1.0 : joint.size));
            asked_[k] = -(row.turns() ? rows_.length() : 1.0) * error / h;
        }
    }
    return worst;
}

bool JointFlight::close(const JointIsland& island) {
    const double h = island.problem.settings.h;
    double last = infinity;
    for (int pass = 0; pass < tuning::joint_rounds; ++pass) {
        apply(island);
        drift(island, h);
        const double error = errors(island, h);
        if (!std::isfinite(error)) return false;
        if (error <= closed_ || (error < tuning::joint_rounding && error >= 0.5 * last)) return true;
        // In a singular position the gap along the vanishing row closes slowly, and by itself when that is passed.
        if (pass > 4 && error >= 0.9 * last) return error < tuning::joint_flight_open;
        last = error;
        if (!impulses()) return false;
    }
    return last < tuning::joint_flight_open;
}

void JointFlight::close_poses(const JointIsland& island) {
    std::vector<Body>& bodies = island.problem.bodies;
    prepare(island);
    double last = infinity;
    for (int pass = 0; pass < tuning::joint_rounds; ++pass) {
        load(island);
        const double error = errors(island, 1.0);
        if (!(error < tuning::joint_clamped_open) || error <= tuning::joint_closed || error >= 0.5 * last) return;
        last = error;
        given_.assign(rows_.rows().size(), 0.0);
        if (!matrix_.factor() || !impulses()) return;
        for (std::size_t k = 0; k < island.bodies.size(); ++k) {
            Body& body = bodies[island.bodies[k]];
            turn_exactly(body, Vec3::Map(&change_[6 * k]), Vec3::Map(&change_[6 * k + 3]) / rows_.length(), 1.0);
            body.derive();
        }
    }
}

// Makes the velocities fit the joints at the present poses.
bool JointFlight::fit(const JointIsland& island) {
    std::vector<double> velocity(change_.size());
    double last = infinity;
    for (int pass = 0; pass < tuning::joint_rounds; ++pass) {
        apply(island);
        double fastest = 0.0, worst = 0.0;
        for (std::size_t k = 0; k < island.bodies.size(); ++k) {
            Body& body = island.problem.bodies[island.bodies[k]];
            body.derive_velocities();
            for (int i = 0; i < 3; ++i) {
                velocity[6 * k + std::size_t(i)] = body.velocity[i];
                velocity[6 * k + 3 + std::size_t(i)] = rows_.length() * body.angular_velocity[i];
            }
            fastest = std::max({fastest, body.velocity.norm(), rows_.length() * body.angular_velocity.norm()});
        }
        for (const JointRows::Block& block : rows_.blocks())
            for (std::size_t k = block.first; k < block.first + block.count; ++k) {
                const JointRows::Row& row = rows_.rows()[k];
                asked_[k] = is_lock(row) ? -JointRows::dot(block, row, velocity) : 0.0;
                worst = std::max(worst, std::abs(asked_[k]));
            }
        if (!(worst > tuning::joint_flight_fits * fastest) || worst >= 0.5 * last) return std::isfinite(worst);
        last = worst;
        if (!impulses()) return false;
    }
    return true;
}

void JointFlight::kick(const JointIsland& island, std::span<const StepForce> forces, double share) {
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        Body& body = island.problem.bodies[island.bodies[k]];
        body.momentum += share * forces[k].push;
        body.angular_momentum += share * forces[k].turn;
    }
}

bool JointFlight::stage(const JointIsland& island, std::span<const StepForce> forces, double share) {
    std::vector<Body>& bodies = island.problem.bodies;
    kick(island, forces, 0.5 * share);
    kick_springs(island, 0.5 * island.problem.settings.h);
    const auto begin = [&] {
        for (std::size_t k = 0; k < island.bodies.size(); ++k) starts_[k] = state_of(bodies[island.bodies[k]]);
    };
    begin();
    if (!loaded_) {
        load(island);
        if (!matrix_.factor() || rows_.apart(tuning::joint_flight_open)) return false;
        closed_ = std::max(tuning::joint_flight_closed, 2.0 * rows_.place_rounding());
    }
    // The force that fitted the velocities at these poses is the first estimate.
    given_.assign(rows_.rows().size(), 0.0);
    const double h = island.problem.settings.h;
    for (const JointRows::Block& block : rows_.blocks()) {
        const Joint& joint = island.problem.joints->joints()[block.joint];
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const JointRows::Row& row = rows_.rows()[k];
            if (is_lock(row) && rows_.tree())
                given_[k] = h * joint.constraint_force[row.coordinate] / (row.turns() ? rows_.length() : 1.0);
        }
    }
    if (!close(island)) return false;
    for (const JointRows::Block& block : rows_.blocks()) {
        Joint& joint = island.problem.joints->joints()[block.joint];
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            JointRows::Row& row = rows_.rows()[k];
            row.impulse = given_[k];
            joint.constraint_force[row.coordinate] = given_[k] / h * (row.turns() ? rows_.length() : 1.0);
        }
    }
    add_up(island);
    swing_ = std::max(swing_, std::abs(h) * rows_.swing_rate(island));
    kick(island, forces, 0.5 * share);
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
        Body& body = bodies[island.bodies[k]];
        body.rotation = body.orientation.toRotationMatrix();
        body.derive();
    }
    kick_springs(island, 0.5 * h);
    begin();
    load(island);
    loaded_ = matrix_.factor();
    if (!loaded_) return false;
    given_.assign(rows_.rows().size(), 0.0);
    const auto each_lock = [&](auto&& visit) {
        for (const JointRows::Block& block : rows_.blocks())
            for (std::size_t k = block.first; k < block.first + block.count; ++k)
                if (const JointRows::Row& row = rows_.rows()[k]; is_lock(row)) {
                    Joint& joint = island.problem.joints->joints()[block.joint];
                    visit(k, row.turns() ? rows_.length() : 1.0, joint.constraint_force[row.coordinate],
                          joint.constraint_rate[row.coordinate]);
                }
    };
    if (rows_.tree())
        each_lock(
            [&](std::size_t k, double unit, double force, double rate) { given_[k] = h / unit * (force + h * rate); });
    if (!fit(island)) return false;
    each_lock([&](std::size_t k, double unit, double& force, double& rate) {
        const double last = force;
        force = unit / h * given_[k];
        rate = (force - last) / h;
    });
    add_up(island);
    return true;
}

// Sums the impulses of the stages in Joint::force and torque, and in the accounts of the joints.
void JointFlight::add_up(const JointIsland& island) {
    for (const JointRows::Block& block : rows_.blocks()) {
        Joint& joint = island.problem.joints->joints()[block.joint];
        JointLoad load;
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const JointRows::Row& row = rows_.rows()[k];
            (row.turns() ? load.torque : load.force) +=
                (row.turns() ? rows_.length() : 1.0) * given_[k] * row.direction;
        }
        joint.force += load.force;
        joint.torque += load.torque;
        load.moment = block.point.cross(load.force) + load.torque;
        const auto work = [&](std::uint32_t body, int place) {
            if (place == JointRows::none) return 0.0;
            const Body& b = island.problem.bodies[body];
            const RigidState& start = starts_[std::size_t(place)];
            const Vec3 turn = (block.point - start.position).cross(load.force) + load.torque;
            return 0.5 * (b.inverse_mass * load.force.dot(start.momentum + b.momentum) +
                          turn.dot(b.inverse_inertia * (start.angular_momentum + b.angular_momentum)));
        };
        joint.account.step.add_flight(load, -work(joint.a, block.a), work(joint.b, block.b), !joint.account.holds);
    }
}

void JointFlight::prepare(const JointIsland& island) {
    swing_ = total_mass_ = 0.0;
    for (const std::uint32_t i : island.bodies) total_mass_ += island.problem.bodies[i].mass;
    starts_.resize(island.bodies.size());
    change_.resize(6 * island.bodies.size());
}

bool JointFlight::advance(const JointIsland& island, std::span<const StepForce> forces, int order, int substeps) {
    prepare(island);
    loaded_ = false;
    const double h = island.problem.settings.h;
    for (const std::uint32_t k : island.joints) {
        Joint& joint = island.problem.joints->joints()[island.problem.joints->active()[k]];
        joint.force.setZero();
        joint.torque.setZero();
        joint.account.step = {};
        joint.account.step.work.springs =
            JointSet::potential(joint, island.problem.bodies);  // no heat: without dampers
    }
    const std::vector<double> stages = stages_of(order);
    for (int substep = 0; substep < substeps; ++substep)
        for (const double share : stages) {
            ContactProblem part = island.problem;
            part.settings.h *= share / substeps;
            const JointIsland now{part, island.bodies, island.joints, island.length, island.from, island.to};
            if (!stage(now, forces, share / substeps)) return false;
            if (swing_ > tuning::joint_swing) return false;
        }
    // Limits and strengths are looked at once a step: a step that meets one is left to the solver of contacts.
    for (const JointRows::Block& block : rows_.blocks()) {
        Joint& joint = island.problem.joints->joints()[block.joint];
        joint.account.step.work.springs -= JointSet::potential(joint, island.problem.bodies);
        joint.force /= h;
        joint.torque /= h;
        if (rows_.violates_limit(island, block)) return false;
        const JointDescription& strength = joint.description;
        const double over =
            std::max({joint.force.norm() / strength.break_force, h * joint.force.norm() / strength.break_impulse,
                      joint.torque.norm() / strength.break_torque});
        if (over > tuning::joint_flight_over) return false;
        if (over > 1.0) {
            joint.broken = true;
            joint.broken_at = island.to;
        }
        joint.impulse = {};
        joint.curving = {};
        joint.point = block.point;
        for (std::size_t c = 0; c < joint.count(); ++c)
            if (joint.locked(c)) joint.impulse[c][Joint::lock] = 2.0 * joint.constraint_force[c] * h;
    }
    return true;
}

}  // namespace tumble
