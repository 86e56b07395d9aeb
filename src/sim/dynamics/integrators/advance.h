// Advances a body without contact over a span of time, by one of the integrators, under the scene's forces. A span in
// which a force begins or ends is split there: no step goes across.
#pragma once

#include "sim/dynamics/forces.h"
#include "sim/dynamics/integrators/rigid_state.h"

namespace tumble {

/// True if advance_one_step moves bodies of this kind (the two Euler methods belong to World).
bool steps_whole_state(IntegratorKind kind);
/// True if a body without contact moves from its whole state at the start of the step: by those or in closed form.
inline bool advances_whole_state(IntegratorKind kind) {
    return kind == IntegratorKind::exact || steps_whole_state(kind);
}

/// One step of splitting or runge_kutta_4 from `from` to `to`, in s.
void advance_one_step(Body& body, IntegratorKind kind, const ForceField& forces, std::size_t index, double from,
                      double to);

/// The state of the body at `to`, from that at `from` (by default its present one), as accurate as double precision
/// allows (about 1e-12 over some seconds):
/// - free flight in closed form;
/// - under drag alone the rotation in closed form and the center by extrapolation;
/// - under forces at points everything by extrapolation, in as many steps as the rates require.
/// Throws RunError for too many steps.
RigidState advance_exactly(const Body& body, const RigidState& start, const ForceField& forces, std::size_t index,
                           double from, double to);
inline RigidState advance_exactly(const Body& body, const ForceField& forces, std::size_t index, double from,
                                  double to) {
    return advance_exactly(body, state_of(body), forces, index, from, to);
}

}  // namespace tumble
