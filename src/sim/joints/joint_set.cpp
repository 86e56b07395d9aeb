#include "sim/joints/joint_set.h"

#include "core/deterministic_math.h"
#include "core/fetch_ahead.h"
#include "sim/joints/gear.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

bool has_laws(const JointAxis& axis) {
    return axis.motion == JointAxis::Motion::limited || axis.spring || axis.motor || axis.friction > 0.0;
}

// -1 at a lower limit, 1 at an upper one or a cone, of the first coordinate that is at one.
int limit_met(const Joint& joint, const JointGeometry& g) {
    for (std::size_t k = 0; k < joint.count(); ++k) {
        const JointAxis& axis = joint.axis(k);
        if (axis.motion != JointAxis::Motion::limited) continue;
        const double value = g.coordinates[k].value, near = tuning::joint_rounding * (k < 3 ? joint.size : 1.0);
        if (value <= axis.lower + near || joint.impulse[k][Joint::lower] != 0.0) return -1;
        if (value >= axis.upper - near || joint.impulse[k][Joint::upper] != 0.0) return 1;
    }
    return joint.description.swing && g.swing.value >= g.swing_limit - tuning::joint_rounding ? 1 : 0;
}

}  // namespace

double compliance_along(const std::vector<Body>& bodies, const Joint& joint, const JointGeometry& g, std::size_t k) {
    const Vec3 n = g.coordinates[k].direction;
    double gives = 0.0;
    for (const std::uint32_t i : {joint.a, joint.b}) {
        if (i == Joint::world || !bodies[i].dynamic()) continue;
        const Body& body = bodies[i];
        const Vec3 turn = k < 3 ? Vec3((g.point - body.position).cross(n)) : n;
        gives += (k < 3 ? body.inverse_mass : 0.0) + turn.dot(body.inverse_inertia * turn);
    }
    const double armature = joint.armature(k);
    return armature > 0.0 ? gives / (1.0 + armature * gives) : gives;
}

double rotor_speed(const Joint& joint, const std::vector<Body>& bodies, RotorTime time) {
    const JointGeometry g = measure(joint, side_of(bodies, joint.a), side_of(bodies, joint.b));
    const bool turns = joint.description.type != JointType::slider;
    const Vec3& n = g.coordinates[turns ? 3 : 0].direction;
    const auto speed = [&](std::uint32_t i) {
        if (i == Joint::world) return 0.0;
        const Body& body = bodies[i];
        const bool of_momenta = time == RotorTime::before_impact && body.dynamic();
        const Vec3 spin = of_momenta ? Vec3(body.inverse_inertia * body.angular_momentum) : body.angular_velocity;
        if (turns) return n.dot(spin);
        const Vec3 velocity = of_momenta ? Vec3(body.inverse_mass * body.momentum) : body.velocity;
        return n.dot(velocity + spin.cross(g.point - body.position));
    };
    return speed(joint.b) - speed(joint.a);
}

JointSide side_of(const std::vector<Body>& bodies, std::uint32_t body) {
    if (body == Joint::world) return {};
    return {bodies[body].position, bodies[body].orientation};
}

JointSet::JointSet(const SceneDescription& scene, const std::vector<Body>& bodies,
                   std::span<const std::uint32_t> scene_index, const Vec3& origin) {
    if (scene.joints.empty()) return;
    std::vector<std::uint32_t> place(scene_index.size());
    for (std::uint32_t i = 0; i < scene_index.size(); ++i) place[scene_index[i]] = i;
    const auto side = [&](const std::optional<std::size_t>& body, const Vec3& anchor, std::uint32_t& index,
                          Vec3& from_center) {
        if (!body) {
            from_center = anchor - origin;
            return;
        }
        index = place[*body];
        from_center = anchor - bodies[index].center_of_mass;
    };
    for (const JointDescription& description : scene.joints) {
        Joint& joint = joints_.emplace_back();
        joint.describe(description);
        if (joint.gear()) continue;
        side(description.first, description.anchor_first, joint.a, joint.anchor_a);
        side(description.second, description.anchor_second, joint.b, joint.anchor_b);
        joint.frame_a = description.frame_first;
        joint.frame_b = description.frame_second;
        joint.size = infinity;
        for (const std::uint32_t i : {joint.a, joint.b})
            if (i != Joint::world && bodies[i].dynamic()) joint.size = std::min(joint.size, bodies[i].radius);
        const JointGeometry g = measure(joint, side_of(bodies, joint.a), side_of(bodies, joint.b));
        joint.soft = description.armature || description.swing || description.friction_coefficient > 0.0;
        joint.steady = description.start <= 0.0 && description.end == infinity && !description.ever_breaks();
        for (std::size_t k = 0; k < joint.count(); ++k) {
            joint.value[k] = joint.locked(k) ? 0.0 : g.coordinates[k].value;
            const JointAxis& axis = joint.axis(k);
            joint.soft = joint.soft || has_laws(axis);
            joint.steady = joint.steady && !axis.motor;
            if (!axis.spring) continue;
            JointSpring& spring = joint.springs[k] = *axis.spring;
            if (!(spring.frequency > 0.0)) continue;
            // K = m w^2 and C = 2 zeta m w, with the mass at the start: otherwise the spring would change with the
            // pose.
            const double gives = compliance_along(bodies, joint, g, k), mass = gives > 0.0 ? 1.0 / gives : 0.0;
            const double rate = 2.0 * pi * spring.frequency;
            spring.stiffness = mass * rate * rate;
            spring.damping = 2.0 * spring.damping_ratio * mass * rate;
        }
    }
    for (Joint& joint : joints_) {
        joint.active = joint.description.start <= 0.0 && joint.description.end > 0.0;
        if (joint.gear()) build_gear(joint, joints_, bodies);
    }
    for (Joint& joint : joints_)
        if (joint.gear()) joint.active = joint.active && gear_holds(joint, joints_);
    start_account(bodies);
    list();
}

