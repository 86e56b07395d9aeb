// End of bouncing. A contact whose next hop would be below the Zeno limit holds from then on: its body switches to
// contact and to the contact solver. The condition belongs to a contact, not to a body: a box may rock on one edge
// while the other still hops.
#pragma once

#include "sim/ccd/time_of_impact.h"
#include "sim/contact/model/contact.h"

#include <vector>

namespace tumble {

/// The gap of a contact, whose points may differ from the contact's.
struct ContactGap {
    PointGeometry geometry;  // of the manifold's single point
    // m, world, from the bodies' centers: the points of a CurvedGap, or the center of a BallOverFace. Else the contact's
    Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();
};

/// The gaps of make_contacts(manifolds, bodies, contacts), in their order.
void make_gaps(const std::vector<Manifold>& manifolds, const std::vector<Contact>& contacts,
               const std::vector<Body>& bodies, std::vector<ContactGap>& gaps);

/// n . (p_b'' - p_a'') of the contact's points (m/s^2) if only the flagged bodies were supported: by gravity, the
/// rotation of the bodies, and that of the normal. Negative: they press against each other.
double pressing_acceleration(const Contact& c, const ContactGap& gap, const Body& a, const Body& b, const Vec3& gravity,
                             bool a_supported, bool b_supported);

/// Whether the hop that begins with the contact's present v_rel would end before `time` s, or rise no higher than the
/// tolerance of the search for impacts: the end of such a hop cannot be found.
bool hop_is_shorter(const Contact& c, const Body& a, const Body& b, double acceleration, double time);

/// Marks the dynamic bodies that their contacts hold, in addition to those marked already. A contact holds if its gap
/// is at most `near` (m), it does not part faster than `release` (m/s: a speed that gravity reverses within a step or
/// two), and would not part by itself. Overlapping bodies are marked too, to be pushed out.
void mark_held(const std::vector<Contact>& contacts, const std::vector<ContactGap>& gaps,
               const std::vector<Body>& bodies, const Vec3& gravity, double near, double release,
               std::vector<bool>& held);

/// Time (s) in which the overlap of two touching bodies that do not approach stays below tuning::impact_harmless of the
/// smaller: with Q the largest relative acceleration of their points, the overlap is at most Q t^2 / 2.
double harmless_time(const MovingBody& a, const MovingBody& b);

}  // namespace tumble
