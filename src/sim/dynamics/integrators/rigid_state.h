// Input of the higher-order integrators: the state of one body, its mass, and a law of force, independent of the rest
// of the simulation. World frame unless stated otherwise.
#pragma once

#include "core/vector.h"
#include "sim/dynamics/flight_point.h"
#include "sim/math/wrench.h"

namespace tumble {

struct Body;
struct BodyVelocity;

/// X = (x, q, P, L) (notes eq. 1 with section 3.1's quaternion).
struct RigidState {
    Vec3 position = Vec3::Zero();          // m, of the center of mass
    Quat orientation = Quat::Identity();   // body to world
    Vec3 momentum = Vec3::Zero();          // kg m/s
    Vec3 angular_momentum = Vec3::Zero();  // kg m^2/s, about the center of mass
    double elapsed = 0.0;                  // s, since the start of the span
};

/// Inertia of a body.
struct RigidMass {
    double inverse_mass = 0.0;               // 1/kg
    Mat3 inverse_inertia = Mat3::Zero();     // 1/(kg m^2), body frame
    Vec3 principal_inertia = Vec3::Ones();   // kg m^2
    Quat principal_axes = Quat::Identity();  // rotates principal coordinates into body coordinates
};

RigidState state_of(const Body& body);
RigidMass mass_of(const Body& body);
/// Also updates the quantities derived from the state.
void set_state(Body& body, const RigidState& state);
/// Constant velocities that move the body from its pose to that of the state in h seconds.
BodyVelocity mean_velocity(const Body& start, const RigidState& end, double h);

/// The rotation matrix of a quaternion of any length: the stages of a step leave the unit sphere a little.
Mat3 rotation_of(const Quat& q);

/// Force and torque on a body: Wrench(FlightPoint), or Wrench(position, velocity, rotation), of any callable, which
/// must outlive it. A span of time over which forces begin or end is stepped in parts.
class ForceLaw {
public:
    template <class Callable>
    explicit ForceLaw(const Callable& law)
        : law_(&law), call_([](const void* object, const FlightPoint& at) -> Wrench {
              const Callable& called = *static_cast<const Callable*>(object);
              if constexpr (requires { called(at); })
                  return called(at);
              else
                  return called(at.position, at.velocity, at.rotation);
          }) {}

    Wrench operator()(const FlightPoint& at) const { return call_(law_, at); }

private:
    const void* law_;
    Wrench (*call_)(const void*, const FlightPoint&);
};

// The state as a point of R^14 and its rate of change: the interface of general methods for dy/dt = f(y).

using StateVector = Eigen::Matrix<double, 14, 1>;  // x, q (x, y, z, w), P, L, time

StateVector vector_of(const RigidState& state);
/// The state with its quaternion normalized.
RigidState state_of(const StateVector& y);

/// dx/dt = P/M, dq/dt = omega q / 2, dP/dt = F, dL/dt = tau, dt/dt = 1 (notes eq. 7 and section 3.1), omega = R I^-1
/// R^T L.
StateVector rate_of_change(const StateVector& y, const RigidMass& mass, const ForceLaw& forces);

}  // namespace tumble
