// The data of a step that all of its stages share.
#pragma once

#include "sim/contact/model/free_motion.h"
#include "sim/contact/model/sleep.h"
#include "sim/event_driven/event_time.h"
#include "sim/snapshot/contact_records.h"
#include "sim/step/body_set.h"
#include "sim/step/force_stage.h"
#include "sim/step/state_check.h"
#include "sim/threads/thread_pool.h"

#include <cstdint>

namespace tumble {

class ContactLog;
class FractureStage;
class JointSet;
class PlacedBodies;
class RollingMotion;

struct StepContext {
    const SimulationSettings& settings;
    BodySet& set;
    ForceStage& forces;
    SleepMonitor& sleep;
    StateCheck& check;
    ThreadPool& pool;
    StepClock clock;
    std::int64_t index;  // number of the step, from 0
    double h;            // s, length of the step
    ContactLog* log;     // null: not asked for
    JointSet& joints;
    PlacedBodies& placed;
    RollingMotion& rolling;
    FractureStage& fracture;

    double start() const { return clock.seconds(index); }    // s
    double end() const { return clock.seconds(index + 1); }  // s
    /// Time of an impact that this step resolves.
    ImpactTime impact_time() const { return {end(), (index + 1) / settings.steps_per_frame, false}; }
    /// Time of an impact in the last step, `lag` s before its end.
    ImpactTime time_before_start(double lag) const {
        return {start() - lag, (index - 1) / settings.steps_per_frame, true};
    }
    /// Change of speed by gravity in a step, m/s.
    double gravity_speed() const { return settings.gravity.norm() * h; }
    FreeMotion free_motion() const { return {forces.field(), set.old_velocities, start(), end(), h}; }
};

}  // namespace tumble
