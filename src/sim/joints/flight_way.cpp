#include "sim/joints/flight_way.h"

#include <algorithm>

namespace tumble {

namespace {

bool motors_fly(const Joint& joint) {
    for (std::size_t c = 0; joint.soft && c < joint.count(); ++c) {
        const JointAxis& axis = joint.axis(c);
        if (!axis.motor) continue;
        const bool steady = axis.motor->speed ? axis.motor->max_force < infinity && axis.friction == 0.0
                                              : axis.motor->targets.size() == 1;
        if (!steady) return false;
    }
    return true;
}

}  // namespace

bool on_moving_carrier(const Joint& joint, const std::vector<Body>& bodies) {
    for (const std::uint32_t i : {joint.a, joint.b})
        if (i != Joint::world && !bodies[i].dynamic() && bodies[i].moves()) return true;
    return false;
}

bool has_friction(const Joint& joint) {
    for (std::size_t c = 0; joint.soft && c < joint.count(); ++c)
        if (joint.axis(c).friction > 0.0) return true;
    return false;
}

bool has_springs(const Joint& joint) {
    for (std::size_t c = 0; joint.soft && c < joint.count(); ++c)
        if (joint.axis(c).spring) return true;
    return false;
}

bool has_motors(const Joint& joint) {
    for (std::size_t c = 0; joint.soft && c < joint.count(); ++c)
        if (joint.axis(c).motor) return true;
    return false;
}

bool acts_along_coordinates(const Joint& joint) {
    if (!has_springs(joint) && !has_friction(joint) && !has_motors(joint)) return true;
    int turns = 0;
    for (std::size_t c = 3; c < joint.count(); ++c) turns += !joint.locked(c);
    return turns < 3;
}

bool tree_laws(std::span<const Joint* const> joints, const std::vector<Body>& bodies) {
    int anchors = 0, carried = 0;
    for (const Joint* joint : joints) {
        for (const std::uint32_t i : {joint->a, joint->b}) {
            anchors += i == Joint::world || !bodies[i].dynamic();
            if (i != Joint::world && bodies[i].dynamic() && bodies[i].integrator == IntegratorKind::explicit_euler)
                return false;
        }
        if (joint->distance() && (has_motors(*joint) || has_friction(*joint))) return false;
        if (on_moving_carrier(*joint, bodies)) {
            ++carried;
            if (joint->distance()) return false;
        }
        if (joint->broken || (joint->soft && joint->description.friction_coefficient > 0.0) ||
            !acts_along_coordinates(*joint) || !motors_fly(*joint))
            return false;
    }
    return carried == 0 || anchors == 1;
}

IntegratorKind joined_integrator(const std::vector<Body>& bodies, std::span<const std::uint32_t> joined) {
    bool exact = false, splitting = false, runge_kutta = false;
    for (const std::uint32_t i : joined) {
        exact = exact || bodies[i].integrator == IntegratorKind::exact;
        splitting = splitting || bodies[i].integrator == IntegratorKind::splitting;
        runge_kutta = runge_kutta || bodies[i].integrator == IntegratorKind::runge_kutta_4;
    }
    if (exact) return IntegratorKind::exact;
    if (splitting) return IntegratorKind::splitting;
    return runge_kutta ? IntegratorKind::runge_kutta_4 : IntegratorKind::symplectic_euler;
}

}  // namespace tumble
