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

// The structure of the matrix, for the island's joints.
void JointFlight::analyze(const JointIsland& island) {
    if (locks_.load(island)) {
        pairs_.clear();
        springs_ = false;
        for (FlightLocks::FlightJoint& j : locks_.joints()) {
            springs_ = springs_ || has_springs(*j.joint);
            j.pair = std::uint32_t(pairs_.size());
            if (locks_.moves(j.a) && locks_.moves(j.b)) pairs_.push_back({j.a, j.b});
        }
        if (locks_.tree())
            tree_.analyze(locks_);
        else
            matrix_.analyze(island.bodies.size(), pairs_);
        change_.resize(6 * island.bodies.size());
    }
    swing_ = 0.0;
    loaded_ = false;
}

// The equations at the present poses, of a stage of `h` s. Returns false where they cannot be factored.
bool JointFlight::load(double h) {
    if (locks_.tree()) return tree_.factor(locks_);
    const double joints = double(locks_.joints().size()), bodies = double(locks_.bodies().size());
    // In a singular position the gap along the vanishing row is (h w)^2 / 2: without this compliance its correction
    // would be divided by zero.
    const double turn = h * locks_.fastest_turn();
    const double singular = tuning::joint_singular * turn * turn * turn * turn * bodies;
    compliance_ = std::max(tuning::joint_compliance / joints, singular) / locks_.total_mass();
    locks_.fill(matrix_, compliance_);
    return matrix_.factor();
}

// The least impulses that change J u as asked; with loops but for the compliance: M du = J^T f, f = (asked - J du) / R.
bool JointFlight::change() {
    if (locks_.tree()) return tree_.solve(locks_);
    locks_.add_asked(compliance_, change_);
    matrix_.solve(change_);
    return locks_.take(change_, compliance_);
}

void JointFlight::kick(const Stage& stage) {
    std::span<FlightBody> bodies = locks_.bodies();
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        bodies[k].state.momentum += 0.5 * stage.share * stage.forces[k].push;
        bodies[k].state.angular_momentum += 0.5 * stage.share * stage.forces[k].turn;
    }
    if (springs_) kick_springs(0.5 * stage.h);
}

void JointFlight::begin_drift() {
    for (FlightBody& body : locks_.bodies()) body.start = body.state;
}

void JointFlight::drift(double h) {
    for (FlightBody& body : locks_.bodies()) {
        body.state.position = body.start.position;
        body.state.orientation = body.start.orientation;
        const Vec3 angular_momentum = body.state.angular_momentum;
        free_drift(body.state, body.inertia, h);
        body.state.angular_momentum = angular_momentum;
        body.rotation = body.state.orientation.toRotationMatrix();
    }
}

bool JointFlight::close(double h) {
    double last = infinity;
    for (int pass = 0; pass < tuning::joint_rounds; ++pass) {
        locks_.apply();
        drift(h);
        const double error = locks_.ask_to_close(h);
        if (!std::isfinite(error)) return false;
        if (error <= closed_ || (error < tuning::joint_rounding && error >= 0.5 * last)) return true;
        // In a singular position the gap along the vanishing row closes slowly, and by itself when that is passed.
        if (pass > 4 && error >= 0.9 * last) return error < tuning::joint_flight_open;
        last = error;
        if (!change()) return false;
    }
    return last < tuning::joint_flight_open;
}

void JointFlight::close_poses(const JointIsland& island) {
    analyze(island);
    double last = infinity;
    for (int pass = 0; pass < tuning::joint_rounds; ++pass) {
        locks_.look();
        const double error = locks_.ask_to_close(1.0);
        if (!(error < tuning::joint_clamped_open) || error <= tuning::joint_closed || error >= 0.5 * last) break;
        last = error;
        locks_.clear_given();
        if (!load(island.problem.settings.h) || !change()) return;
        if (locks_.tree()) tree_.changes(locks_, change_);
        std::span<FlightBody> bodies = locks_.bodies();
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            FlightBody& body = bodies[k];
            body.state.position += Vec3::Map(&change_[6 * k]);
            body.state.orientation =
                (from_rotation_vector(Vec3::Map(&change_[6 * k + 3]) / island.length) * body.state.orientation)
                    .normalized();
            body.derive();
        }
    }
    if (last < infinity) locks_.give_back(island);
}

// Makes the velocities fit the joints at the present poses.
bool JointFlight::fit() {
    double last = infinity;
    for (int pass = 0; pass < tuning::joint_rounds; ++pass) {
        locks_.apply();
        double fastest = 0.0;
        for (FlightBody& body : locks_.bodies()) {
            body.derive_velocities();
            fastest = std::max({fastest, body.velocity.squaredNorm(), (locks_.length() * body.spin).squaredNorm()});
        }
        const double worst = locks_.ask_to_fit();
        if (!(worst > coarse_ * tuning::joint_flight_fits * std::sqrt(fastest)) || worst >= 0.5 * last)
            return std::isfinite(worst);
        last = worst;
        if (!change()) return false;
    }
    return true;
}

