#include "sim/contact/direct/flight_locks.h"

#include "core/fetch_ahead.h"
#include "sim/joints/swing.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

Mat3 skew(const Vec3& r) {
    Mat3 s;
    s << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
    return s;
}

/// A 6 x 6 block as four of 3 x 3, by velocities and angular velocities.
struct Quarters {
    Mat3 vv, vw, wv, ww;

    void add_to(BlockCholesky::Block& block, double factor) const {
        for (int r = 0; r < 3; ++r) {
            block.row[r] +=
                factor * BlockCholesky::Row{vv(r, 0), vv(r, 1), vv(r, 2), vw(r, 0), vw(r, 1), vw(r, 2), 0.0, 0.0};
            block.row[3 + r] +=
                factor * BlockCholesky::Row{wv(r, 0), wv(r, 1), wv(r, 2), ww(r, 0), ww(r, 1), ww(r, 2), 0.0, 0.0};
        }
    }
    Quarters transposed() const { return {vv.transpose(), wv.transpose(), vw.transpose(), ww.transpose()}; }
};

// Sum of [n; S_1 n] [n; S_2 n]^T over the locked displacements, with P = sum of n n^T, and `turns` = sum of n n^T over the
// locked angles; S: cross product with an arm in units of the island's length.
Quarters square(const Mat3& p, bool all, const Mat3& s_1, const Mat3& s_2, const Mat3& turns) {
    if (all) return {Mat3::Identity(), s_2.transpose(), s_1, s_1 * s_2.transpose() + turns};
    const Mat3 left = s_1 * p;
    return {p, p * s_2.transpose(), left, left * s_2.transpose() + turns};
}

}  // namespace

std::uint32_t FlightLocks::add_still(const JointIsland& island, std::uint32_t body) {
    FlightBody& still = bodies_.emplace_back();
    if (body != Joint::world) {
        still.state.position = island.problem.bodies[body].position;
        still.state.orientation = island.problem.bodies[body].orientation;
        still.rotation = still.state.orientation.toRotationMatrix();
    }
    return std::uint32_t(bodies_.size() - 1);
}

void FlightLocks::list(const JointIsland& island) {
    joints_.clear();
    frames_.clear();
    locks_.clear();
    bool still = false;
    for (const std::uint32_t index : listed_) {
        const Joint& joint = island.problem.joints->joints()[index];
        JointFrame& frame = frames_.emplace_back();
        frame.index = index;
        frame.locks = joint.locks;
        frame.anchor_a = joint.anchor_a;
        frame.anchor_b = joint.anchor_b;
        frame.frame_a = joint.frame_a.toRotationMatrix();
        frame.frame_b = joint.frame_b.toRotationMatrix();
        FlightJoint& j = joints_.emplace_back();
        j.size = joint.size;
        j.first = std::uint32_t(locks_.size());
        for (std::size_t k = 0; k < joint.count(); ++k) {
            if (!joint.locked(k)) continue;
            Lock& lock = locks_.emplace_back();
            lock.coordinate = std::uint8_t(k);
            lock.turns = k >= 3;
            j.moves += !lock.turns;
        }
        j.count = std::uint32_t(locks_.size()) - j.first;
        const int a = contact_rows::place_of(island.bodies, joint.a),
                  b = contact_rows::place_of(island.bodies, joint.b);
        j.a = std::uint32_t(a);
        j.b = std::uint32_t(b);
        still = still || a == contact_rows::none || b == contact_rows::none;
    }
    forces_.resize(locks_.size());
    // A connected graph is a tree if it has one edge less than nodes; all bodies that stand still are one node.
    tree_ = joints_.size() + 1 == island.bodies.size() + still;
}

