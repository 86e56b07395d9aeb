#include "sim/event_driven/contact_transition.h"

#include "sim/contact/direct/settings.h"
#include "sim/event_driven/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace tumble {
namespace {

/// A contact is neutral if its relative acceleration, and its relative velocity over the step, are below this share of
/// the acceleration that presses its held body. Not fitted: above rounding and the speed that a landing leaves, far
/// below a motion. Tests: tests/physics/pressed_row_test.cpp.
constexpr double neutral_share = 1e-3;

// Acceleration (m/s^2) of the body's point at `arm`: with its support where it has one.
Vec3 supported_acceleration(std::uint32_t k, const Vec3& arm, const std::vector<Body>& bodies, const FreeMotion& free,
                            const Supports& supports) {
    const Body& body = bodies[k];
    if (!body.dynamic() || (!body.asleep && supports[k].none())) return free.acceleration(k, body, arm);
    if (body.asleep || supports[k].on == support::still) return Vec3::Zero();
    const Body& carrier = bodies[supports[k].on];
    return free.acceleration(supports[k].on, carrier, body.position + arm - carrier.position);
}

// True if the bodies have no relative motion at the contact: its acceleration (m/s^2, along the normal) and its
// velocity are small beside the acceleration that presses the held body, and that acceleration times h (s).
bool neutral(const Contact& c, const Body& a, const Body& b, double acceleration, const Support& held, double h) {
    const double least = neutral_share * held.pressing;
    if (!(std::abs(acceleration) < least)) return false;
    const Vec3 v = b.velocity + b.angular_velocity.cross(c.arm_b) - a.velocity - a.angular_velocity.cross(c.arm_a);
    return v.norm() <= least * h;
}

// Acceleration (m/s^2) that presses a touching contact without overlap if it holds its bodies, otherwise zero. `known`:
// the last step has solved the contact's load.
double holding(const Contact& c, const Gap& gap, const std::vector<Body>& bodies, const FreeMotion& free,
               const HoldLimits& limits, bool known, const Supports& supports) {
    const double part = relative_velocity(c, bodies[c.a], bodies[c.b]);
    double pressing = -pressing_acceleration(c, gap, bodies, free, supports);
    // Bodies between others have no forces of their own, or weaker ones: the load of the last step is still there.
    const double load = c.load_speed / free.h, nothing = neutral_share * load;
    const double opening = bodies[c.a].dynamic() && bodies[c.b].dynamic() ? load : nothing;
    if (pressing < nothing && pressing > -opening) pressing = load;
    // Before the first solve any contact without relative motion may carry a part of the load of its held body.
    for (const std::uint32_t k : {c.a, c.b})
        if (!known && !supports[k].none() && c.touching() &&
            neutral(c, bodies[c.a], bodies[c.b], pressing, supports[k], free.h))
            return supports[k].pressing;
    if (!(pressing > 0.0)) return 0.0;
    const double most = std::max(limits.gravity, pressing);
    const bool near = c.separation <= std::max(c.touch_distance, 0.5 * most * limits.near * limits.near);
    return near && part <= most * limits.release ? pressing : 0.0;
}

}  // namespace

std::uint32_t support_on(std::uint32_t k, const Body& body, const Supports& supports) {
    if (!body.dynamic()) return body.track ? k : support::still;
    return body.asleep || supports[k].none() ? support::still : supports[k].on;
}

double pressing_acceleration(const Contact& c, const Gap& gap, const std::vector<Body>& bodies, const FreeMotion& free,
                             const Supports& supports) {
    return gap_acceleration(gap, bodies[c.a], bodies[c.b],
                            supported_acceleration(c.a, gap.arm_a, bodies, free, supports),
                            supported_acceleration(c.b, gap.arm_b, bodies, free, supports));
}

void mark_held(const std::vector<Contact>& contacts, const std::vector<Gap>& gaps, const std::vector<Body>& bodies,
               const FreeMotion& free, const HoldLimits& limits, const std::function<bool(std::uint32_t)>& solved,
               Supports& supports) {
    std::vector<std::tuple<std::uint32_t, std::uint32_t, double>> found;  // body, support, its pressing
    do {  // in rounds: the result must not depend on the contacts' order
        found.clear();
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            const Contact& c = contacts[i];
            const Body &a = bodies[c.a], &b = bodies[c.b];
            const auto needs = [&](std::uint32_t k) { return bodies[k].dynamic() && supports[k].none(); };
            if (!needs(c.a) && !needs(c.b)) continue;
            // Position correction leaves this overlap to a resting body, to the last digit: it alone does not hold the
            // body.
            const double left = tuning::direct_slop * std::min(a.radius, b.radius);
            const bool overlap = c.separation < -(left + c.touch_distance);
            const double pressing =
                overlap ? limits.gravity
                        : holding(c, gaps[i], bodies, free, limits, solved(c.a) && solved(c.b), supports);
            if (!overlap && !(pressing > 0.0)) continue;
            for (const auto& [k, other] : {std::pair(c.a, c.b), std::pair(c.b, c.a)})
                if (needs(k)) found.push_back({k, support_on(other, bodies[other], supports), pressing});
        }
        std::sort(found.begin(), found.end());
        for (auto entry = found.rbegin(); entry != found.rend(); ++entry) {
            const auto& [k, on, pressing] = *entry;
            supports[k] = {on, std::max(supports[k].pressing, pressing)};
        }
    } while (!found.empty());
}

bool hop_is_shorter(const Contact& c, const Body& a, const Body& b, double acceleration, double time) {
    if (acceleration >= 0.0) return false;
    const double v = relative_velocity(c, a, b);
    if (2.0 * v < -acceleration * time) return true;
    return v * v < -2.0 * acceleration * (gap_rounding(a, a.position) + gap_rounding(b, b.position));
}

double harmless_time(const MovingBody& a, const MovingBody& b) {
    double size = std::numeric_limits<double>::infinity(), most = 0.0;
    for (const MovingBody* t : {&a, &b}) {
        if (!t->body->moves()) continue;
        size = std::min(size, t->body->radius);
        most += t->path->acceleration(t->since).norm() + t->path->turning_bound() * t->body->radius;
    }
    return std::sqrt(2.0 * tuning::impact_harmless * size / most);
}

}  // namespace tumble
