#include "sim/joints/flight_way.h"

namespace tumble {

bool only_locks(const Joint& joint, const std::vector<Body>& bodies) {
    if (joint.gear()) return false;
    for (std::size_t c = 0; c < joint.count(); ++c) {
        const JointAxis& axis = joint.axis(c);
        if (axis.spring || axis.motor || axis.friction > 0.0) return false;
    }
    if (joint.description.friction_coefficient > 0.0) return false;
    for (const std::uint32_t i : {joint.a, joint.b})
        if (i != Joint::world && !bodies[i].dynamic() && bodies[i].moves()) return false;
    return true;
}

std::optional<IntegratorKind> tree_method(const std::vector<Body>& bodies, std::span<const std::uint32_t> joined) {
    bool exact = false, splitting = false, runge_kutta = false;
    for (const std::uint32_t i : joined) {
        exact = exact || bodies[i].integrator == IntegratorKind::exact;
        splitting = splitting || bodies[i].integrator == IntegratorKind::splitting;
        runge_kutta = runge_kutta || bodies[i].integrator == IntegratorKind::runge_kutta_4;
    }
    if (exact) return IntegratorKind::exact;
    if (runge_kutta && !splitting) return IntegratorKind::runge_kutta_4;
    return std::nullopt;
}

}  // namespace tumble