bool FlightLocks::load(const JointIsland& island) {
    length_ = island.length;
    moving_ = island.bodies.size();
    const std::vector<std::uint32_t>& active = island.problem.joints->active();
    std::vector<Joint>& joints = island.problem.joints->joints();
    asked_for_.clear();
    for (const std::uint32_t k : island.joints)
        if (!joints[active[k]].broken) asked_for_.push_back(active[k]);
    const bool same = asked_for_ == listed_ && std::ranges::equal(island.bodies, listed_bodies_);
    if (!same) {
        listed_ = asked_for_;
        listed_bodies_.assign(island.bodies.begin(), island.bodies.end());
        list(island);
    }
    bodies_.resize(moving_);
    total_mass_ = 0.0;
    for (std::size_t k = 0; k < moving_; ++k) {
        const Body& body = island.problem.bodies[island.bodies[k]];
        FlightBody& to = bodies_[k];
        to.state = state_of(body);
        to.inertia = mass_of(body);
        to.mass = body.mass;
        to.inertia_body = body.inertia_body;
        to.spherical_top = body.spherical_top;
        to.least_inertia = body.principal_inertia.minCoeff();
        to.rotation = body.rotation;
        to.inverse_inertia = body.inverse_inertia;
        to.velocity = body.velocity;
        to.spin = body.angular_velocity;
        total_mass_ += body.mass;
    }
    for (std::size_t k = 0; k < joints_.size(); ++k) {
        if (k + elements_ahead < joints_.size()) {
            const Joint& later = joints[frames_[k + elements_ahead].index];
            fetch_ahead(&later.constraint_force, &later.force);
        }
        FlightJoint& j = joints_[k];
        Joint& joint = joints[frames_[k].index];
        frames_[k].joint = &joint;
        if (!moves(j.a)) j.a = add_still(island, joint.a);
        if (!moves(j.b)) j.b = add_still(island, joint.b);
        for (std::uint32_t i = j.first; i < j.first + j.count; ++i)
            forces_[i] = {joint.constraint_force[locks_[i].coordinate], joint.constraint_rates[locks_[i].coordinate]};
        j.load = {};
        j.work_a = j.work_b = j.lock_work = j.springs = 0.0;
    }
    return !same;
}

void FlightLocks::give_back(const JointIsland& island) const {
    for (std::size_t k = 0; k < moving_; ++k) set_state(island.problem.bodies[island.bodies[k]], bodies_[k].state);
}

double FlightLocks::fastest_turn() const {
    double square = 0.0;
    for (const FlightJoint& j : joints_)
        square = std::max(square, (bodies_[j.b].spin - bodies_[j.a].spin).squaredNorm());
    return std::sqrt(square);
}

double FlightLocks::place_rounding() const {
    double farthest = 0.0, smallest = infinity;
    for (const FlightJoint& j : joints_) {
        farthest = std::max(farthest, j.point.cwiseAbs().maxCoeff());
        smallest = std::min(smallest, j.size);
    }
    return 2.0 * std::numeric_limits<double>::epsilon() * farthest / smallest;
}

// Returns the anchor of B.
Vec3 FlightLocks::measure_at(const FlightJoint& j, Coordinates& coordinates) const {
    const FlightBody &a = bodies_[j.a], &b = bodies_[j.b];
    const JointFrame& constant = frame_of(j);
    JointFrames frames;
    frames.anchor_a = a.state.position + a.rotation * constant.anchor_a;
    frames.anchor_b = b.state.position + b.rotation * constant.anchor_b;
    if (!constant.locks.distance) {
        frames.a = a.rotation * constant.frame_a;
        if (j.count > j.moves) frames.b = b.rotation * constant.frame_b;
        if (j.count == j.moves + 3) {
            frames.turn_a = a.state.orientation * constant.joint->frame_a;
            frames.turn_b = b.state.orientation * constant.joint->frame_b;
        }
    }
    measure_locks(constant.locks, frames, coordinates);
    return frames.anchor_b;
}

double FlightLocks::look(FlightJoint& j) {
    double worst = 0.0;
    Coordinates coordinates;
    j.point = measure_at(j, coordinates);
    j.arm_a = j.point - bodies_[j.a].state.position;
    j.arm_b = j.point - bodies_[j.b].state.position;
    for (Lock& lock : locks(j)) {
        lock.direction = coordinates[lock.coordinate].direction;
        worst = std::max(worst, std::abs(coordinates[lock.coordinate].value) / (lock.turns ? 1.0 : j.size));
    }
    return worst;
}

