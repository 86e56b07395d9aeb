// End of bouncing. A contact whose next hop would be below the Zeno limit holds from then on: its body switches to
// contact and to the contact solver. The condition belongs to a contact, not to a body: a box may rock on one edge
// while the other still hops.
#pragma once

#include "sim/ccd/time_of_impact.h"
#include "sim/contact/model/free_motion.h"

#include <functional>
#include <vector>

namespace tumble {

namespace support {
inline constexpr std::uint32_t none = UINT32_MAX, still = UINT32_MAX - 1;
}
struct Support {
    std::uint32_t on = support::none;  // none, still, or the kinematic body of this index, which carries the body
    double pressing = 0.0;             // m/s^2, the largest one of the contacts that hold the body
    bool none() const { return on == support::none; }
    friend bool operator==(const Support&, const Support&) = default;
};
using Supports = std::vector<Support>;  // by body
/// Support of a body that rests on the body `k`.
std::uint32_t support_on(std::uint32_t k, const Body& body, const Supports& supports);

/// n . (p_b'' - p_a'') of the contact's points (m/s^2) if only the supported bodies were held: by forces, the rotation
/// of the bodies, and that of the normal. Negative: they press against each other.
double pressing_acceleration(const Contact& c, const Gap& gap, const std::vector<Body>& bodies, const FreeMotion& free,
                             const Supports& supports);

/// True if the hop that begins with the contact's present v_rel would end before `time` s, or rise no higher than the
/// tolerance of the search for impacts: the end of such a hop cannot be found.
bool hop_is_shorter(const Contact& c, const Body& a, const Body& b, double acceleration, double time);

/// A contact that presses holds its bodies up to a gap that opens, and a speed that is reversed, in these times (s) at
/// the acceleration of gravity, or at the contact's own if that is larger.
struct HoldLimits {
    double gravity;  // m/s^2
    double near, release;
};

/// Adds supports of the dynamic bodies that their contacts hold. A contact holds if its gap and its speed are within
/// the limits and it would not part by itself. Overlapping bodies are held too, to be pushed out, and so are bodies
/// that touch a held one at rest, until a solve has told the load between them. `solved`: whether that is so for a
/// body's contacts.
void mark_held(const std::vector<Contact>& contacts, const std::vector<Gap>& gaps, const std::vector<Body>& bodies,
               const FreeMotion& free, const HoldLimits& limits, const std::function<bool(std::uint32_t)>& solved,
               Supports& supports);

/// Time (s) in which the overlap of two touching bodies that do not approach stays below tuning::impact_harmless of the
/// smaller: with Q the largest relative acceleration of their points, the overlap is at most Q t^2 / 2.
double harmless_time(const MovingBody& a, const MovingBody& b);

}  // namespace tumble
