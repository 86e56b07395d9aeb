#include "sim/step/rolling_motion.h"

#include "sim/log/contact_log.h"
#include "sim/step/placed_bodies.h"

#include <algorithm>

namespace tumble {

// All bodies of an island roll, each alone, or none. CCD stops bodies that meet within the step.
void RollingMotion::decide(const StepContext& step, ContactDetection& detection) {
    rolled_.clear();
    const ContactIslands& islands = detection.islands();
    const std::vector<Body>& bodies = step.set.bodies;
    std::vector<std::vector<std::uint32_t>> of_bodies;
    for (std::size_t k = 0; k < islands.size(); ++k) {
        const auto members = islands.bodies(k);
        if (!islands.joints(k).empty() || islands.manifolds(k).size() < members.size() ||
            !std::ranges::all_of(members, [&](std::uint32_t i) {
                return may_roll(bodies[i]) &&
                       (step.settings.impacts == ImpactMode::exact || bodies[i].integrator == IntegratorKind::exact);
            }))
            continue;
        const std::size_t first = rolled_.size();
        of_bodies.assign(members.size(), {});
        for (std::size_t n = 0; n < members.size(); ++n) {
            const std::uint32_t i = members[n];
            for (const std::uint32_t m : islands.manifolds(k))
                if (detection.manifolds()[m].a == i || detection.manifolds()[m].b == i) of_bodies[n].push_back(m);
            auto rolled = roll_alone(i, bodies, detection.manifolds(), of_bodies[n], step.forces.field(),
                                     step.settings.gravity, step.h);
            if (!rolled) break;
            rolled_.push_back(std::move(*rolled));
        }
        if (rolled_.size() < first + members.size()) {
            rolled_.resize(first);
            continue;
        }
        for (std::size_t n = 0; n < members.size(); ++n) {
            give_impulses(rolled_[first + n], detection.manifolds(), of_bodies[n]);
            step.placed.place(members[n], rolled_[first + n].end, step.set.bodies);
        }
    }
}

void RollingMotion::stop(const StepContext& step, const std::vector<CcdFraction>& limits) const {
    for (const RolledContact& rolled : rolled_) {
        const double span = limits[rolled.body].share * step.h;
        if (span == step.h || !(span > 0.0)) continue;
        Body& body = step.set.bodies[rolled.body];
        Body start = body;
        set_state(start, rolled.start);
        const auto shorter = roll(start, rolled.plane, body.fall(step.settings.gravity), span);
        if (!shorter) continue;
        body.momentum = shorter->end.momentum;
        body.angular_momentum = shorter->end.angular_momentum;
        body.derive_velocities();
        step.set.motions[rolled.body] = mean_velocity(body, shorter->end, span);
    }
}

void RollingMotion::log_contacts(const StepContext& step, ContactDetection& detection) const {
    if (!step.log) return;
    for (const RolledContact& rolled : rolled_)
        step.log->add_rolled(rolled, detection.manifolds(), step.set.bodies, step.h);
}

}  // namespace tumble
