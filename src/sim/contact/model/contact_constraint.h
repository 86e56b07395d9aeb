// A manifold as the contact solvers see it: arms from the bodies' centers, one friction point, and the material values
// of the pair. Built anew each step; the impulses stay with the manifold.
#pragma once

#include "sim/contact/model/predicted_gap.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct ContactConstraint {
    struct Point {
        Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  // r = p - x, world
        double separation = 0.0;                          // m
        double lever = 0.0;    // m, lever against a spin: distance from the friction point, times the spread
        double impulse = 0.0;  // N s, of the last step
        int source = 0;        // index of the point in the manifold
    };
    int count = 0;
    Vec3 normal = Vec3::Zero(), tangent_1 = Vec3::Zero(), tangent_2 = Vec3::Zero();  // tangent_2 = normal x tangent_1
    Vec3 friction_arm_a = Vec3::Zero(), friction_arm_b = Vec3::Zero();
    double friction = 0.0;  // mu
    double spread = 1.0;    // Manifold::spread
    double size = 0.0;      // m, the smaller body's radius: tolerances are fractions of it
    std::array<Point, Manifold::capacity> points;
};

struct FreeMotion;

/// Settings of the step for contact constraints.
struct ConstraintSettings {
    double h;                    // s
    double bounce_threshold;     // m/s: with restitution, points that approach faster may overlap and collide,
    double least_rebound = 0.0;  // m/s: if their rebound is faster than this
    /// Both speeds of a contact under load are at least these shares of its load speed. Null: of no load.
    const FreeMotion* free = nullptr;
    double threshold_share = 0.0, rebound_share = 0.0;
    bool meets = false;  // time-stepping: a curved gap that turns toward contact may close into an overlap

    /// True if a point that approaches at this speed (m/s) bounces.
    bool bounces(double approach, const Manifold& manifold, int point, const Body& a, const Body& b) const;
};

/// The impulse that a solver has given to a manifold's bodies.
struct ManifoldImpulse {
    Vec3 on_b = Vec3::Zero();                           // N s; the opposite on A
    Vec3 turn_a = Vec3::Zero(), turn_b = Vec3::Zero();  // N m s on each body, about its center of mass

    /// `moment` (N m s) on B, about A's center.
    void add(const Vec3& force, const Vec3& moment, const Body& a, const Body& b) {
        on_b += force;
        turn_a -= moment;
        turn_b += moment + (a.position - b.position).cross(force);
    }
};

/// Input and output of both contact solvers. Bodies have the velocities after the step's forces, kinematic ones the
/// mean of the step; the velocities of the step's start are beside them. A solver changes the momenta, derives the
/// velocities, and sets the push velocities such that h (velocity + push), with the gyroscopic correction, is the
/// body's displacement in the step. Bodies that no impulse has reached stay unchanged.
class ContactAreas;
struct IslandWay;
class JointSet;

struct ContactProblem {
    std::vector<Body>& bodies;
    std::vector<Manifold>& manifolds;
    const std::vector<BodyVelocity>& before;  // by body
    ConstraintSettings settings;
    std::vector<ManifoldImpulse>* totals = nullptr;  // by manifold, set by the solvers; null: not asked for
    JointSet* joints = nullptr;                      // null: a scene without joints
    std::span<const IslandWay> ways = {};            // by island with joints; empty: all are solved directly
    const ContactAreas* areas = nullptr;             // of several manifolds; set by ContactSolver, null: none
};

/// Point (world) where the impulses of a contact act. Between two bodies that impulses move: halfway between the
/// surfaces, so that they keep their angular momentum. Otherwise: on the surface of the body that impulses move. So a
/// ball found somewhat inside or above the floor still has its radius as lever, and keeps its angular momentum about
/// the position where it lands.
inline Vec3 acting_point(const Vec3& position, double separation, const Vec3& normal, bool a_movable, bool b_movable) {
    if (a_movable == b_movable) return position;
    return position + (a_movable ? -0.5 : 0.5) * separation * normal;
}

/// v_rel of a manifold's point, m/s; negative: approaching.
double relative_velocity(const ContactPoint& point, const Vec3& normal, const Body& a, const Body& b);

/// True if this step skips a point because it will bounce, or meet the other body at another normal: stopping it at the
/// surface would take its rebound's speed, or push it along the present normal. `slower` (m/s): PredictedGap::slower.
bool will_bounce(const Manifold& manifold, int point, const Body& a, const Body& b, double slower,
                 const ConstraintSettings& settings);

/// Returns a constraint without points when none has to be held.
ContactConstraint make_constraint(const Manifold& manifold, const BodiesInStep& bodies,
                                  const ConstraintSettings& settings);

/// A point on a turning kinematic body moves on an arc, but its velocity at the start of the step points along the
/// tangent: with that alone, carried bodies would creep outward. Friction uses the velocity at the carried body's
/// position in the middle of the step; that body moves by `motion` (m/s) relative to the carrier's center. Returns the
/// change of this velocity, m/s^2, across the normal.
Vec3 turn_of_carrier(const Body& carrier, const Vec3& motion, const Vec3& normal);

/// Sets the impulses of the last step to zero.
void release(Manifold& manifold);
/// Sum of the impulses along the normal, N s.
double normal_impulse(const Manifold& manifold);
/// Multiplies the impulses by `share`.
void scale_impulses(Manifold& manifold, double share);

/// Restitution and friction of a pair of bodies, by the rules of the scene.
double pair_restitution(const Body& a, const Body& b);
double pair_friction(const Body& a, const Body& b);

}  // namespace tumble
