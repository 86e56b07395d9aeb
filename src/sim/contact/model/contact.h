// One contact point as impulses see it (notes section 4).
//
// The notes' convention: the normal n points away from A's surface, so towards B. Their eq. 8,
// v_rel = n . (p_a' - p_b') with v_rel < 0 for a collision, asks for the opposite normal; with n away from A the
// relative velocity that is negative for approaching bodies is v_rel = n . (p_b' - p_a'), and the impulse +j n acts on
// B, -j n on A. This code uses the latter; j itself is eq. 20 unchanged (impact_laws.h, where several contacts act at
// once).
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/manifold.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// Heaps make one for each point of colliding islands in each step, and wait for memory: a member that few readers need
/// has a list of its own (Gap in free_motion.h).
struct Contact {
    std::uint32_t a = 0, b = 0, part = 0;    // body indices, and the triangle index of a mesh
    std::int16_t points = 1;                 // of its manifold
    Corners corners = Corners::neither;      // the normal rotates with the other body's face
    GeometryKind kind = GeometryKind::none;  // of its manifold
    std::uint64_t feature = 0;
    Vec3 normal;                  // away from A
    Vec3 arm_a, arm_b;            // r = p - x, world
    Vec3 rub = Vec3::Zero();      // m, world: from the contact to the point where its friction acts (contact_area.h)
    double separation = 0.0;      // m; negative: overlap
    double touch_distance = 0.0;  // m, contact tolerance
    double restitution = 0.0, friction = 0.0;  // of the pair of materials
    double load_speed = 0.0;                   // m/s: load_speed() of free_motion.h, where asked for

    double impact = 0.0;  // N s, impulse of this step's impact
    Vec3 impact_friction =
        Vec3::Zero();              // N s on B, across the normal: friction impulse of the impact itself, if computed
    double bounce_velocity = 0.0;  // m/s, v_rel after the impact: the integration of gravity must not consume it

    bool touching() const { return separation <= touch_distance; }
};

/// v_rel of the contact's points for the bodies' present velocities; negative: approaching.
double relative_velocity(const Contact& c, const Body& a, const Body& b);

/// Adds the impulse to the momenta, P and L (eqs. 9 and 10); derive() updates the velocities.
void add_impulse(const Contact& c, const Vec3& impulse, Body& a, Body& b);
/// The same for the impulses of the impact, friction included.
void add_impact(const Contact& c, Body& a, Body& b);

/// Contacts of the manifolds in their order. Contacts of a single manifold are appended to the existing ones.
void make_contacts(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies,
                   std::vector<Contact>& contacts);
void add_contacts(const Manifold& manifold, const std::vector<Body>& bodies, std::vector<Contact>& contacts);

}  // namespace tumble
