// JointFlight: springs without dampers act as other forces do, half a kick at both ends of a stage.
#include "sim/contact/direct/joint_flight.h"
#include "sim/joints/flight_way.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// A spring at one pose: its force along a coordinate.
struct SpringForce {
    JointLoad load;          // N, N m, on B, about the point
    double stiffness = 0.0;  // N/m, N m/rad
    Vec3 direction = Vec3::Zero();
    bool turns = false;
};

template <class Visit>
void each_spring(const Joint& joint, const JointSide& a, const JointSide& b, const Visit& visit) {
    if (!has_springs(joint)) return;
    const JointGeometry g = measure(joint, a, b);
    for (std::size_t k = 0; k < joint.count(); ++k) {
        if (!joint.axis(k).spring) continue;
        const JointSpring& spring = joint.springs[k];
        const auto& [direction, value] = g.coordinates[k];
        SpringForce one;
        one.stiffness = spring.stiffness;
        one.direction = direction;
        one.turns = k >= 3;
        (one.turns ? one.load.torque : one.load.force) = spring.stiffness * (spring.rest - value) * direction;
        visit(one, g.point);
    }
}

}  // namespace

// A ball's spring is not the gradient of a coordinate. The step must resolve the spring: explicit kicks need a phase
// below 2, and rows of the solver are stable for any stiffness.
bool JointFlight::flies_with_springs(const JointIsland& island, const Joint& joint) {
    if (!joint.soft) return true;
    for (std::size_t k = 0; k < joint.count(); ++k)
        if (joint.axis(k).spring && (joint.springs[k].damping > 0.0 || joint.turns_alike())) return false;
    double most = 0.0;  // 1/s^2
    const std::vector<Body>& bodies = island.problem.bodies;
    each_spring(
        joint, side_of(bodies, joint.a), side_of(bodies, joint.b), [&](const SpringForce& spring, const Vec3& point) {
            double gives = 0.0;
            for (const std::uint32_t i : {joint.a, joint.b}) {
                if (i == Joint::world || !bodies[i].dynamic()) continue;
                const Body& b = bodies[i];
                const Vec3 turn = spring.turns ? spring.direction : Vec3((point - b.position).cross(spring.direction));
                gives += (spring.turns ? 0.0 : b.inverse_mass) + turn.dot(b.inverse_inertia * turn);
            }
            most += spring.stiffness * gives;
        });
    const double h = island.problem.settings.h;
    return h * h * most <= tuning::joint_flight_spring * tuning::joint_flight_spring;
}

// Equal and opposite, about one point.
void JointFlight::kick_springs(double time) {
    std::span<FlightBody> bodies = locks_.bodies();
    for (FlightLocks::FlightJoint& j : locks_.joints()) {
        each_spring(
            locks_.joint(j), locks_.side(j.a), locks_.side(j.b), [&](const SpringForce& spring, const Vec3& point) {
                const Vec3 force = time * spring.load.force, torque = time * spring.load.torque;
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
