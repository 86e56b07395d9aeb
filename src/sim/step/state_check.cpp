#include "sim/step/state_check.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "sim/step/step_context.h"
#include "sim/threads/thread_pool.h"

#include <fmt/format.h>

#include <cmath>

namespace tumble {

void StateCheck::examine(std::uint32_t i, const std::vector<Body>& bodies) {
    const Body& body = bodies[i];
    // One value that is not finite makes the sum not finite.
    if (std::isfinite(body.position.sum() + body.orientation.coeffs().sum() + body.momentum.sum() +
                      body.angular_momentum.sum() + body.correction_velocity.sum() +
                      body.correction_angular_velocity.sum()))
        return;
    for (std::uint32_t known = first_; i < known && !first_.compare_exchange_weak(known, i);) {
    }
}

void StateCheck::examine(std::span<const std::uint32_t> chosen, const std::vector<Body>& bodies, ThreadPool& pool) {
    pool.for_bodies(chosen, tuning::parallel_bodies, [&](std::uint32_t i) { examine(i, bodies); });
}

void stop_if_not_finite(const StepContext& step) {
    const std::uint32_t first = step.check.found();
    if (first == StateCheck::none) return;
    throw RunError(
        fmt::format("step {} (t = {:.6g} s): the state of body '{}' is not finite; "
                    "try a smaller step: more than {} steps_per_frame",
                    step.index, step.start(), safe_text(step.set.bodies[first].name), step.settings.steps_per_frame));
}

}  // namespace tumble
