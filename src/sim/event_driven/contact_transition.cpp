#include "sim/event_driven/contact_transition.h"

#include "sim/contact/direct/settings.h"
#include "sim/event_driven/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// Acceleration (m/s^2) of the body's point at `arm`: with its support where it has one.
Vec3 supported_acceleration(std::uint32_t k, const Vec3& arm, const std::vector<Body>& bodies, const FreeMotion& free,
                            const Supports& supports) {
    const Body& body = bodies[k];
    if (!body.dynamic() || (!body.asleep && supports[k] == support::none)) return free.acceleration(k, body, arm);
    if (body.asleep || supports[k] == support::still) return Vec3::Zero();
    const Body& carrier = bodies[supports[k]];
    return free.acceleration(supports[k], carrier, body.position + arm - carrier.position);
}

// Whether a touching contact that does not overlap holds its bodies.
bool presses(const Contact& c, const Gap& gap, const std::vector<Body>& bodies, const FreeMotion& free,
             const HoldLimits& limits, const Supports& supports) {
    const double part = relative_velocity(c, bodies[c.a], bodies[c.b]);
    double pressing = -pressing_acceleration(c, gap, bodies, free, supports);
    // Bodies between others have no forces of their own: the load of the last step is still there.
    if (pressing == 0.0) pressing = c.load_speed / free.h;
    if (!(pressing > 0.0)) return false;
    const double most = std::max(limits.gravity, pressing);
    return c.separation <= std::max(c.touch_distance, 0.5 * most * limits.near * limits.near) &&
           part <= most * limits.release;
}

}  // namespace

std::uint32_t support_on(std::uint32_t k, const Body& body, const Supports& supports) {
    if (!body.dynamic()) return body.track ? k : support::still;
    return body.asleep || supports[k] == support::none ? support::still : supports[k];
}

double pressing_acceleration(const Contact& c, const Gap& gap, const std::vector<Body>& bodies, const FreeMotion& free,
                             const Supports& supports) {
    return gap_acceleration(gap, bodies[c.a], bodies[c.b],
                            supported_acceleration(c.a, gap.arm_a, bodies, free, supports),
                            supported_acceleration(c.b, gap.arm_b, bodies, free, supports));
}

void mark_held(const std::vector<Contact>& contacts, const std::vector<Gap>& gaps, const std::vector<Body>& bodies,
               const FreeMotion& free, const HoldLimits& limits, Supports& supports) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;  // body and support
    do {  // in rounds: the result must not depend on the contacts' order
        found.clear();
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            const Contact& c = contacts[i];
            const Body &a = bodies[c.a], &b = bodies[c.b];
            const auto needs = [&](std::uint32_t k) { return bodies[k].dynamic() && supports[k] == support::none; };
            if (!needs(c.a) && !needs(c.b)) continue;
            // Position correction leaves this overlap to a resting body, to the last digit: it alone does not hold the
            // body.
            const double left = tuning::direct_slop * std::min(a.radius, b.radius);
            const bool overlap = c.separation < -(left + c.touch_distance);
            if (!overlap && !presses(c, gaps[i], bodies, free, limits, supports)) continue;
            for (const auto& [k, other] : {std::pair(c.a, c.b), std::pair(c.b, c.a)})
                if (needs(k)) found.push_back({k, support_on(other, bodies[other], supports)});
        }
        std::sort(found.begin(), found.end());
        for (auto entry = found.rbegin(); entry != found.rend(); ++entry) supports[entry->first] = entry->second;
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
