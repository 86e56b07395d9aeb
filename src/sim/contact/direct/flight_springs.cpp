// JointFlight: springs without dampers act as other forces do, half a kick at both ends of a stage.
#include "sim/contact/direct/joint_flight.h"
#include "sim/joints/flight_way.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// The force (N, N m) of each spring on B, about the point.
template <class Visit>
void each_spring(const Joint& joint, const JointSide& a, const JointSide& b, const Visit& visit) {
    if (!has_springs(joint)) return;
    const JointGeometry g = measure(joint, a, b);
    for (std::size_t k = 0; k < joint.count(); ++k) {
        if (!joint.axis(k).spring) continue;
        const JointSpring& spring = joint.springs[k];
        const auto& [direction, value] = g.coordinates[k];
        JointLoad load;
        (k >= 3 ? load.torque : load.force) = spring.stiffness * (spring.rest - value) * direction;
        visit(load, g.point);
    }
}

}  // namespace

// A ball's spring is not the gradient of a coordinate. The step must resolve the spring: explicit kicks need a phase
// below 2, and rows of the solver are stable for any stiffness.
bool JointFlight::flies_with_springs(const JointIsland& island, const Joint& joint) {
    if (!has_springs(joint)) return true;
    const std::vector<Body>& bodies = island.problem.bodies;
    const JointGeometry g = measure(joint, side_of(bodies, joint.a), side_of(bodies, joint.b));
    double most = 0.0;  // 1/s^2
    for (std::size_t k = 0; k < joint.count(); ++k) {
        if (!joint.axis(k).spring) continue;
        if (joint.springs[k].damping > 0.0 || joint.turns_alike()) return false;
        most += joint.springs[k].stiffness * compliance_along(bodies, joint, g, k);
    }
    const double h = island.problem.settings.h;
    return h * h * most <= tuning::joint_flight_spring * tuning::joint_flight_spring;
}

// Equal and opposite, about one point.
void JointFlight::kick_springs(double time) {
    std::span<FlightBody> bodies = locks_.bodies();
    for (FlightLocks::FlightJoint& j : locks_.joints()) {
        each_spring(locks_.joint(j), locks_.side(j.a), locks_.side(j.b), [&](const JointLoad& load, const Vec3& point) {
            const Vec3 force = time * load.force, torque = time * load.torque;
            // Returns the work: the impulse times the mean of the velocities before and after.
            const auto give = [&](std::uint32_t place, double sign) {
                if (!locks_.moves(place)) return 0.0;
                FlightBody& body = bodies[place];
                RigidState& b = body.state;
                const Vec3 turn = sign * ((point - b.position).cross(force) + torque);
                const Vec3 momentum = b.momentum + 0.5 * sign * force, angular = b.angular_momentum + 0.5 * turn;
                b.momentum += sign * force;
                b.angular_momentum += turn;
                return body.inertia.inverse_mass * sign * force.dot(momentum) +
                       turn.dot(body.inverse_inertia * angular);
            };
            const double on_a = give(j.a, -1.0), on_b = give(j.b, 1.0);
            j.load.add({force, torque, point.cross(force) + torque});
            j.work_a += on_a;
            j.work_b += on_b;
        });
    }
}

}  // namespace tumble
