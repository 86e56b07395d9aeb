#include "sim/step/contact_detection.h"

#include "sim/joints/joint_set.h"
#include "sim/step/motion_stage.h"
#include "sim/step/step_context.h"

namespace tumble {

const std::vector<BroadPhase::Pair>& ContactDetection::find_pairs(const StepContext& step) {
    return broad_phase_.update(step.set.bodies, step.h, &step.pool);
}

void ContactDetection::find(const StepContext& step) {
    if (step.set.list(step.sleep)) broad_phase_.bodies_woke();
    if (!current_) narrow_phase_.find(find_pairs(step), step.set.bodies, step.h, step.pool);
}

void ContactDetection::update(const StepContext& step, MotionStage& motion) {
    find(step);
    // Woken bodies need the contacts among themselves too, which were not searched.
    if (!current_ && step.sleep.wake_touched(manifolds(), step.set.bodies, step.h, step.gravity_speed())) find(step);
    current_ = true;
    const std::span<const std::uint32_t> stepped = motion.choose_stepped(step, manifolds());
    // The same pairs and the same stepped bodies give the same islands. Ballistic bodies may be stepped again at any
    // time.
    const std::array now{narrow_phase_.changes(), step.sleep.changes(), step.joints.changes()};
    if (!motion.has_ballistic_bodies() && now == seen_by_islands_) return;
    seen_by_islands_ = now;
    islands_.find(narrow_phase_.touching(), step.set.bodies, stepped, step.joints.pairs());
}

}  // namespace tumble
