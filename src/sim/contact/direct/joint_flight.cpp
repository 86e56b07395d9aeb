#include "sim/contact/direct/joint_flight.h"

#include "core/fetch_ahead.h"
#include "sim/dynamics/integrator.h"
#include "sim/dynamics/integrators/composition.h"
#include "sim/dynamics/integrators/splitting.h"
#include "sim/joints/flight_way.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tumble {
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

// The structure of the equations, for the island's joints.
void JointFlight::analyze(const JointIsland& island) {
    if (locks_.load(island)) {
        pairs_.clear();
        springs_ = false;
        for (FlightLocks::FlightJoint& j : locks_.joints()) {
            springs_ = springs_ || has_springs(locks_.joint(j));
            j.pair = std::uint32_t(pairs_.size());
            if (locks_.moves(j.a) && locks_.moves(j.b)) pairs_.push_back({j.a, j.b});
        }
        matrix_.analyze(island.bodies.size(), pairs_);
        change_.resize(6 * island.bodies.size());
    }
    swing_ = 0.0;
    loaded_ = false;
}

// Looks at all joints, and estimates their impulses of a stage of `h` s. Returns the largest error, in sizes of the joint.
double JointFlight::look(double h, std::optional<Rate> rate) {
    double worst = 0.0;
    for (FlightLocks::FlightJoint& j : locks_.joints()) {
        worst = std::max(worst, locks_.look(j));
        if (rate) estimate(j, h, *rate);
    }
    return worst;
}

// The equations at the present poses, after look(), of a stage of `h` s. Returns false where they cannot be factored.
bool JointFlight::load(double h) {
    const double joints = double(locks_.joints().size()), bodies = double(locks_.bodies().size());
    // In a singular position the gap along the vanishing row is (h w)^2 / 2: without this compliance its correction
    // would be divided by zero.
    const double turn = h * locks_.fastest_turn();
    const double singular = tuning::joint_singular * turn * turn * turn * turn * bodies;
    compliance_ = std::max(tuning::joint_compliance / joints, singular) / locks_.total_mass();
    locks_.fill(matrix_, compliance_);
    return matrix_.factor();
}

// The least impulses that change J u as asked, but for the compliance: M du = J^T f, f = (asked - J du) / R.
bool JointFlight::change() {
    locks_.add_asked(compliance_, change_);
    matrix_.solve(change_);
    return locks_.take(change_, compliance_);
}

void JointFlight::kick(const Stage& stage, bool moved) {
    std::span<FlightBody> bodies = locks_.bodies();
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        FlightBody& body = bodies[k];
        body.state.momentum += 0.5 * stage.share * stage.forces[k].push;
        body.state.angular_momentum += 0.5 * stage.share * stage.forces[k].turn;
        if (moved) {
            body.derive_inertia();
            body.derive_velocities();  // for the fastest turn
        }
        body.start = body.state;
    }
    if (!springs_) return;
    kick_springs(0.5 * stage.h);
    for (FlightBody& body : bodies) body.start = body.state;
}

void JointFlight::drift(FlightBody& body, double h) const {
    body.state.position = body.start.position;
    body.state.orientation = body.start.orientation;
    const Vec3 angular_momentum = body.state.angular_momentum;
    free_drift(body.state, body.inertia, h);
    body.state.angular_momentum = angular_momentum;
    body.rotation = body.state.orientation.toRotationMatrix();
}

// The equations, if they are not loaded, and the first estimate of the impulses.
bool JointFlight::start(double h, Rate rate) {
    if (loaded_) {
        for (const FlightLocks::FlightJoint& j : locks_.joints()) estimate(j, h, rate);
        return true;
    }
    loaded_ = look(h, rate) <= tuning::joint_flight_open && load(h);
    return loaded_;
}

void JointFlight::estimate(const FlightLocks::FlightJoint& j, double h, Rate rate) {
    locks_.estimate(j, h, rate);
    const JointLoad load = locks_.load_of(j);
    locks_.give(j, load.force, load.torque);
}

