#include "sim/ccd/curved_turn.h"

#include "sim/math/keyframe_track.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr double largest_turn = 2.0;      // rad: the bounds below hold up to here
constexpr double above_rounding = 1e-12;  // share by which the bounds exceed their values

}  // namespace

std::optional<CurvedTurn> CurvedTurn::between(const End& start, const End& end, double span) {
    CurvedTurn turn;
    turn.from = start.orientation;
    const Vec3 whole = rotation_vector(end.orientation * start.orientation.conjugate());
    const double fastest = std::max(start.angular_velocity.norm(), end.angular_velocity.norm());
    if (!(std::max(whole.norm(), span * fastest) < 0.5 * largest_turn)) return std::nullopt;
    const Vec3 mean = whole / span, last = rate_from_spin(-whole, end.angular_velocity);
    turn.rate = start.angular_velocity;
    turn.bend = (6.0 * mean - 4.0 * turn.rate - 2.0 * last) / span;
    turn.twist = (6.0 * (turn.rate + last) - 12.0 * mean) / (span * span);
    if (!(span * turn.spin_bound(span) < largest_turn)) return std::nullopt;
    return turn;
}

Quat CurvedTurn::orientation(double t) const { return (from_rotation_vector(vector(t)) * from).normalized(); }

Vec3 CurvedTurn::angular_velocity(double t) const {
    return body_spin(-vector(t), vector_rate(t));  // -theta: in the world
}

// |omega| <= |theta'|, since no singular value of the Jacobian exceeds 1. theta' is within the hull of its Bezier points.
double CurvedTurn::spin_bound(double span) const {
    const Vec3 middle = rate + 0.5 * span * bend;
    return std::max({rate.norm(), middle.norm(), vector_rate(span).norm()}) * (1.0 + above_rounding);
}

// |alpha| <= |theta''| + |J'| |theta'|, with |J'| <= (p / 6 + p^2 / 12 + p^3 / 60) |theta'| <= p / 2 |theta'| for
// p = |theta| <= 2.
double CurvedTurn::turning_bound(double span) const {
    const double spin = spin_bound(span), bending = std::max(bend.norm(), (bend + span * twist).norm());
    return (bending + spin * spin * (1.0 + 0.5 * span * spin)) * (1.0 + above_rounding);
}

}  // namespace tumble
