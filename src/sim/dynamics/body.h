// A rigid body in motion (notes section 1): its properties, its state X = (x, R or q, P, L), and quantities derived
// from the state.
// World frame unless stated otherwise; the body frame has its origin at the center of mass.
#pragma once

#include "core/vector.h"
#include "scene/description/description.h"
#include "sim/geometry/shapes/shape.h"
#include "sim/math/keyframe_track.h"

#include <cstdint>
#include <memory>
#include <string>

namespace tumble {

/// Has a cache line of its own: threads write neighboring elements at the same time.
struct alignas(64) BodyVelocity {
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();  // m/s, rad/s
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [velocity, angular_velocity] = self;
        archive.keep(velocity, angular_velocity);
    }
};

struct Body {
    // Properties: seldom written, and in other cache lines than the state, so that all threads can keep a copy.
    // Properties read in each step come first, in one line.
    alignas(64) BodyType type = BodyType::dynamic;
    IntegratorKind integrator = IntegratorKind::symplectic_euler;
    bool spherical_top = false;  // equal moments, as of a ball or a cube: the tensor is the same in every frame
    bool asleep = false;
    bool flying = false;     // ballistic, impacts = "exact": on a trajectory in closed form, not stepped
    bool jointed = false;    // has a joint that holds: it moves with the bodies joined to it
    PairRules pair_rules;    // of the scene, at hand where two bodies meet
    bool placed = false;     // moves to a known end in this step (PlacedBodies)
    bool flew = false;       // moved in the last step by an integrator of higher order than the two Euler methods
    bool absent = false;     // a piece that has not broken off, or a body in pieces: it has no effect (BreakableBody)
    bool breakable = false;  // has bonds that may break
    double mass = 0.0, inverse_mass = 0.0;  // kg, 1/kg; the inverse is 0 for fixed and kinematic bodies (after eq. 20)
    double radius = 0.0;                    // m, about the center of mass; infinity for a half-space
    double restitution = 0.0, friction = 0.0;  // or value_of_other
    double drag_area = 0.0;                    // m^2, mean projected area
    CollisionShape collider;
    std::shared_ptr<const KeyframeTrack> track;                             // of a moving kinematic body
    Mat3 inertia_body = Mat3::Zero(), inverse_inertia_body = Mat3::Zero();  // kg m^2, body frame
    Vec3 principal_inertia = Vec3::Zero();                                  // kg m^2
    Quat principal_axes = Quat::Identity();  // rotates principal coordinates into body coordinates
    Vec3 center_of_mass = Vec3::Zero();      // m, relative to the scene's body origin, body frame
    double gravity_scale = 1.0;
    double rolling_friction = 0.0, spinning_friction = 0.0;  // 1, m; or value_of_other
    std::uint64_t layers = 1, collides_with = 1;             // bits of layers (LayerFilters)
    std::string name;

    // State (notes eq. 1). Both forms of the rotation are kept; the world's settings select the one that is integrated,
    // and the other follows from it.
    alignas(64) Vec3 position = Vec3::Zero();  // x, of the center of mass
    Quat orientation = Quat::Identity();       // q
    Mat3 rotation = Mat3::Identity();          // R
    Vec3 momentum = Vec3::Zero();              // P, kg m/s
    Vec3 angular_momentum = Vec3::Zero();      // L, kg m^2/s

    // Derived (notes eqs. 2 to 4).
    Vec3 velocity = Vec3::Zero();          // m/s
    Vec3 angular_velocity = Vec3::Zero();  // rad/s
    Mat3 inverse_inertia = Mat3::Zero();   // world frame
    Vec3 gyration = Vec3::Zero();  // rad/s, gyroscopic correction of this step (gyroscopic_correction.h), for contacts
    // Position correction of this step: moves the pose and leaves the momenta alone.
    Vec3 correction_velocity = Vec3::Zero();
    Vec3 correction_angular_velocity = Vec3::Zero();

    bool dynamic() const { return type == BodyType::dynamic; }
    bool moves() const { return dynamic() || track != nullptr; }
    bool rolls() const { return placed && !jointed; }  // to the known end of this step, by its contact alone
    Pose pose() const { return {position, rotation}; }
    Vec3 origin() const { return position - rotation * center_of_mass; }
    /// m/s^2, of the body in free fall.
    Vec3 fall(const Vec3& gravity) const { return gravity_scale * gravity; }

    /// Velocity of the body's point at r = p - x (notes section 4).
    Vec3 point_velocity(const Vec3& r) const { return velocity + angular_velocity.cross(r); }
    /// P.v / 2 + L.omega / 2, J. Precondition: a dynamic body.
    double kinetic_energy() const { return 0.5 * (momentum.dot(velocity) + angular_momentum.dot(angular_velocity)); }

    /// Eqs. 2 to 4: velocities and the world inertia from the state. Precondition: a dynamic body.
    void derive();
    /// The same after a change of the momenta alone.
    void derive_velocities();
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [type, integrator, spherical_top, asleep, flying, jointed, pair_rules, placed, flew, absent, breakable,
               mass, inverse_mass, radius, restitution, friction, drag_area, collider, track, inertia_body,
               inverse_inertia_body, principal_inertia, principal_axes, center_of_mass, gravity_scale, rolling_friction,
               spinning_friction, layers, collides_with, name, position, orientation, rotation, momentum,
               angular_momentum, velocity, angular_velocity, inverse_inertia, gyration, correction_velocity,
               correction_angular_velocity] = self;
        archive.rebuilt(absent, breakable, type, integrator, spherical_top, pair_rules, mass, inverse_mass, radius,
                        restitution, friction, drag_area, collider, track, inertia_body, inverse_inertia_body,
                        principal_inertia, principal_axes, center_of_mass, gravity_scale, rolling_friction,
                        spinning_friction, layers, collides_with, name);
        archive.scratch(placed);
        archive.keep(asleep, flying, jointed, flew, position, orientation, rotation, momentum, angular_momentum,
                     velocity, angular_velocity, inverse_inertia, gyration, correction_velocity,
                     correction_angular_velocity);
    }
};

/// v = P / M, I^-1(t) = R I^-1 R^T, omega = I^-1(t) L.
inline void Body::derive() {
    if (spherical_top)
        inverse_inertia = inverse_inertia_body;
    else
        inverse_inertia = rotation * inverse_inertia_body * rotation.transpose();
    derive_velocities();
}

inline void Body::derive_velocities() {
    velocity = momentum * inverse_mass;
    angular_velocity = inverse_inertia * angular_momentum;
}

}  // namespace tumble
