// One point of contact as the impulses see it (notes section 4).
//
// The notes' convention: the normal n points away from A's surface, so towards B. Their eq. 8,
// v_rel = n . (p_a' - p_b') with v_rel < 0 for a collision, asks for the opposite normal; with n away from A the relative
// velocity that is negative for approaching bodies is v_rel = n . (p_b' - p_a'), and the impulse +j n acts on B,
// -j n on A. That is what is used here; j itself is eq. 20 unchanged (impact_laws.h, where several contacts act at once).
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/manifold.h"

#include <cstdint>
#include <vector>

namespace tumble {

struct Contact {
    std::uint32_t a = 0, b = 0, part = 0;   // bodies, and the triangle of a surface
    std::uint64_t feature = 0;
    Vec3 normal;                            // away from A
    Vec3 arm_a, arm_b;                      // r = p - x, world
    Vec3 rub = Vec3::Zero();                // m, world: from there to where its friction acts (contact_area.h)
    Corners corners = Corners::neither;     // the normal turns with the other body's face
    Vec3 edge_a = Vec3::Zero(), edge_b = Vec3::Zero();   // where edges cross: their directions, world; else zero
    OnBall on_ball = OnBall::no;
    Vec3 place_a = Vec3::Zero(), place_b = Vec3::Zero();   // on a ball: the places of its curve, or its center, from the bodies' centers
    Vec3 straight = Vec3::Zero();           // and the curve's line (Curve)
    double separation = 0.0;                // m; negative: overlap
    double touch_distance = 0.0;            // m: nearer than this is touching
    double restitution = 0.0, friction = 0.0;   // of the pair

    double impact = 0.0;                    // N s, the impulse of this step's collision
    Vec3 impact_friction = Vec3::Zero();    // N s on B, across the normal: the collision's own friction, if asked for
    double bounce_velocity = 0.0;           // m/s, v_rel after the collision: gravity's step must not eat it

    bool touching() const { return separation <= touch_distance; }
};

/// v_rel of the contact's points for the bodies' present velocities; negative: approaching.
double relative_velocity(const Contact& c, const Body& a, const Body& b);

/// The impulse's share of the momenta, P and L (eqs. 9 and 10); the velocities are left for derive().
void add_impulse(const Contact& c, const Vec3& impulse, Body& a, Body& b);
/// The same of the collision's impulses, that of friction included.
void add_impact(const Contact& c, Body& a, Body& b);

/// Contacts of the manifolds in their order. Those of one manifold only are added to what is there already.
void make_contacts(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies, std::vector<Contact>& contacts);
void add_contacts(const Manifold& manifold, const std::vector<Body>& bodies, std::vector<Contact>& contacts);

}  // namespace tumble
