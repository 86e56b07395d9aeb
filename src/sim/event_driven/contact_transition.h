// Where bouncing ends. A contact whose next hop would be too short to follow holds from then on: its body lands, and
// passes to the stepped contact solver. The condition belongs to a contact, not to a body: a box may rock on one edge
// while the other still hops.
#pragma once

#include "sim/contact/model/contact.h"
#include "sim/ccd/time_of_impact.h"

#include <vector>

namespace tumble {

/// n . (p_b'' - p_a'') of the contact's points (m/s^2) if nothing held the bodies but what is said to be supported: gravity,
/// the turning of the bodies, and the turning of the normal. Negative: they press against each other.
double pressing_acceleration(const Contact& c, const Body& a, const Body& b, const Vec3& gravity, bool a_supported, bool b_supported);

/// Whether the hop that begins with the contact's present v_rel would end before `time` s, or rise no higher than the search for
/// impacts can tell from touching: of such a hop the end cannot be found.
bool hop_is_shorter(const Contact& c, const Body& a, const Body& b, double acceleration, double time);

/// Marks the dynamic bodies that their contacts hold, beside those marked already: what touches, or is no farther apart than `near`
/// (m), and neither parts faster than `release` (m/s: what gravity could bring back within a step or two), nor would part by itself.
/// What overlaps is held too, to be pushed out.
void mark_held(const std::vector<Contact>& contacts, const std::vector<Body>& bodies, const Vec3& gravity, double near, double release,
               std::vector<bool>& held);

/// Time (s) in which two that touch and do not approach come into each other by no more than tuning::impact_harmless of the
/// smaller: with Q the most that their points accelerate against each other, they do so by Q t^2 / 2.
double harmless_time(const Traveller& a, const Traveller& b);

}  // namespace tumble
