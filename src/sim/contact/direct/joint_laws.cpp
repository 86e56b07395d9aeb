// JointRows: the rows of a joint, by the laws of its coordinates.
#include "sim/contact/direct/contact_rows.h"
#include "sim/contact/direct/joint_rows.h"
#include "sim/joints/joint.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

struct Target {
    double value = 0.0, speed = 0.0;  // at the end of the step; mean over it
};

Target target_of(const JointMotor& motor, double from, double to) {
    const double end = motor_target(motor, to);
    return {end, (end - motor_target(motor, from)) / (to - from)};
}

}  // namespace

JointRows::Row JointRows::make_row(const JointIsland& island, const Block& block, const Vec3& direction,
                                   std::size_t coordinate) const {
    Row row;
    row.direction = direction;
    row.coordinate = std::uint8_t(coordinate);
    row.compliance = compliance_;
    row.least = -infinity;
    row.most = infinity;
    const Joint& j = joint(block);
    const auto side = [&](std::uint32_t body, int place, double sign, double* six) {
        if (body == Joint::world) return;
        const Body& b = island.problem.bodies[body];
        const Vec3 arm = block.point - (place == none ? side_at(island, body).position : b.position);
        if (place != none) {
            if (row.turns())
                contact_rows::put(six, Vec3::Zero(), sign * direction);
            else
                contact_rows::put(six, sign * direction, sign / length_ * arm.cross(direction));
        } else if (b.moves()) {
            row.offset += sign * (row.turns() ? length_ * direction.dot(b.angular_velocity)
                                              : direction.dot(b.point_velocity(arm)));
        }
    };
    side(j.a, block.a, -1.0, row.on_a);
    side(j.b, block.b, 1.0, row.on_b);
    return row;
}

void JointRows::append_row(const Row& row) {
    const Block& block = blocks_.back();
    rows_.push_back(row);
    Row& added = rows_.back();
    const Joint& j = joint(block);
    double last = j.impulse[row.coordinate][row.law];
    // A flight by Verlet's method leaves the force alone.
    if (last == 0.0 && row.law == Joint::lock) last = h_ * row.direction.dot(row.turns() ? j.torque : j.force);
    if (!row.soft && !j.jammed && (tree_ || row.law != Joint::lock))
        added.estimate = std::clamp(row.turns() ? last / length_ : last, row.least, row.most);
}

// Rate of a coordinate, m/s or rad/s, and the two measures of its load: the part that forces and carriers of this step
// have added, and the change of the rate by an impulse on the two bodies without their other joints.
JointRows::LimitRates JointRows::limit_rates(const JointIsland& island, const Row& row, const Vec3& point) const {
    const Joint& j = joint(blocks_.back());
    LimitRates rates;
    for (const auto& [body, sign] : {std::pair(j.a, -1.0), std::pair(j.b, 1.0)}) {
        if (body == Joint::world) continue;
        const Body& b = island.problem.bodies[body];
        if (!b.moves()) continue;
        const int place = contact_rows::place_of(island.bodies, body);
        const BodyVelocity& before = place == none ? island.problem.before[body] : before_[std::size_t(place)];
        const Vec3 arm = point - side_at(island, body).position;
        const auto rate = [&, sign = sign](const Vec3& velocity, const Vec3& turn) {
            return sign * row.direction.dot(row.turns() ? turn : Vec3(velocity + turn.cross(arm)));
        };
        const double now = rate(b.velocity, b.angular_velocity), start = rate(before.velocity, before.angular_velocity);
        rates.speed += now;
        rates.at_start += start;
        rates.by_forces += b.dynamic() ? now - start : 0.0;
        // The velocity of a kinematic body is the mean of the step: half of the change.
        rates.gained += (b.dynamic() ? 1.0 : 2.0) * (now - start);
        if (!b.dynamic()) rates.by_carriers += 2.0 * std::abs(now - start);
        if (!b.dynamic()) continue;
        const Vec3 moment = row.turns() ? row.direction : Vec3(arm.cross(row.direction));
        rates.mobility += (row.turns() ? 0.0 : b.inverse_mass) + moment.dot(b.inverse_inertia * moment);
    }
    return rates;
}

