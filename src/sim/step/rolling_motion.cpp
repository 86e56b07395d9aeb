#include "sim/step/rolling_motion.h"

#include "sim/log/contact_log.h"
#include "sim/step/placed_bodies.h"

namespace tumble {

void RollingMotion::decide(const StepContext& step, ContactDetection& detection) {
    rolled_.clear();
    const ContactIslands& islands = detection.islands();
    for (std::size_t k = 0; k < islands.size(); ++k) {
        if (islands.bodies(k).size() != 1 || !islands.joints(k).empty()) continue;
        const Body& body = step.set.bodies[islands.bodies(k)[0]];
        if (step.settings.impacts != ImpactMode::exact && body.integrator != IntegratorKind::exact) continue;
        auto rolled = roll_alone(islands.bodies(k)[0], step.set.bodies, detection.manifolds(), islands.manifolds(k),
                                 step.forces.field(), step.settings.gravity, step.h);
        if (!rolled) continue;
        step.placed.place(rolled->body, rolled->end, step.set.bodies);
        rolled_.push_back(std::move(*rolled));
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