bool JointFlight::fly(const Stage& stage) {
    const double h = stage.h;
    kick(stage);
    begin_drift();
    if (!loaded_) {
        if (locks_.look() > tuning::joint_flight_open || !load(h)) return false;
        closed_ = std::max(coarse_ * tuning::joint_flight_closed, 2.0 * locks_.place_rounding());
    }
    locks_.estimate(h, &ConstraintRates::closing);
    if (!close(h)) return false;
    locks_.learn(h, &ConstraintRates::closing);
    add_up();
    swing_ = std::max(swing_, std::abs(h) * locks_.swing_rate(h, tuning::joint_easy_swing / std::abs(h)));
    kick(stage);
    begin_drift();
    for (FlightBody& body : locks_.bodies()) body.derive();
    locks_.look();
    loaded_ = load(h);
    if (!loaded_) return false;
    locks_.estimate(h, &ConstraintRates::fitting);
    if (!fit()) return false;
    locks_.learn(h, &ConstraintRates::fitting);
    add_up();
    return true;
}

// Sums the impulses of the stages in Joint::force and torque, and in the accounts of the joints.
void JointFlight::add_up() {
    for (const FlightLocks::FlightJoint& j : locks_.joints()) {
        Joint& joint = *j.joint;
        JointLoad load = locks_.load_of(j);
        joint.force += load.force;
        joint.torque += load.torque;
        load.moment = j.point.cross(load.force) + load.torque;
        const auto work = [&](std::uint32_t place, const Vec3& arm) {
            if (!locks_.moves(place)) return 0.0;
            const FlightBody& body = locks_.body(place);
            const Vec3 turn = arm.cross(load.force) + load.torque;
            return 0.5 * (body.inertia.inverse_mass * load.force.dot(body.start.momentum + body.state.momentum) +
                          turn.dot(body.inverse_inertia * (body.start.angular_momentum + body.state.angular_momentum)));
        };
        joint.account.step.add_flight(load, -work(j.a, j.arm_a), work(j.b, j.arm_b), !joint.account.holds);
    }
}

bool JointFlight::advance(const JointIsland& island, std::span<const StepForce> forces, int order, int substeps) {
    analyze(island);
    const double h = island.problem.settings.h;
    for (const FlightLocks::FlightJoint& j : locks_.joints()) {
        Joint& joint = *j.joint;
        joint.force.setZero();
        joint.torque.setZero();
        joint.account.step = {};
        if (springs_)  // no heat: without dampers
            joint.account.step.work.springs = JointSet::potential(joint, island.problem.bodies);
    }
    locks_.take_forces();
    const std::vector<double> stages = stages_of(order);
    coarse_ = stages.size() == 1 ? tuning::joint_flight_coarse : 1.0;
    for (int substep = 0; substep < substeps; ++substep)
        for (const double share : stages) {
            if (!fly({forces, share / substeps, h * (share / substeps)})) return false;
            if (swing_ > tuning::joint_swing) return false;
            if (stages.size() > 1 || substeps > 1) count_turns();
        }
    locks_.give_back(island);
    locks_.keep_forces();
    return end(island);
}

// Whole turns are counted from stage to stage.
void JointFlight::count_turns() {
    for (const FlightLocks::FlightJoint& j : locks_.joints()) {
        if (j.count == j.joint->count()) continue;
        const JointGeometry g = measure(*j.joint, locks_.side(j.a), locks_.side(j.b));
        for (std::size_t k = 0; k < j.joint->count(); ++k)
            if (!j.joint->locked(k)) j.joint->value[k] = g.coordinates[k].value;
    }
}

// Limits and strengths are looked at once a step: a step that meets one is left to the solver of contacts.
bool JointFlight::end(const JointIsland& island) {
    const double h = island.problem.settings.h;
    for (const FlightLocks::FlightJoint& j : locks_.joints()) {
        Joint& joint = *j.joint;
        if (springs_) joint.account.step.work.springs -= JointSet::potential(joint, island.problem.bodies);
        joint.force /= h;
        joint.torque /= h;
        if (j.count < joint.count()) {
            const JointGeometry g = measure(joint, locks_.side(j.a), locks_.side(j.b));
            if (beyond_limit(joint, g)) return false;
            for (std::size_t k = 0; k < joint.count(); ++k)
                if (!joint.locked(k)) joint.value[k] = g.coordinates[k].value;
        }
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
        joint.point = j.point;
        for (const FlightLocks::Lock& lock : locks_.locks(j))
            joint.impulse[lock.coordinate][Joint::lock] = 2.0 * lock.force * h;
    }
    return true;
}

}  // namespace tumble
