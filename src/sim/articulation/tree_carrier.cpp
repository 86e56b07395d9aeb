// TreeFlight: a tree whose root hangs on a kinematic body. Its pose, velocity and acceleration at the time of each
// evaluation are the ground's.
#include "sim/articulation/settings.h"
#include "sim/articulation/tree_flight.h"

#include <algorithm>

namespace tumble {

// The ground at a time of the step (s), in the part that law_time_ is in. With `impulse` impulses act instead of
// forces.
void TreeFlight::carry(double time, bool impulse) {
    if (!track()) return;
    const KeyframeTrack::Motion m = track()->at(step_->from + time, law_time_);
    const KeyframeTrack::Acceleration a = track()->acceleration(step_->from + time, law_time_);
    const Vec3 arm = m.rotation * (step_->bodies[tree_.carrier()].center_of_mass + tree_.carried_at());
    const Vec3 around = m.angular_velocity.cross(arm);
    const SpatialMotion velocity{m.angular_velocity, m.velocity + around};
    const SpatialMotion acceleration{a.angular, a.linear + a.angular.cross(arm) + m.angular_velocity.cross(around)};
    dynamics_.carry(m.rotation, m.position + arm - tree_.origin(), impulse ? SpatialMotion{} : velocity,
                    impulse ? velocity : acceleration);
}

// The velocity of the carrier jumps at the start of the step: such an impulse is left to the contact solver.
bool TreeFlight::jolted() const {
    if (!track()) return false;
    const double from = step_->from;
    const KeyframeTrack::Motion before = track()->at(from, from - tuning::tree_least_rest * step_->h),
                                after = track()->at(from, law_time_);
    const double jump = (after.velocity - before.velocity).norm() +
                        step_->length * (after.angular_velocity - before.angular_velocity).norm();
    return jump > tuning::tree_misfit * (after.velocity.norm() + step_->length * after.angular_velocity.norm());
}

// s: of the forces and of the carrier, at most the end of the step.
double TreeFlight::next_change(double now) const {
    double next = step_->from + step_->h;
    if (pushed_)
        for (const std::uint32_t i : step_->island) next = std::min(next, step_->forces.next_change(i, now));
    if (!track()) return next;
    const double rounding = tuning::tree_least_rest * step_->h, key = track()->next_key(now + rounding);
    return key < next - rounding ? key : next;
}

}  // namespace tumble
