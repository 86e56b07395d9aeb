// Curved bodies that roll or slide alone (contact/rolling/rolling_contact.h) in a step: with exact impacts, and bodies
// with integrator = "exact".
#pragma once

#include "sim/ccd/ccd_clamp.h"
#include "sim/contact/rolling/rolling_contact.h"
#include "sim/step/contact_detection.h"
#include "sim/step/step_context.h"

#include <vector>

namespace tumble {

class RollingMotion {
public:
    /// Rolls the bodies for which that is possible, and places them at the ends of their motions.
    void decide(const StepContext& step, ContactDetection& detection);
    /// Rolls the bodies that CCD stops within the step only as far, and sets their mean velocities until then.
    void stop(const StepContext& step, const std::vector<CcdFraction>& limits) const;
    /// The impulses of their contacts, after the forces and the solve.
    void log_contacts(const StepContext& step, ContactDetection& detection) const;

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [rolled] = self;
        archive.scratch(rolled);
    }

private:
    std::vector<RolledContact> rolled_;
};

}  // namespace tumble
