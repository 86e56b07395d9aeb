// A manifold as the contact solvers see it: arms from the bodies' centres, one place where friction acts, and what the
// pair's materials say. Built anew each step; the impulses stay with the manifold.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/manifold.h"

#include <array>
#include <cstdint>

namespace tumble {

struct ContactConstraint {
    struct Point {
        Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();   // r = p - x, world
        double separation = 0.0;    // m
        double lever = 0.0;         // m, with which it resists a spin: its distance from where friction acts, times the spread
        double impulse = 0.0;       // N s, last step's
        int source = 0;             // its place in the manifold
    };
    int count = 0;
    Vec3 normal = Vec3::Zero(), tangent_1 = Vec3::Zero(), tangent_2 = Vec3::Zero();   // tangent_2 = normal x tangent_1
    Vec3 friction_arm_a = Vec3::Zero(), friction_arm_b = Vec3::Zero();
    double friction = 0.0;          // mu
    double spread = 1.0;            // Manifold::spread
    double size = 0.0;              // m, the smaller body's radius: what tolerances are parts of
    std::array<Point, Manifold::capacity> points;
};

/// How contact ends a step.
struct ConstraintSettings {
    double h;                   // s
    double bounce_threshold;    // m/s: faster approaches with restitution are left to overlap and collide,
    double least_rebound = 0.0; // m/s: where what comes back is faster than this
};

/// Where the impulses of a point act, world: halfway between the surfaces of two bodies that both give way, so that they keep their
/// angular momentum; else on the surface of the one that does. Found a way into the floor, or before it is there, a ball still has
/// its radius for a lever, and keeps its angular momentum about the place where it lands.
inline Vec3 acting_place(const Vec3& position, double separation, const Vec3& normal, bool a_gives_way, bool b_gives_way) {
    if (a_gives_way == b_gives_way) return position;
    return position + (a_gives_way ? -0.5 : 0.5) * separation * normal;
}

/// v_rel of a manifold's point, m/s; negative: approaching.
double relative_velocity(const ContactPoint& point, const Vec3& normal, const Body& a, const Body& b);

/// Whether a point is left alone in this step because it will bounce: stopping it at the surface would take the speed it
/// must come back with. `slower` (m/s): Passing::slower.
bool will_bounce(const ContactPoint& point, const Vec3& normal, const Body& a, const Body& b, double slower, const ConstraintSettings& settings);

/// Returns a patch without points when there is nothing to hold.
ContactConstraint make_patch(const Manifold& manifold, const Body& a, const Body& b, const BodyVelocity& before_a,
                        const BodyVelocity& before_b, const ConstraintSettings& settings);

/// What a turning kinematic body carries goes round an arc, but the velocity of its point at the step's start points along the
/// tangent: by that alone riders would creep outward. Friction takes the velocity where the rider, which moves by `motion` (m/s)
/// against the carrier's centre, will be in the middle of the time; this is how it changes with that, m/s^2, across the normal.
Vec3 turn_of_carrier(const Body& carrier, const Vec3& motion, const Vec3& normal);

/// Forgets the impulses of the step before.
void release(Manifold& manifold);
/// Their sum along the normal, N s.
double normal_impulse(const Manifold& manifold);
/// Keeps a share of them.
void scale_impulses(Manifold& manifold, double share);

/// Materials of a pair: the larger restitution, the geometric mean of the frictions.
double pair_restitution(const Body& a, const Body& b);
double pair_friction(const Body& a, const Body& b);

}  // namespace tumble