// Keeps the impulses, and their swing where they closed the joints.
void JointFlight::finish(const Stage& stage, Rate rate) {
    const bool swings = rate == &ConstraintRates::closing;
    double bound = 0.0;
    if (swings) locks_.begin_swing();
    for (FlightLocks::FlightJoint& j : locks_.joints()) {
        locks_.learn(j, stage.h, rate);
        const JointLoad load = locks_.load_of(j);
        add_up(j, load);
        if (swings) bound = std::max(bound, locks_.add_swing(j, load, stage.h));
    }
    if (swings) swing_ = std::max(swing_, find_swing(bound, stage.h));
}

// The phase of the fastest swing in a stage, from a bound of the square of its rate.
double JointFlight::find_swing(double bound, double h) {
    const double phase = std::abs(h) * std::sqrt(bound);
    return phase < tuning::joint_easy_swing ? phase : std::abs(h) * locks_.swing_rate(h);
}

bool JointFlight::close(double h) {
    double last = infinity;
    for (int pass = 0; pass < tuning::joint_rounds; ++pass) {
        double error = 0.0;
        for (FlightBody& body : locks_.bodies()) drift(body, h);
        for (const FlightLocks::FlightJoint& j : locks_.joints()) error = std::max(error, locks_.ask_to_close(j, h));
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
    for (FlightBody& body : locks_.bodies()) body.start = body.state;
    double last = infinity;
    for (int pass = 0; pass < tuning::joint_rounds; ++pass) {
        look(1.0, {});
        double error = 0.0;
        for (const FlightLocks::FlightJoint& j : locks_.joints()) error = std::max(error, locks_.ask_to_close(j, 1.0));
        if (!(error < tuning::joint_clamped_open) || error <= tuning::joint_closed || error >= 0.5 * last) break;
        last = error;
        locks_.clear_given();
        if (!load(island.problem.settings.h) || !change()) return;
        std::span<FlightBody> bodies = locks_.bodies();
        for (std::size_t k = 0; k < bodies.size(); ++k) {
            FlightBody& body = bodies[k];
            body.state.position += Vec3::Map(&change_[6 * k]);
            body.state.orientation =
                (from_rotation_vector(Vec3::Map(&change_[6 * k + 3]) / island.length) * body.state.orientation)
                    .normalized();
            body.rotation = body.state.orientation.toRotationMatrix();
            body.derive_inertia();
            body.state.momentum = body.start.momentum;
            body.state.angular_momentum = body.start.angular_momentum;
        }
    }
    if (last < infinity) locks_.give_back(island);
}

// Makes the velocities fit the joints at the present poses.
bool JointFlight::fit() {
    double last = infinity;
    for (int pass = 0; pass < tuning::joint_rounds; ++pass) {
        double fastest = 0.0, worst = 0.0;
        for (FlightBody& body : locks_.bodies()) {
            body.derive_velocities();
            fastest = std::max({fastest, body.velocity.squaredNorm(), (locks_.length() * body.spin).squaredNorm()});
        }
        for (const FlightLocks::FlightJoint& j : locks_.joints()) worst = std::max(worst, locks_.ask_to_fit(j));
        if (!(worst > coarse_ * tuning::joint_flight_fits * std::sqrt(fastest)) || worst >= 0.5 * last)
            return std::isfinite(worst);
        last = worst;
        if (!change()) return false;
    }
    return true;
}

bool JointFlight::fly(const Stage& stage) {
    const bool fresh = !loaded_;
    kick(stage, false);
    if (!start(stage.h, &ConstraintRates::closing)) return false;
    if (fresh) closed_ = std::max(coarse_ * tuning::joint_flight_closed, 2.0 * locks_.place_rounding());
    if (!close(stage.h)) return false;
    finish(stage, &ConstraintRates::closing);
    if (swing_ > tuning::joint_swing) return false;
    kick(stage, true);
    loaded_ = false;
    if (!start(stage.h, &ConstraintRates::fitting) || !fit()) return false;
    finish(stage, &ConstraintRates::fitting);
    return true;
}

// Adds the impulses of a stage, and their work, to the sums of the flight.
void JointFlight::add_up(FlightLocks::FlightJoint& j, const JointLoad& load) {
    const auto work = [&](std::uint32_t place, const Vec3& arm) {
        if (!locks_.moves(place)) return 0.0;
        const FlightBody& body = locks_.body(place);
        const Vec3 turn = arm.cross(load.force) + load.torque;
        return 0.5 * (body.inertia.inverse_mass * load.force.dot(body.start.momentum + body.state.momentum) +
                      turn.dot(body.inverse_inertia * (body.start.angular_momentum + body.state.angular_momentum)));
    };
    const double on_a = -work(j.a, j.arm_a), on_b = work(j.b, j.arm_b);
    j.load.add({load.force, load.torque, j.point.cross(load.force) + load.torque});
    j.work_a += on_a;
    j.work_b += on_b;
    j.lock_work += on_a + on_b;
}

bool JointFlight::advance(const JointIsland& island, std::span<const StepForce> forces, int order, int substeps) {
    analyze(island);
    const double h = island.problem.settings.h;
    if (springs_)
        for (FlightLocks::FlightJoint& j : locks_.joints())
            j.springs = JointSet::potential(locks_.joint(j), island.problem.bodies);
    const std::vector<double> stages = composition_stages(order);
    coarse_ = stages.size() == 1 ? tuning::joint_flight_coarse : 1.0;
    for (int substep = 0; substep < substeps; ++substep)
        for (const double share : stages) {
            if (!fly({forces, share / substeps, h * (share / substeps)})) return false;
            if (stages.size() > 1 || substeps > 1) count_turns();
        }
    locks_.give_back(island);
    return end(island);
}

// Whole turns are counted from stage to stage.
void JointFlight::count_turns() {
    for (const FlightLocks::FlightJoint& j : locks_.joints()) {
        Joint& joint = locks_.joint(j);
        if (j.count == joint.count()) continue;
        const JointGeometry g = measure(joint, locks_.side(j.a), locks_.side(j.b));
        for (std::size_t k = 0; k < joint.count(); ++k)
            if (!joint.locked(k)) joint.value[k] = g.coordinates[k].value;
    }
}

// Limits and strengths are looked at once a step: a step that meets one is left to the solver of contacts.
bool JointFlight::end(const JointIsland& island) {
    const double h = island.problem.settings.h;
    std::span<const FlightLocks::FlightJoint> joints = locks_.joints();
    for (std::size_t place = 0; place < joints.size(); ++place) {
        if (place + elements_ahead < joints.size()) {
            const Joint& later = locks_.joint(joints[place + elements_ahead]);
            fetch_ahead(&later.anchor_a, &later.account.frame);
        }
        const FlightLocks::FlightJoint& j = joints[place];
        Joint& joint = locks_.joint(j);
        joint.force = j.load.force / h;
        joint.torque = j.load.torque / h;
        JointAccount::Span& step = joint.account.step;
        step = {};
        step.load = j.load;
        step.work_a = j.work_a;
        step.work_b = j.work_b;
        if (!joint.account.holds) step.work.impacts = -j.lock_work;
        if (springs_)  // no heat: without dampers
            step.work.springs = j.springs - JointSet::potential(joint, island.problem.bodies);
        step.solves = 1;
        if (j.count < joint.count()) {
            const JointGeometry g = measure(joint, locks_.side(j.a), locks_.side(j.b));
            if (joint.soft && beyond_limit(joint, g)) return false;
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
        std::span<const FlightLocks::LockForce> forces = locks_.forces(j);
        for (std::size_t k = 0; k < j.count; ++k) {
            const std::size_t coordinate = locks_.locks(j)[k].coordinate;
            joint.constraint_force[coordinate] = forces[k].force;
            joint.constraint_rates[coordinate] = forces[k].rates;
            joint.impulse[coordinate][Joint::lock] = 2.0 * forces[k].force * h;
        }
    }
    return true;
}

}  // namespace tumble
