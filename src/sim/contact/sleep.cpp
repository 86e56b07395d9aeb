#include "sim/contact/sleep.h"

#include "sim/tuning.h"

#include <algorithm>

namespace tumble {

void SleepMonitor::wake(std::uint32_t body, std::vector<Body>& bodies) {
    const std::vector<std::uint32_t> group = std::move(watches_[body].group);
    for (const std::uint32_t i : group) {
        bodies[i].asleep = false;
        watches_[i] = Watch{};
    }
}

bool SleepMonitor::wake_touched(const std::vector<Contact>& contacts, std::vector<Body>& bodies) {
    bool woken = false;
    // A woken group may touch another sleeping one: repeat until nobody wakes.
    for (bool again = true; again;) {
        again = false;
        for (const Contact& c : contacts) {
            const Body &a = bodies[c.a], &b = bodies[c.b];
            if (a.asleep == b.asleep || !c.touching()) continue;
            const Body& other = a.asleep ? b : a;
            const bool disturbs = other.dynamic() || !other.velocity.isZero(0.0) || !other.angular_velocity.isZero(0.0);
            if (!disturbs) continue;
            wake(a.asleep ? c.a : c.b, bodies);
            again = woken = true;
        }
    }
    return woken;
}

void SleepMonitor::observe(const std::vector<Island>& islands, const std::vector<Contact>& contacts,
                           std::vector<Body>& bodies, double h) {
    for (const Island& island : islands) {
        bool still = true, leans = false;
        for (const std::uint32_t i : island.bodies) {
            const Body& body = bodies[i];
            Watch& watch = watches_[i];
            // The surface moves by at most |dx| + r |dtheta|, with |dtheta| about 2 |dq|.
            const double turned = 2.0 * (body.orientation.coeffs() - watch.orientation.coeffs()).norm();
            const double strayed = (body.position - watch.position).norm() + body.radius * turned;
            if (strayed > tuning::sleep_drift * body.radius) {
                watch.position = body.position;
                watch.orientation = body.orientation;
                watch.still = 0.0;
            } else {
                watch.still += h;
            }
            still = still && !body.flying && watch.still >= tuning::sleep_time;
        }
        if (!still) continue;
        for (const std::uint32_t k : island.contacts) {
            const Body &a = bodies[contacts[k].a], &b = bodies[contacts[k].b];
            leans = leans || ((!a.moves() || !b.moves()) && contacts[k].impulse > 0.0);
        }
        if (!leans) continue;
        for (const std::uint32_t i : island.bodies) {
            Body& body = bodies[i];
            body.asleep = true;
            body.momentum.setZero();
            body.angular_momentum.setZero();
            body.derive();
            watches_[i].group = island.bodies;
        }
    }
}

}  // namespace tumble