void JointRows::add_limit(const JointIsland& island, const Row& row, double value, double limit, Joint::Law law) {
    Row r = row;
    const Joint& j = joint(blocks_.back());
    const bool above = law == Joint::lower;  // the coordinate must stay above the limit
    const double unit = row.turns() ? length_ : 1.0, tolerance = closed_share() * (row.turns() ? 1.0 : j.size);
    const double room = above ? value - limit : limit - value;  // negative: violated
    r.law = law;
    (above ? r.least : r.most) = 0.0;
    r.closes = true;
    r.rests = room <= tolerance;
    // A limit violated at the start is not left by speed: see add_correction().
    r.reference = room < -tolerance ? value : limit;
    r.goal = limit;
    r.target = unit * (r.reference - value) / h_;
    const double e = j.axis(row.coordinate).restitution;
    if (e > 0.0 && bounce_ && room >= -tolerance && !strike_of(blocks_.back().joint, r)) {
        const LimitRates rates = limit_rates(island, row, blocks_.back().point);
        const double sign = above ? -1.0 : 1.0;
        const double load =
            std::max(sign * rates.gained / h_, rates.mobility * std::abs(j.impulse[row.coordinate][law]) / part_);
        const double hop = least_hop_ * step_ * load;  // a rebound of this speed is back at once
        const double rounding = tuning::limit_rest * fastest_ / (row.turns() ? length_ : 1.0);
        r.approach = sign * rates.at_start;
        r.room = r.rests ? 0.0 : room;
        // The velocities of carriers jump from step to step.
        const double least = std::max(rounding, island.problem.settings.threshold_share * rates.by_carriers);
        r.bounces = !r.rests || r.approach > std::max(hop / e, least) || -r.approach > std::max(hop, least);
        if (r.bounces) {
            r.least = r.most = 0.0;
            r.closes = r.rests = false;
        }
    }
    append_row(r);
}

// The inertia resists a change of the rate from that before the forces. In one row with the spring, whose 1 / R and
// b / R are sums of both.
void JointRows::add_armature(const JointIsland& island, const Row& row, double value, std::size_t k) {
    const Joint& j = joint(blocks_.back());
    const JointSpring limp, &s = j.axis(k).spring ? j.springs[k] : limp;
    const double unit = row.turns() ? length_ : 1.0, inertia = j.armature(k);
    const double gain = h_ * (h_ * s.stiffness + s.damping) + inertia;
    Row r = row;
    r.law = Joint::spring;
    r.soft = r.inert = true;
    r.compliance = unit * unit / gain;
    r.target =
        unit / gain *
        (h_ * s.stiffness * (s.rest - value) + inertia * limit_rates(island, row, blocks_.back().point).at_start);
    append_row(r);
}

void JointRows::add_laws(const JointIsland& island, const JointGeometry& g, std::size_t k, const Row& row) {
    const Joint& j = joint(blocks_.back());
    const JointAxis& axis = j.axis(k);
    const double value = g.coordinates[k].value, unit = row.turns() ? length_ : 1.0, h = h_;
    if (axis.motion == JointAxis::Motion::locked) {
        Row r = row;
        r.law = Joint::lock;
        r.closes = true;
        r.reference = std::abs(value) <= closed_share() * (row.turns() ? 1.0 : j.size) ? 0.0 : value;
        r.target = unit * ((r.reference - value) / h + h * j.curving[k]);
        append_row(r);
        return;
    }
    if (axis.motion == JointAxis::Motion::limited) {
        if (axis.lower > -infinity) add_limit(island, row, value, axis.lower, Joint::lower);
        if (axis.upper < infinity) add_limit(island, row, value, axis.upper, Joint::upper);
    }
    const auto add_soft = [&](Joint::Law law, double stiffness, double damping, const Target& target, double most) {
        const double gain = h * stiffness + damping;
        if (!(gain > 0.0)) return;
        Row r = row;
        r.law = law;
        r.soft = true;
        r.compliance = unit * unit / (h * gain);
        r.target = unit * (stiffness * (target.value - value) + damping * target.speed) / gain;
        r.most = most * h / unit;
        r.least = -r.most;
        append_row(r);
    };
    if (j.armature(k) > 0.0) {
        add_armature(island, row, value, k);
    } else if (axis.spring) {
        const JointSpring& s = j.springs[k];
        add_soft(Joint::spring, s.stiffness, s.damping, {s.rest, 0.0}, infinity);
    }
    if (axis.motor && axis.motor->speed) {
        Row r = row;
        r.law = Joint::motor;
        r.target = unit * *axis.motor->speed;
        r.most = axis.motor->max_force * h / unit;
        r.least = -r.most;
        append_row(r);
    } else if (axis.motor) {
        add_soft(Joint::motor, axis.motor->stiffness, axis.motor->damping, target_of(*axis.motor, from_, to_),
                 axis.motor->max_force);
    }
    if (axis.friction > 0.0 || j.description.friction_coefficient > 0.0) {
        Row r = row;
        r.law = Joint::friction;
        r.most = axis.friction * h / unit;
        r.least = -r.most;
        append_row(r);
    }
}