void JointSet::list() {
    active_.clear();
    pairs_.clear();
    ++changes_;
    for (std::uint32_t k = 0; k < joints_.size(); ++k) {
        if (!joints_[k].active) continue;
        active_.push_back(k);
        pairs_.push_back({joints_[k].a, joints_[k].b});
    }
}

bool JointSet::driven(const Joint& joint, double from, double to) {
    for (std::size_t k = 0; k < joint.count(); ++k) {
        const auto& motor = joint.axis(k).motor;
        if (!motor || motor->targets.size() < 2) continue;
        if (from < motor->targets.back().time && to > motor->targets.front().time) return true;
    }
    return false;
}

void JointSet::begin_step(double from, double to, const std::vector<Body>& bodies, std::vector<std::uint32_t>& woken) {
    if (joints_.empty()) return;
    from_ = from;
    to_ = to;
    bool changed = false;
    const auto begin = [&](Joint& joint) {
        bool active = true, wakes = false;
        if (!joint.steady) {
            active = !joint.broken && from >= joint.description.start && from < joint.description.end;
            if (joint.gear()) active = active && gear_holds(joint, joints_);
            wakes = active != joint.active || (active && driven(joint, from, to));
        }
        for (const std::uint32_t i : {joint.a, joint.b})
            if (active && i != Joint::world && !bodies[i].dynamic())
                wakes = wakes || !bodies[i].velocity.isZero(0.0) || !bodies[i].angular_velocity.isZero(0.0);
        if (active && joint.a != Joint::world && joint.b != Joint::world)
            wakes = wakes || (bodies[joint.a].dynamic() && bodies[joint.b].dynamic() &&
                              bodies[joint.a].asleep != bodies[joint.b].asleep);
        if (active != joint.active) {
            changed = true;
            joint.active = active;
            if (active && joint.gear()) engage_gear(joint, joints_, bodies);
            joint.account.holds = false;
            const double given = stored(joint, bodies);  // a joint that ends leaves its own as heat
            joint.account.work.stored += given;
            joint.account.work.motors += given;
            joint.impulse = {};
            joint.force.setZero();
            joint.torque.setZero();
        }
        if (!wakes) return;
        for (const std::uint32_t i : {joint.a, joint.b})
            if (i != Joint::world && bodies[i].asleep) woken.push_back(i);
    };
    bool gears = false;  // a gear holds while its joints hold
    for (std::size_t k = 0; k < joints_.size(); ++k) {
        if (k + elements_ahead < joints_.size()) {
            const Joint& later = joints_[k + elements_ahead];
            fetch_ahead(&later.a, &later.b + 1);
            fetch_ahead(&later.steady, &later.value);
        }
        Joint& joint = joints_[k];
        if (joint.gear())
            gears = true;
        else
            begin(joint);
    }
    for (Joint& joint : joints_)
        if (gears && joint.gear()) begin(joint);
    if (changed) list();
}

void JointSet::exchange(std::vector<Body>& bodies) {
    if (empty()) return;
    list();
    mark(bodies);
}

void JointSet::mark(std::vector<Body>& bodies) const {
    for (Body& body : bodies) body.jointed = false;
    for (const BodyPair& pair : pairs_)
        for (const std::uint32_t i : {pair.a, pair.b})
            if (i != Joint::world) bodies[i].jointed = true;
}

std::vector<BodyPair> JointSet::apart() const {
    std::vector<BodyPair> pairs;
    for (const std::uint32_t k : active_) {
        const Joint& joint = joints_[k];
        if (joint.description.collide || joint.a == Joint::world || joint.b == Joint::world || joint.a == joint.b)
            continue;
        pairs.push_back({std::min(joint.a, joint.b), std::max(joint.a, joint.b)});
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

std::vector<JointState> JointSet::states(const std::vector<Body>& bodies) const {
    std::vector<JointState> result;
    for (const Joint& joint : joints_) {
        JointState& state = result.emplace_back();
        const Joint& placed = joint.gear() ? joints_[joint.description.geared[0]] : joint;
        const JointGeometry g = measure(placed, side_of(bodies, placed.a), side_of(bodies, placed.b));
        if (joint.gear() && joint.active) state.gap = gear_gap(joint, joints_, bodies);
        state.point = g.point;
        const auto velocity = [&](std::uint32_t i, bool turns) -> Vec3 {
            if (i == Joint::world) return Vec3::Zero();
            return turns ? bodies[i].angular_velocity : bodies[i].point_velocity(g.point - bodies[i].position);
        };
        for (std::size_t k = 0; k < joint.count(); ++k) {
            const auto& [direction, value] = g.coordinates[k];
            const double unit = k < 3 ? 1.0 : joint.size;
            if (joint.locked(k)) {
                state.gap = std::max(state.gap, unit * std::abs(value));
                continue;
            }
            state.free[k] = true;
            state.position[k] = value;
            state.speed[k] = direction.dot(velocity(joint.b, k >= 3) - velocity(joint.a, k >= 3));
        }
        state.force = joint.force;
        state.torque = joint.torque;
        state.mean_force = joint.account.mean.force;
        state.mean_torque = joint.account.mean.torque;
        state.mean_moment = joint.account.mean.moment;
        state.limit = limit_met(joint, g);
        state.active = joint.active && !joint.broken;
        if (joint.broken) state.broken_at = joint.broken_at;
    }
    return result;
}

}  // namespace tumble