void FlightLocks::fill(BlockCholesky& matrix, double compliance) const {
    matrix.set_zero();
    for (std::size_t k = 0; k < moving_; ++k) {
        const FlightBody& body = bodies_[k];
        const Mat3 inertia = body.rotation * body.inertia_body * body.rotation.transpose() / (length_ * length_);
        BlockCholesky::Block& block = matrix.diagonal(k);
        for (int r = 0; r < 3; ++r) {
            block.row[r][r] = body.mass;
            for (int c = 0; c < 3; ++c) block.row[3 + r][3 + c] = inertia(r, c);
        }
    }
    const double weight = 1.0 / compliance;
    for (const FlightJoint& j : joints_) {
        Mat3 along = Mat3::Zero(), turns = Mat3::Zero();
        const bool all = j.moves == 3;
        for (std::uint32_t k = j.first + (all ? 3 : 0); k < j.first + j.count; ++k) {
            const Vec3& n = locks_[k].direction;
            (locks_[k].turns ? turns : along) += n * n.transpose();
        }
        const Mat3 s_a = skew(j.arm_a / length_), s_b = skew(j.arm_b / length_);
        if (moves(j.a)) square(along, all, s_a, s_a, turns).add_to(matrix.diagonal(j.a), weight);
        if (moves(j.b)) square(along, all, s_b, s_b, turns).add_to(matrix.diagonal(j.b), weight);
        if (!moves(j.a) || !moves(j.b)) continue;
        const Quarters coupling = square(along, all, s_a, s_b, turns);
        (matrix.transposed(j.pair) ? coupling.transposed() : coupling).add_to(matrix.coupling(j.pair), -weight);
    }
}

double FlightLocks::ask_to_close(const FlightJoint& j, double h) {
    double worst = 0.0;
    Coordinates coordinates;
    measure_at(j, coordinates);
    // The errors as vectors: the rows keep the directions that they had at the start.
    Vec3 apart = Vec3::Zero(), turned = Vec3::Zero();
    for (const Lock& lock : locks(j)) {
        const auto& [direction, value] = coordinates[lock.coordinate];
        (lock.turns ? turned : apart) += value * direction;
        worst = std::max(worst, std::abs(value) / (lock.turns ? 1.0 : j.size));
    }
    for (Lock& lock : locks(j)) lock.asked = -unit(lock) / h * lock.direction.dot(lock.turns ? turned : apart);
    return worst;
}

double FlightLocks::ask_to_fit(const FlightJoint& j) {
    double worst = 0.0;
    const FlightBody &a = bodies_[j.a], &b = bodies_[j.b];
    const Vec3 turning = b.spin - a.spin;
    const Vec3 apart = b.velocity + b.spin.cross(j.arm_b) - a.velocity - a.spin.cross(j.arm_a);
    for (Lock& lock : locks(j)) {
        lock.asked = -unit(lock) * lock.direction.dot(lock.turns ? turning : apart);
        worst = std::max(worst, std::abs(lock.asked));
    }
    return worst;
}

void FlightLocks::add_asked(double compliance, std::vector<double>& g) const {
    std::fill(g.begin(), g.end(), 0.0);
    for (const FlightJoint& j : joints_) {
        Vec3 push = Vec3::Zero(), turn = Vec3::Zero();
        for (std::uint32_t k = j.first; k < j.first + j.count; ++k)
            (locks_[k].turns ? turn : push) += locks_[k].asked / compliance * locks_[k].direction;
        if (moves(j.a)) {
            contact_rows::three(g, 6 * j.a) -= push;
            contact_rows::three(g, 6 * j.a + 3) -= j.arm_a.cross(push) / length_ + turn;
        }
        if (moves(j.b)) {
            contact_rows::three(g, 6 * j.b) += push;
            contact_rows::three(g, 6 * j.b + 3) += j.arm_b.cross(push) / length_ + turn;
        }
    }
}