// Spring and friction of a ball act about all axes alike: the spring along the rotation vector, friction against the
// angular velocity, with one bound for the length of its vector.
void JointRows::add_ball_laws(const JointIsland& island, const JointGeometry& g, const Block& block) {
    const Joint& j = joint(block);
    const JointAxis& axis = j.description.turn[0];
    const auto row_about = [&](std::size_t i, Joint::Law law) {
        Row r = make_row(island, block, g.axes.col(Eigen::Index(i)), 3 + i);
        r.law = law;
        return r;
    };
    if (axis.spring) {
        const JointSpring& s = j.springs[3];
        const double gain = h_ * s.stiffness + s.damping;
        for (std::size_t i = 0; i < 3 && gain > 0.0; ++i) {
            Row r = row_about(i, Joint::spring);
            r.soft = true;
            r.compliance = length_ * length_ / (h_ * gain);
            r.target = -length_ * s.stiffness * g.rotation[Eigen::Index(i)] / gain;
            append_row(r);
        }
    }
    if (!(axis.friction > 0.0 || j.description.friction_coefficient > 0.0)) return;
    for (std::size_t i = 0; i < 3; ++i) {
        Row r = row_about(i, Joint::friction);
        r.most = axis.friction * h_ / length_;
        r.least = -r.most;
        r.starts_ball = i == 0;
        append_row(r);
    }
}

void JointRows::add_joint(const JointIsland& island, std::uint32_t index, double compliance) {
    Joint& j = (*joints_)[index];
    const JointGeometry g = measure(j, side_at(island, j.a), side_at(island, j.b));
    Block& block = blocks_.emplace_back();
    block.joint = index;
    block.a = contact_rows::place_of(island.bodies, j.a);
    block.b = contact_rows::place_of(island.bodies, j.b);
    block.point = g.point;
    block.first = rows_.size();
    block.axes = free_axes(j, g);
    compliance_ = compliance;
    for (std::size_t k = 0; k < j.count(); ++k)
        if (!j.locked(k)) j.value[k] = g.coordinates[k].value;
    const bool ball = !j.distance() && !j.locked(3) && !j.locked(4) && !j.locked(5);
    const bool isotropic = ball && j.description.type == JointType::ball;
    for (std::size_t k = 0; k < j.count(); ++k) {
        const Row row = make_row(island, block, g.coordinates[k].direction, k);
        if (isotropic && k >= 3) {
            const JointAxis& axis = j.axis(k);
            if (axis.motion != JointAxis::Motion::limited) continue;
            if (axis.lower > -infinity) add_limit(island, row, g.coordinates[k].value, axis.lower, Joint::lower);
            if (axis.upper < infinity) add_limit(island, row, g.coordinates[k].value, axis.upper, Joint::upper);
        } else {
            add_laws(island, g, k, row);
        }
    }
    if (isotropic) add_ball_laws(island, g, block);
    if (ball && j.description.swing)
        add_limit(island, make_row(island, block, g.swing.direction, 4), g.swing.value, g.swing_limit, Joint::cone);
    block.count = rows_.size() - block.first;
    follow_load(block);
}

void JointRows::linearize(const JointIsland& island, double compliance) {
    clear();
    JointSet& set = *island.problem.joints;
    joints_ = &set.joints();
    h_ = island.problem.settings.h;
    from_ = island.from;
    to_ = island.to;
    ahead_ = from_ - set.from();
    length_ = island.length;
    fastest_ = 0.0;
    for (const BodyVelocity& body : before_)
        fastest_ = std::max({fastest_, body.velocity.norm(), length_ * body.angular_velocity.norm()});
    total_mass_ = 0.0;
    for (const std::uint32_t i : island.bodies) total_mass_ += island.problem.bodies[i].mass;
    weights_changed_ = true;
    bool fixed = false;
    std::size_t gears = 0;
    for (const std::uint32_t k : island.joints) {
        gears += (*joints_)[set.active()[k]].gear();
        for (const std::uint32_t i : {(*joints_)[set.active()[k]].a, (*joints_)[set.active()[k]].b})
            fixed = fixed || i == Joint::world || !island.problem.bodies[i].dynamic();
    }
    gears_.reserve(gears);
    // A connected graph is a tree if it has one edge less than nodes; all that is fixed is one node.
    tree_ = gears > 0 ? geared_forest(island) : island.joints.size() + 1 == island.bodies.size() + fixed;
    for (const std::uint32_t k : island.joints)
        if (const std::uint32_t index = set.active()[k]; !(*joints_)[index].broken)
            (*joints_)[index].gear() ? add_gear(island, index) : add_joint(island, index, compliance);
}

void JointRows::follow_load(const Block& block) {
    const Joint& j = joint(block);
    const double coefficient = j.description.friction_coefficient;
    if (!(coefficient > 0.0)) return;
    double square = 0.0;
    for (std::size_t k = block.first; k < block.first + block.count; ++k)
        if (rows_[k].law == Joint::lock && !rows_[k].turns()) square += rows_[k].estimate * rows_[k].estimate;
    for (std::size_t k = block.first; k < block.first + block.count; ++k) {
        Row& row = rows_[k];
        if (row.law != Joint::friction) continue;
        const double lever = row.turns() ? j.description.bearing_radius / length_ : 1.0;
        row.most = j.axis(row.coordinate).friction * h_ / (row.turns() ? length_ : 1.0) +
                   coefficient * lever * std::sqrt(square);
        row.least = -row.most;
    }
}

}  // namespace tumble