bool FlightLocks::take(const std::vector<double>& change, double compliance) {
    double sum = 0.0;
    for (const FlightJoint& j : joints_) {
        Vec3 apart = Vec3::Zero(), turning = Vec3::Zero();
        const auto add = [&](std::uint32_t place, const Vec3& arm, double sign) {
            if (!moves(place)) return;
            const Vec3 turn = contact_rows::three(change, 6 * place + 3);
            apart += sign * (contact_rows::three(change, 6 * place) + turn.cross(arm) / length_);
            turning += sign * turn;
        };
        add(j.a, j.arm_a, -1.0);
        add(j.b, j.arm_b, 1.0);
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
        for (Lock& lock : locks(j)) {
            const double more = (lock.asked - lock.direction.dot(lock.turns ? turning : apart)) / compliance;
            lock.given += more;
            (lock.turns ? torque : force) += unit(lock) * more * lock.direction;
            sum += lock.given;
        }
        give(j, force, torque);
    }
    return std::isfinite(sum);
}

void FlightLocks::estimate(const FlightJoint& j, double h, ConstraintRate ConstraintRates::*which) {
    for (std::uint32_t k = j.first; k < j.first + j.count; ++k) {
        const ConstraintRate& rate = forces_[k].rates.*which;
        Lock& lock = locks_[k];
        lock.given = tree_ ? h / unit(lock) * (forces_[k].force + h * (2.0 * rate.now - rate.before)) : 0.0;
    }
}

void FlightLocks::learn(const FlightJoint& j, double h, ConstraintRate ConstraintRates::*which) {
    for (std::uint32_t k = j.first; k < j.first + j.count; ++k) {
        ConstraintRate& rate = forces_[k].rates.*which;
        const double last = forces_[k].force;
        forces_[k].force = unit(locks_[k]) / h * locks_[k].given;
        rate.before = rate.now;
        rate.now = (forces_[k].force - last) / h;
    }
}

void FlightLocks::clear_given() {
    for (Lock& lock : locks_) lock.given = 0.0;
}

JointLoad FlightLocks::load_of(const FlightJoint& j) const {
    JointLoad load;
    for (std::uint32_t k = j.first; k < j.first + j.count; ++k) {
        const Lock& lock = locks_[k];
        (lock.turns ? load.torque : load.force) += unit(lock) * lock.given * lock.direction;
    }
    return load;
}

void FlightLocks::give(const FlightJoint& j, const Vec3& force, const Vec3& torque) {
    if (moves(j.a)) {
        RigidState& a = bodies_[j.a].state;
        a.momentum -= force;
        a.angular_momentum -= j.arm_a.cross(force) + torque;
    }
    if (moves(j.b)) {
        RigidState& b = bodies_[j.b].state;
        b.momentum += force;
        b.angular_momentum += j.arm_b.cross(force) + torque;
    }
}

double FlightLocks::add_swing(const FlightJoint& j, const JointLoad& load, double h) {
    const double force = load.force.norm() / (3.0 * std::abs(h));
    double bound = 0.0;
    const auto add = [&](std::uint32_t place, const Vec3& arm) {
        if (!moves(place)) return;
        swing_[place] += force * arm.norm() / bodies_[place].least_inertia;
        bound = std::max(bound, swing_[place]);
    };
    add(j.a, j.arm_a);
    add(j.b, j.arm_b);
    return bound;
}

double FlightLocks::swing_rate(double h) {
    begin_swing();
    double most = 0.0;
    for (const FlightJoint& j : joints_) {
        const Vec3 force = load_of(j).force / h;
        const Joint& its = joint(j);
        const SwingAxes axes = swing_axes(its, measure(its, side(j.a), side(j.b)));
        const auto add = [&](std::uint32_t place, const Vec3& arm) {
            if (!moves(place)) return;
            swing_[place] += force.norm() * swing_compliance(axes, arm, bodies_[place].inverse_inertia);
            most = std::max(most, swing_[place]);
        };
        add(j.a, j.arm_a);
        add(j.b, j.arm_b);
    }
    return std::sqrt(most);
}

}  // namespace tumble
